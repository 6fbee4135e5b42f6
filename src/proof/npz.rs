//! A writer of NumPy's format of several arrays: a ZIP archive of deflated `.npy` files, the same bytes for the same arrays.

use std::io::Write;

use flate2::write::DeflateEncoder;
use flate2::{Compression, Crc};
use sha2::{Digest, Sha256};

/// Arrays that become an archive.
#[derive(Debug, Default)]
pub(super) struct Archive {
    bytes: Vec<u8>,
    directory: Vec<u8>,
    count: u16,
    digest: Sha256,
}

/// An element type of arrays.
pub(super) trait Element: Copy {
    /// Its name in the header of a `.npy` file.
    const NAME: &'static str;
    /// Appends its bytes, the lowest first.
    fn append(self, bytes: &mut Vec<u8>);
}

impl Element for f64 {
    const NAME: &'static str = "<f8";
    fn append(self, bytes: &mut Vec<u8>) {
        bytes.extend(self.to_le_bytes());
    }
}

impl Element for i32 {
    const NAME: &'static str = "<i4";
    fn append(self, bytes: &mut Vec<u8>) {
        bytes.extend(self.to_le_bytes());
    }
}

impl Element for u8 {
    const NAME: &'static str = "|u1";
    fn append(self, bytes: &mut Vec<u8>) {
        bytes.push(self);
    }
}

/// Signatures of a file, of its entry in the directory, and of the end of the directory.
const FILE: u32 = 0x0403_4b50;
const ENTRY: u32 = 0x0201_4b50;
const END: u32 = 0x0605_4b50;
/// ZIP 2.0, no flags, deflated, 1 January 1980.
const HEAD: [u8; 10] = [20, 0, 0, 0, 8, 0, 0, 0, 0x21, 0];

impl Archive {
    /// Appends an array of rows of `width` elements; of width 0 a plain list.
    pub fn array<T: Element>(&mut self, name: &str, values: &[T], width: usize) {
        let shape = match width {
            0 => format!("({},)", values.len()),
            width => format!("({}, {width})", values.len() / width),
        };
        let mut header = format!("{{'descr': '{}', 'fortran_order': False, 'shape': {shape}, }}", T::NAME);
        // The data begin at a multiple of 64 bytes, after the 10 of magic, version and length and a line end.
        let padding = (64 - (header.len() + 11) % 64) % 64;
        header.extend(std::iter::repeat_n(' ', padding));
        header.push('\n');
        let mut content = b"\x93NUMPY\x01\x00".to_vec();
        content.extend((header.len() as u16).to_le_bytes());
        content.extend(header.as_bytes());
        values.iter().for_each(|value| value.append(&mut content));
        self.digest.update(name.as_bytes());
        self.digest.update(&content);
        self.file(&format!("{name}.npy"), &content);
    }

    fn file(&mut self, name: &str, content: &[u8]) {
        let mut encoder = DeflateEncoder::new(Vec::new(), Compression::fast());
        // Writing to memory does not fail.
        let packed = encoder.write_all(content).and_then(|()| encoder.finish()).unwrap_or_default();
        let mut crc = Crc::new();
        crc.update(content);
        let mut sizes = crc.sum().to_le_bytes().to_vec();
        sizes.extend((packed.len() as u32).to_le_bytes());
        sizes.extend((content.len() as u32).to_le_bytes());
        sizes.extend((name.len() as u16).to_le_bytes());
        sizes.extend([0; 2]);
        let place = self.bytes.len() as u32;
        self.bytes.extend(FILE.to_le_bytes());
        self.bytes.extend(HEAD);
        self.bytes.extend(&sizes);
        self.bytes.extend(name.as_bytes());
        self.bytes.extend(packed);
        self.directory.extend(ENTRY.to_le_bytes());
        self.directory.extend([20, 0]);
        self.directory.extend(HEAD);
        self.directory.extend(&sizes);
        self.directory.extend([0; 10]);
        self.directory.extend(place.to_le_bytes());
        self.directory.extend(name.as_bytes());
        self.count += 1;
    }

    /// The archive, whose last array is the SHA-256 of all others, names included.
    pub fn finish(mut self) -> Vec<u8> {
        let digest = self.digest.clone().finalize();
        self.array("digest", &digest, 0);
        let (start, size) = (self.bytes.len() as u32, self.directory.len() as u32);
        self.bytes.extend(self.directory);
        self.bytes.extend(END.to_le_bytes());
        self.bytes.extend([0; 4]);
        self.bytes.extend(self.count.to_le_bytes());
        self.bytes.extend(self.count.to_le_bytes());
        self.bytes.extend(size.to_le_bytes());
        self.bytes.extend(start.to_le_bytes());
        self.bytes.extend([0; 2]);
        self.bytes
    }
}
