//! The "tensor file": named arrays in one binary file. RGL `.bsdf` and `.pbsdf` files are tensor files.
//!
//! Little-endian: the twelve bytes `tensor_file\0`, the version as two `u8` (1, 0), the number of fields as `u32`; for
//! each field the length of its name as `u16`, the name, the number of dimensions as `u16`, the type as `u8`, the
//! position of the data from the start of the file as `u64`, and the dimensions as `u64`. Data are in row-major order.

use crate::bytes::Cursor;
use lobe_files::{FormatError, Place};
use lobe_files::{unwritable, write_whole};
use std::borrow::Cow;
use std::collections::HashSet;
use std::io;
use std::path::{Path, PathBuf};

const MAGIC: &[u8] = b"tensor_file\0";
const VERSION: [u8; 2] = [1, 0];
/// The size of the header of the file, and the smallest size of the header of a field.
const HEADER: usize = 18;
const FIELD_HEADER: usize = 13;
/// The data of each field start at a multiple of this.
const ALIGNMENT: usize = 8;

/// The type of the elements of a field. The discriminant is the number in the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum DType {
    /// Unsigned bytes.
    U8 = 1,
    /// Signed bytes.
    I8,
    /// Unsigned integers of 16 bits.
    U16,
    /// Signed integers of 16 bits.
    I16,
    /// Unsigned integers of 32 bits.
    U32,
    /// Signed integers of 32 bits.
    I32,
    /// Unsigned integers of 64 bits.
    U64,
    /// Signed integers of 64 bits.
    I64,
    /// IEEE 754 half precision.
    F16,
    /// IEEE 754 single precision.
    F32,
    /// IEEE 754 double precision.
    F64,
}

impl DType {
    const ALL: [DType; 11] = {
        use DType::*;
        [U8, I8, U16, I16, U32, I32, U64, I64, F16, F32, F64]
    };

    /// The size of an element in bytes.
    pub fn size(self) -> usize {
        match self {
            DType::U8 | DType::I8 => 1,
            DType::U16 | DType::I16 | DType::F16 => 2,
            DType::U32 | DType::I32 | DType::F32 => 4,
            DType::U64 | DType::I64 | DType::F64 => 8,
        }
    }
}

/// A named array of a tensor file.
#[derive(Clone, Debug, PartialEq)]
pub struct Field<'a> {
    /// The name.
    pub name: Cow<'a, str>,
    /// The type of the elements.
    pub dtype: DType,
    /// The dimensions, the slowest first.
    pub shape: Vec<usize>,
    /// The elements, little-endian.
    pub data: Cow<'a, [u8]>,
    /// The position of the header of the field in its file, or 0.
    position: u64,
}

impl<'a> Field<'a> {
    /// A field of bytes.
    pub fn u8(name: &'a str, shape: &[usize], data: &'a [u8]) -> Self {
        Field { name: name.into(), dtype: DType::U8, shape: shape.into(), data: data.into(), position: 0 }
    }

    /// A field of 16-bit integers, from their little-endian bytes.
    pub fn u16(name: &'a str, shape: &[usize], data: &'a [u8]) -> Self {
        Field { name: name.into(), dtype: DType::U16, shape: shape.into(), data: data.into(), position: 0 }
    }

    /// A field of 32-bit floats.
    pub fn f32(name: &'a str, shape: &[usize], data: &[f32]) -> Self {
        let data = data.iter().flat_map(|x| x.to_le_bytes()).collect();
        Field { name: name.into(), dtype: DType::F32, shape: shape.into(), data: Cow::Owned(data), position: 0 }
    }
}

/// The fields of a tensor file, in its order.
#[derive(Clone, Debug, PartialEq)]
pub struct TensorFile<'a> {
    /// The fields.
    pub fields: Vec<Field<'a>>,
    file: PathBuf,
}

/// `true` if `bytes` begin like a tensor file.
pub fn matches(bytes: &[u8]) -> bool {
    bytes.starts_with(MAGIC)
}

/// Reads a tensor file. The fields borrow from `bytes`, so nothing of the size of the data is allocated.
///
/// # Errors
/// [`FormatError`] if the header or a field is cut off, unknown or outside the file.
pub fn read<'a>(bytes: &'a [u8], file: &Path) -> Result<TensorFile<'a>, FormatError> {
    let mut cursor = Cursor::new(bytes, file);
    cursor.signature(MAGIC, "tensor_file")?;
    let version = cursor.array::<2>("the version")?;
    if version != VERSION {
        let found = format!("version {}.{}", version[0], version[1]);
        return Err(FormatError::new(file, Place::Byte(MAGIC.len() as u64), found, "version 1.0"));
    }
    let count = u32::from_le_bytes(cursor.array("the number of fields")?) as usize;
    if count > (bytes.len() - HEADER) / FIELD_HEADER {
        let found = format!("{count} fields in {} bytes", bytes.len());
        return Err(FormatError::new(file, Place::Byte(14), found, "as many field headers as the file can hold"));
    }
    let mut fields: Vec<Field<'a>> = Vec::with_capacity(count);
    let mut names: HashSet<&'a str> = HashSet::new();
    for _ in 0..count {
        let field = cursor.field()?;
        if let Cow::Borrowed(name) = field.name
            && !names.insert(name)
        {
            let found = format!("a second field {name:?}");
            return Err(FormatError::new(file, Place::Byte(field.position), found, "each name once"));
        }
        fields.push(field);
    }
    Ok(TensorFile { fields, file: file.into() })
}

impl<'a> TensorFile<'a> {
    /// A file to be written.
    pub fn new(fields: Vec<Field<'a>>) -> Self {
        TensorFile { fields, file: PathBuf::new() }
    }

    /// The field with this name, if there is one.
    pub fn get(&self, name: &str) -> Option<&Field<'a>> {
        self.fields.iter().find(|field| field.name == name)
    }

    /// The field with this name, checked to have this type and number of dimensions.
    ///
    /// # Errors
    /// [`FormatError`] if there is no such field or it has another type or number of dimensions.
    pub fn require(&self, name: &str, dtype: DType, dimensions: usize) -> Result<&Field<'a>, FormatError> {
        let Some(field) = self.get(name) else {
            let names: Vec<_> = self.fields.iter().map(|field| &*field.name).collect();
            return Err(FormatError::new(
                &self.file,
                Place::File,
                format!("the fields {names:?}"),
                format!("{name:?}"),
            ));
        };
        if field.dtype != dtype || field.shape.len() != dimensions {
            let found = format!("{name:?} as {:?} {:?}", field.dtype, field.shape);
            return Err(self.error(name, found, format!("{dtype:?} with {dimensions} dimensions")));
        }
        Ok(field)
    }

    /// The elements of a field of 32-bit floats with this number of dimensions, and its shape.
    ///
    /// # Errors
    /// The same as for [`require`](Self::require).
    pub fn floats(&self, name: &str, dimensions: usize) -> Result<(Vec<f32>, &[usize]), FormatError> {
        let field = self.require(name, DType::F32, dimensions)?;
        let (elements, _) = field.data.as_chunks();
        Ok((elements.iter().map(|x| f32::from_le_bytes(*x)).collect(), &field.shape))
    }

    /// An error at a field.
    pub(crate) fn error(&self, name: &str, found: impl Into<String>, expected: impl Into<String>) -> FormatError {
        let place = self.get(name).map_or(Place::File, |field| Place::Byte(field.position));
        FormatError::new(&self.file, place, found, expected)
    }

    /// An error at the field that a table rejected.
    pub(crate) fn invalid(&self, invalid: lobe_table::Invalid) -> FormatError {
        self.error(invalid.part, format!("{}: {}", invalid.part, invalid.found), invalid.expected)
    }

    /// The bytes of the file.
    ///
    /// # Errors
    /// [`io::ErrorKind::InvalidInput`] if a name, a shape or the number of fields does not fit the format, or the
    /// data of a field do not fit its shape.
    pub fn to_bytes(&self) -> io::Result<Vec<u8>> {
        let mut at = HEADER;
        for field in &self.fields {
            field.check()?;
            at += FIELD_HEADER + field.name.len() + 8 * field.shape.len();
        }
        let fields = u32::try_from(self.fields.len()).map_err(|_| unfit("more fields than u32 counts"))?;
        let (mut header, mut data) = (Vec::with_capacity(at), Vec::new());
        header.extend_from_slice(MAGIC);
        header.extend_from_slice(&VERSION);
        header.extend_from_slice(&fields.to_le_bytes());
        for field in &self.fields {
            // `check` ensures that the casts lose nothing.
            data.resize((at + data.len()).next_multiple_of(ALIGNMENT) - at, 0);
            header.extend_from_slice(&(field.name.len() as u16).to_le_bytes());
            header.extend_from_slice(field.name.as_bytes());
            header.extend_from_slice(&(field.shape.len() as u16).to_le_bytes());
            header.push(field.dtype as u8);
            header.extend_from_slice(&((at + data.len()) as u64).to_le_bytes());
            field.shape.iter().for_each(|&n| header.extend_from_slice(&(n as u64).to_le_bytes()));
            data.extend_from_slice(&field.data);
        }
        header.append(&mut data);
        Ok(header)
    }

    /// Writes the file, replacing an existing one atomically.
    ///
    /// # Errors
    /// [`FormatError`] as [`to_bytes`](Self::to_bytes), and if the file system refuses.
    pub fn write(&self, path: &Path) -> Result<(), FormatError> {
        write_whole(path, &self.to_bytes().map_err(|error| unwritable(path, &error))?)
    }
}

impl Field<'_> {
    fn check(&self) -> io::Result<()> {
        if u16::try_from(self.name.len()).is_err() || u16::try_from(self.shape.len()).is_err() {
            return Err(unfit("a name or shape longer than u16 counts"));
        }
        if bytes_of(&self.shape, self.dtype) != Some(self.data.len()) {
            return Err(unfit(&format!("field {:?} does not hold its shape", self.name)));
        }
        Ok(())
    }
}

fn unfit(why: &str) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidInput, why)
}

fn bytes_of(shape: &[usize], dtype: DType) -> Option<usize> {
    shape.iter().try_fold(dtype.size(), |bytes, &n| bytes.checked_mul(n))
}

impl<'a> Cursor<'a, '_> {
    fn field(&mut self) -> Result<Field<'a>, FormatError> {
        let start = self.at as u64;
        let error = |found: String, expected: &str| FormatError::new(self.file, Place::Byte(start), found, expected);
        let length = u16::from_le_bytes(self.array("the length of a field name")?) as usize;
        let name = self.take(length, "a field name")?;
        let Ok(name) = str::from_utf8(name) else {
            return Err(error(format!("the field name {:?}", name.escape_ascii().to_string()), "UTF-8"));
        };
        let dimensions = u16::from_le_bytes(self.array("the number of dimensions")?) as usize;
        let [code] = self.array("the type of a field")?;
        let Some(dtype) = DType::ALL.into_iter().find(|dtype| *dtype as u8 == code) else {
            return Err(error(format!("{name:?} of type {code}"), "a type from 1 to 11"));
        };
        let offset = u64::from_le_bytes(self.array("the position of a field")?);
        let (dimensions, _) = self.take(8 * dimensions, "the shape of a field")?.as_chunks();
        let shape: Option<Vec<usize>> =
            dimensions.iter().map(|n| usize::try_from(u64::from_le_bytes(*n)).ok()).collect();
        let data = shape.as_ref().and_then(|shape| {
            let start = usize::try_from(offset).ok()?;
            self.bytes.get(start..start.checked_add(bytes_of(shape, dtype)?)?)
        });
        match (shape, data) {
            (Some(shape), Some(data)) => {
                Ok(Field { name: name.into(), dtype, shape, data: Cow::Borrowed(data), position: start })
            }
            (shape, _) => {
                let shape = shape.map_or("of more elements than memory holds".into(), |shape| format!("{shape:?}"));
                let found = format!("{name:?} as {dtype:?} {shape} at byte {offset}");
                Err(error(found, &format!("data inside the {} bytes of the file", self.bytes.len())))
            }
        }
    }
}
