//! Compression, as zlib does it.

use std::io::Write;

use flate2::Compression;
use flate2::write::ZlibEncoder;

/// `data` with zlib's header and checksum, compressed as hard as `level`, from 0 to 9.
pub(super) fn deflated(data: &[u8], level: u32) -> Vec<u8> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::new(level));
    // Writing to memory cannot fail.
    let _ = encoder.write_all(data);
    encoder.finish().unwrap_or_default()
}
