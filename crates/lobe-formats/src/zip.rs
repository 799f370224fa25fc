//! Archives with uncompressed members, such as NumPy's `.npz` files.
//!
//! The fields are those of PKWARE's APPNOTE 6.3, sections 4.3 and 4.5.3. Sizes and offsets that do not fit into 32 bits
//! are in the ZIP64 fields.

/// The value of a 32-bit field if the number is in the ZIP64 field.
const ELSEWHERE: u32 = u32::MAX;

/// The earliest possible day, 1980-01-01, so that archives of the same members have the same bytes.
const DATE: u16 = 0x0021;

/// An archive that is being written.
pub(crate) struct Archive {
    bytes: Vec<u8>,
    /// The central directory, which comes last.
    directory: Vec<u8>,
    members: u64,
    /// Numbers of at least this value are in ZIP64 fields.
    large_from: u64,
}

impl Default for Archive {
    fn default() -> Self {
        Archive { bytes: Vec::new(), directory: Vec::new(), members: 0, large_from: u64::from(ELSEWHERE) }
    }
}

impl Archive {
    /// Adds a member that consists of these parts. Its name has at most 65535 bytes.
    pub(crate) fn add(&mut self, name: &str, parts: &[&[u8]]) {
        let size = parts.iter().map(|part| part.len() as u64).sum::<u64>();
        let offset = self.bytes.len() as u64;
        let crc = crc32(parts);
        let (size_field, offset_field) = (self.field(size), self.field(offset));
        let mut sizes = Vec::new();
        if size_field == ELSEWHERE {
            sizes.extend([size.to_le_bytes(), size.to_le_bytes()]);
        }
        let common = |out: &mut Vec<u8>, extra: &[[u8; 8]]| {
            let version: u16 = if extra.is_empty() { 20 } else { 45 };
            // Names are UTF-8; nothing is compressed; the time of day is midnight.
            for field in [version, 0x0800, 0, 0, DATE] {
                out.extend(field.to_le_bytes());
            }
            for field in [crc, size_field, size_field] {
                out.extend(field.to_le_bytes());
            }
            let extra_len = if extra.is_empty() { 0 } else { 4 + 8 * extra.len() };
            out.extend((name.len() as u16).to_le_bytes());
            out.extend((extra_len as u16).to_le_bytes());
        };
        let zip64 = |out: &mut Vec<u8>, extra: &[[u8; 8]]| {
            if !extra.is_empty() {
                out.extend(1_u16.to_le_bytes());
                out.extend((8 * extra.len() as u16).to_le_bytes());
                out.extend(extra.as_flattened());
            }
        };
        self.bytes.extend(b"PK\x03\x04");
        common(&mut self.bytes, &sizes);
        self.bytes.extend(name.as_bytes());
        zip64(&mut self.bytes, &sizes);
        for part in parts {
            self.bytes.extend_from_slice(part);
        }

        let mut extra = sizes;
        if offset_field == ELSEWHERE {
            extra.push(offset.to_le_bytes());
        }
        self.directory.extend(b"PK\x01\x02\x2d\x00");
        common(&mut self.directory, &extra);
        // No comment, the first disk, no attributes.
        self.directory.extend([0; 10]);
        self.directory.extend(offset_field.to_le_bytes());
        self.directory.extend(name.as_bytes());
        zip64(&mut self.directory, &extra);
        self.members += 1;
    }

    /// The whole archive.
    pub(crate) fn finish(mut self) -> Vec<u8> {
        let (begin, size) = (self.bytes.len() as u64, self.directory.len() as u64);
        self.bytes.append(&mut self.directory);
        let (begin_field, size_field) = (self.field(begin), self.field(size));
        let members_field = u16::try_from(self.members).unwrap_or(u16::MAX);
        if begin_field == ELSEWHERE || size_field == ELSEWHERE || members_field == u16::MAX {
            let end = self.bytes.len() as u64;
            // The rest of the record has 44 bytes; the version twice, and no disks.
            self.bytes.extend(b"PK\x06\x06");
            self.bytes.extend(44_u64.to_le_bytes());
            self.bytes.extend([45, 0, 45, 0, 0, 0, 0, 0, 0, 0, 0, 0]);
            for field in [self.members, self.members, size, begin] {
                self.bytes.extend(field.to_le_bytes());
            }
            self.bytes.extend(b"PK\x06\x07\x00\x00\x00\x00");
            self.bytes.extend(end.to_le_bytes());
            self.bytes.extend(1_u32.to_le_bytes());
        }
        self.bytes.extend(b"PK\x05\x06\x00\x00\x00\x00");
        self.bytes.extend(members_field.to_le_bytes());
        self.bytes.extend(members_field.to_le_bytes());
        self.bytes.extend(size_field.to_le_bytes());
        self.bytes.extend(begin_field.to_le_bytes());
        self.bytes.extend(0_u16.to_le_bytes());
        self.bytes
    }

    fn field(&self, number: u64) -> u32 {
        if number < self.large_from { number as u32 } else { ELSEWHERE }
    }
}

/// The checksum of ISO 3309, byte by byte.
fn crc32(parts: &[&[u8]]) -> u32 {
    const TABLE: [u32; 256] = {
        let mut table = [0; 256];
        let mut byte = 0;
        while byte < 256 {
            let mut rest = byte as u32;
            let mut bit = 0;
            while bit < 8 {
                rest = if rest & 1 == 1 { 0xedb8_8320 ^ (rest >> 1) } else { rest >> 1 };
                bit += 1;
            }
            table[byte] = rest;
            byte += 1;
        }
        table
    };
    let mut crc = u32::MAX;
    for byte in parts.iter().copied().flatten() {
        crc = TABLE[(crc as u8 ^ byte) as usize] ^ (crc >> 8);
    }
    !crc
}

#[cfg(test)]
mod tests {
    use std::io::{Cursor, Read};

    use super::*;

    #[test]
    fn the_checksum_agrees_with_the_standard() {
        assert_eq!(crc32(&[b"123456789"]), 0xcbf4_3926);
        assert_eq!(crc32(&[b"1234", b"", b"56789"]), 0xcbf4_3926);
    }

    /// With ZIP64 fields for small sizes too, so that gigabytes are not needed to test them.
    #[test]
    fn another_program_finds_every_member() {
        let members: Vec<(String, Vec<u8>)> =
            (0..5_u8).map(|n| (format!("{n}/ψ.npy"), vec![n; 40 * usize::from(n)])).collect();
        for large_from in [0, 1, 100, 300, u64::from(ELSEWHERE)] {
            let mut archive = Archive { large_from, ..Archive::default() };
            for (name, data) in &members {
                let (first, rest) = data.split_at(data.len() / 3);
                archive.add(name, &[first, rest]);
            }
            let mut read = zip::ZipArchive::new(Cursor::new(archive.finish())).expect("an archive");
            assert_eq!(read.len(), members.len());
            for (name, data) in &members {
                let mut found = Vec::new();
                read.by_name(name).expect("a member").read_to_end(&mut found).expect("its checksum");
                assert_eq!(&found, data, "{name}, large from {large_from}");
            }
        }
    }
}
