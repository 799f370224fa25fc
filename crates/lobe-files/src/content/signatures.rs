//! Recognition of binary files by their first bytes.

use std::path::Path;

use super::Content;

const PICTURE: &str = "Pictures are environments and textures of scenes, not materials";
const MESH: &str = "Meshes are shapes of scenes, not materials";
const DOCUMENT: &str = "Save the table in it as CSV";
const ARRAY: &str = "Save the angles and values as columns of a CSV file";
const PROGRAM: &str = "It holds no data";
const SOUND: &str = "It holds no measurement";

/// The kind of a file that begins like this, and what to do.
const SIGNATURES: [(&[u8], &str, &str); 44] = [
    (b"%PDF-", "a PDF document", DOCUMENT),
    (b"%!PS", "a PostScript document", DOCUMENT),
    (b"{\\rtf", "a text document (RTF)", DOCUMENT),
    (b"\x89PNG\r\n\x1a\n", "a PNG picture", PICTURE),
    (b"\xff\xd8\xff", "a JPEG picture", PICTURE),
    (b"GIF8", "a GIF picture", PICTURE),
    (b"II*\0", "a TIFF picture", PICTURE),
    (b"MM\0*", "a TIFF picture", PICTURE),
    (b"\x76\x2f\x31\x01", "a picture (OpenEXR)", PICTURE),
    (b"DDS |", "a picture (DDS)", PICTURE),
    (b"8BPS", "a picture (Photoshop)", PICTURE),
    (b"\xabKTX", "a picture (KTX)", PICTURE),
    (b"PF\n", "a picture (PFM)", PICTURE),
    (b"Pf\n", "a picture (PFM)", PICTURE),
    (b"P5\n", "a picture (PGM)", PICTURE),
    (b"P6\n", "a picture (PPM)", PICTURE),
    (b"P2\n", "a picture (PGM)", PICTURE),
    (b"P3\n", "a picture (PPM)", PICTURE),
    (b"\0\0\x01\0", "a picture (icon)", PICTURE),
    (b"\xff\x0a", "a JPEG XL picture", PICTURE),
    (b"\0\0\0\x0cjP  ", "a JPEG 2000 picture", PICTURE),
    (b"ply\n", "a mesh (PLY)", MESH),
    (b"ply\r\n", "a mesh (PLY)", MESH),
    (b"glTF", "a mesh (glTF)", MESH),
    (b"Kaydara FBX Binary", "a mesh (FBX)", MESH),
    (b"PXR-USDC", "a scene of USD", MESH),
    (b"#usda", "a scene of USD", MESH),
    (b"Ogawa", "a mesh (Alembic)", MESH),
    (b"BLENDER", "a scene of Blender", MESH),
    (b"ISO-10303-21", "a CAD model (STEP)", MESH),
    (b"\x1c\x04\x03\0", "a mesh of Mitsuba (.serialized)", MESH),
    (b"\x1c\x04\x04\0", "a mesh of Mitsuba (.serialized)", MESH),
    (b"\x93NUMPY", "a NumPy array (.npy)", ARRAY),
    (b"MATLAB 5.0 MAT-file", "variables of MATLAB (.mat)", ARRAY),
    (b"CDF\x01", "a NetCDF file", ARRAY),
    (b"CDF\x02", "a NetCDF file", ARRAY),
    (b"SIMPLE  =", "a FITS file", ARRAY),
    (b"SQLite format 3\0", "a database (SQLite)", ARRAY),
    (b"PAR1", "a table of Parquet", ARRAY),
    (b"\x7fELF", "a program", PROGRAM),
    (b"MZ", "a program of Windows", PROGRAM),
    (b"#!/", "a script", PROGRAM),
    (b"OggS", "a sound or film (Ogg)", SOUND),
    (b"\x1aE\xdf\xa3", "a film (Matroska)", SOUND),
];

pub(super) fn content(bytes: &[u8], path: &Path) -> Option<Content> {
    let found = SIGNATURES.iter().find(|(magic, ..)| bytes.starts_with(magic));
    // A text may begin with two letters.
    let found = found.filter(|(magic, ..)| *magic != b"MZ" || bytes.contains(&0));
    if let Some((_, what, advice)) = found {
        return Some(Content::new(*what, *advice));
    }
    hdf5(bytes, path)
        .or_else(|| office(bytes, path))
        .or_else(|| bitmap(bytes))
        .or_else(|| container(bytes))
        .or_else(|| stl(bytes))
}

/// HDF5, which may begin at 0, 512, 1024, ...; AxF files are built on it.
fn hdf5(bytes: &[u8], path: &Path) -> Option<Content> {
    const MAGIC: &[u8] = b"\x89HDF\r\n\x1a\n";
    let is_at = |at: usize| bytes.get(at..).is_some_and(|rest| rest.starts_with(MAGIC));
    if !(is_at(0) || (9..21).any(|shift| is_at(1 << shift))) {
        return None;
    }
    let is_named = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("axf"));
    let is_axf = is_named || bytes.windows(7).take(1 << 20).any(|window| window == b"com.xri");
    Some(match is_axf {
        true => Content::new(
            "an AxF file of X-Rite (HDF5)",
            "AxF is not public, and only X-Rite's own library decodes it: export the measurement as a table (CSV, ASTM \
             E1392) from a program with that library",
        ),
        false => Content::new("an HDF5 file", ARRAY),
    })
}

/// Documents of Microsoft Office before 2007.
fn office(bytes: &[u8], path: &Path) -> Option<Content> {
    if !bytes.starts_with(b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1") {
        return None;
    }
    let is_sheet = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("xls"));
    Some(match is_sheet {
        true => Content::new("an Excel workbook (.xls)", "Export the sheet as CSV"),
        false => Content::new("a document of Microsoft Office (before 2007)", DOCUMENT),
    })
}

/// A Windows bitmap, whose header contains the size of the file.
fn bitmap(bytes: &[u8]) -> Option<Content> {
    let size = bytes.strip_prefix(b"BM")?.first_chunk::<4>()?;
    let is_bitmap = u32::from_le_bytes(*size) as usize == bytes.len();
    is_bitmap.then(|| Content::new("a picture (BMP)", PICTURE))
}

/// Pictures, sounds and films with a size before their type.
fn container(bytes: &[u8]) -> Option<Content> {
    if bytes.starts_with(b"RIFF") {
        return Some(match bytes.get(8..12)? {
            b"WEBP" => Content::new("a WebP picture", PICTURE),
            _ => Content::new("a sound or film (RIFF)", SOUND),
        });
    }
    let kind = bytes.get(4..12)?.strip_prefix(b"ftyp")?;
    Some(match kind {
        b"avif" | b"heic" | b"mif1" => Content::new("a picture (HEIF)", PICTURE),
        _ => Content::new("a film (MP4)", SOUND),
    })
}

/// Binary STL has no signature, but a known size: 84 bytes, and 50 per triangle.
fn stl(bytes: &[u8]) -> Option<Content> {
    let count = u32::from_le_bytes(*bytes.get(80..)?.first_chunk::<4>()?) as usize;
    let is_stl = count > 0 && count.checked_mul(50).and_then(|size| size.checked_add(84)) == Some(bytes.len());
    is_stl.then(|| Content::new("a mesh (STL)", MESH))
}
