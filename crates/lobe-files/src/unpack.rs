//! Files compressed with gzip.

use std::borrow::Cow;
use std::io::{ErrorKind, Read as _};
use std::path::{Path, PathBuf};

use flate2::read::{MultiGzDecoder, ZlibDecoder};

use crate::{FormatError, Place};

/// The content of a file, unpacked if it was compressed with gzip.
#[derive(Debug)]
pub struct Unpacked<'a> {
    /// The content.
    pub bytes: Cow<'a, [u8]>,
    /// The name of the content: without `.gz`, if it was compressed.
    pub name: Cow<'a, Path>,
}

/// Unpacked files up to this size are never refused for their size.
const ALWAYS: u64 = 256 << 20;
/// Larger ones may have at most this many bytes per byte of the compressed file.
const RATIO: u64 = 100;

/// `true` for the first bytes of a file compressed with gzip.
pub fn is_gzip(bytes: &[u8]) -> bool {
    bytes.starts_with(&[0x1f, 0x8b, 8])
}

/// Unpacks the content of the file `path` if its first bytes say that it is compressed with gzip, whatever its name.
///
/// # Errors
/// [`FormatError`] if the compressed data are damaged or cut short, or if they unpack to more than 256 MiB and more
/// than a hundred times their size.
pub fn unpacked<'a>(bytes: &'a [u8], path: &'a Path) -> Result<Unpacked<'a>, FormatError> {
    if !is_gzip(bytes) {
        return Ok(Unpacked { bytes: bytes.into(), name: path.into() });
    }
    let most = ALWAYS.max((bytes.len() as u64).saturating_mul(RATIO));
    let mut content = Vec::new();
    let found = match MultiGzDecoder::new(bytes).take(most.saturating_add(1)).read_to_end(&mut content) {
        Ok(_) if content.len() as u64 <= most => {
            return Ok(Unpacked { bytes: content.into(), name: inner_name(path).into() });
        }
        Ok(_) => format!("gzip of more than {most} bytes"),
        Err(error) if error.kind() == ErrorKind::UnexpectedEof => {
            format!("gzip that is cut short: {} bytes, of which {} can be unpacked", bytes.len(), content.len())
        }
        Err(error) => format!("damaged gzip ({error}), of which {} bytes can be unpacked", content.len()),
    };
    let expected = match content.len() as u64 <= most {
        true => "a whole file; copy or download it again",
        false => "less, or the file unpacked",
    };
    Err(FormatError::new(path, Place::File, found, expected))
}

/// Unpacks a zlib stream that begins at byte `at` of the file `path`; bytes that follow it are ignored.
///
/// # Errors
/// The same as for [`unpacked`].
pub fn inflated(bytes: &[u8], at: u64, path: &Path) -> Result<Vec<u8>, FormatError> {
    let most = ALWAYS.max((bytes.len() as u64).saturating_mul(RATIO));
    let mut content = Vec::new();
    let found = match ZlibDecoder::new(bytes).take(most.saturating_add(1)).read_to_end(&mut content) {
        Ok(_) if content.len() as u64 <= most => return Ok(content),
        Ok(_) => format!("packed data of more than {most} bytes"),
        Err(error) if error.kind() == ErrorKind::UnexpectedEof => {
            format!("packed data that are cut short, of which {} bytes can be unpacked", content.len())
        }
        Err(error) => format!("damaged packed data ({error}), of which {} bytes can be unpacked", content.len()),
    };
    Err(FormatError::new(path, Place::Byte(at), found, "a whole zlib stream"))
}

/// The name without `.gz`.
fn inner_name(path: &Path) -> PathBuf {
    let is_gz = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("gz"));
    if is_gz { path.with_extension("") } else { path.into() }
}

#[cfg(test)]
mod tests {
    use std::io::Write as _;

    use flate2::Compression;
    use flate2::write::GzEncoder;

    use super::*;

    fn gzip(bytes: &[u8]) -> Vec<u8> {
        let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
        encoder.write_all(bytes).expect("memory");
        encoder.finish().expect("memory")
    }

    #[test]
    fn content_is_unpacked_and_its_name_loses_the_extension() {
        let path = Path::new("folder/paint.ddt.GZ");
        let packed = gzip(b"sigma");
        let found = unpacked(&packed, path).expect("gzip");
        assert_eq!((&*found.bytes, &*found.name), (b"sigma".as_slice(), Path::new("folder/paint.ddt")));
        let found = unpacked(b"sigma", path).expect("a plain file");
        assert_eq!((&*found.bytes, &*found.name), (b"sigma".as_slice(), path));
        // Files may be compressed in several pieces.
        let pieces = [gzip(b"sig"), gzip(b"ma")].concat();
        assert_eq!(&*unpacked(&pieces, Path::new("x")).expect("gzip").bytes, b"sigma");
    }

    #[test]
    fn damage_and_bombs_are_refused() {
        let path = Path::new("x.gz");
        let packed = gzip(&b"a line of text\n".repeat(100));
        for end in 3..packed.len() {
            let error = unpacked(&packed[..end], path).expect_err("cut short");
            assert!(error.found.contains("cut short"), "{end}: {error}");
        }
        let mut flipped = packed.clone();
        let last = flipped.len() - 6;
        flipped[last] ^= 1;
        assert!(unpacked(&flipped, path).expect_err("a wrong checksum").found.contains("damaged"));
        let bomb = gzip(&vec![0; (ALWAYS + 1) as usize]);
        let error = unpacked(&bomb, path).expect_err("too much");
        assert_eq!(error.found, "gzip of more than 268435456 bytes");
    }
}
