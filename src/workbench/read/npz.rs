//! NumPy's format of several arrays: a ZIP archive of `.npy` files, stored as they are or deflated.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io::Read;

use flate2::read::DeflateDecoder;

use super::{Array, Fault, npy};

const REMEDY: &str = "write it again with numpy.savez(file, K=…, nodes=…)";

/// The arrays by name.
pub fn parse(bytes: &[u8]) -> Result<BTreeMap<String, Array>, Fault> {
    let fault = |what: &str| (what.to_string(), REMEDY);
    // The end of the directory: its signature, then counts, size and place.
    let end = bytes.windows(4).rposition(|w| w == b"PK\x05\x06").ok_or_else(|| fault("it is no archive of NumPy"))?;
    let (count, start) = (u16_at(bytes, end + 10), u32_at(bytes, end + 16));
    let (Some(count), Some(mut at)) = (count, start) else { return Err(fault("its directory is cut off")) };
    let mut arrays = BTreeMap::new();
    for _ in 0..count {
        let entry = directory(bytes, at).ok_or_else(|| fault("its directory is damaged"))?;
        let content = content(bytes, &entry)?;
        let name = entry.name.strip_suffix(".npy").unwrap_or(&entry.name).to_string();
        arrays.insert(name, npy::parse(&content)?);
        at = entry.next;
    }
    Ok(arrays)
}

/// Largest size of a deflated file in bytes, once unpacked: arrays have no more than a million numbers.
const LARGEST: u64 = 9 << 20;

/// The content of a file.
fn content<'a>(bytes: &'a [u8], entry: &Entry) -> Result<Cow<'a, [u8]>, Fault> {
    let fault = |what: &str| (format!("'{}' in it {what}", entry.name), REMEDY);
    let packed = packed(bytes, entry).ok_or_else(|| fault("is cut off"))?;
    match entry.method {
        STORED => Ok(Cow::Borrowed(packed)),
        DEFLATED => {
            let mut content = Vec::new();
            let read = DeflateDecoder::new(packed).take(LARGEST + 1).read_to_end(&mut content);
            match read {
                Ok(count) if count as u64 <= LARGEST => Ok(Cow::Owned(content)),
                _ => Err(fault("is damaged, or larger than 9 MiB")),
            }
        }
        _ => Err(fault("is packed in a way that NumPy does not write")),
    }
}

/// Ways of packing that NumPy writes.
const STORED: u16 = 0;
const DEFLATED: u16 = 8;

/// A file of the archive.
struct Entry {
    name: String,
    method: u16,
    /// Bytes that it takes in the archive.
    size: usize,
    /// Where its own header begins.
    start: usize,
    /// Where the next entry of the directory begins.
    next: usize,
}

fn u16_at(bytes: &[u8], at: usize) -> Option<usize> {
    Some(u16::from_le_bytes(*bytes.get(at..)?.first_chunk()?).into())
}

fn u32_at(bytes: &[u8], at: usize) -> Option<usize> {
    Some(u32::from_le_bytes(*bytes.get(at..)?.first_chunk()?) as usize)
}

fn directory(bytes: &[u8], at: usize) -> Option<Entry> {
    if bytes.get(at..)?.first_chunk()? != b"PK\x01\x02" {
        return None;
    }
    let [name, extra, comment] = [28, 30, 32].map(|k| u16_at(bytes, at + k));
    let (name, extra, comment) = (name?, extra?, comment?);
    let text = bytes.get(at + 46..at + 46 + name)?;
    Some(Entry {
        name: String::from_utf8_lossy(text).into_owned(),
        method: u16_at(bytes, at + 10)? as u16,
        size: u32_at(bytes, at + 20)?,
        start: u32_at(bytes, at + 42)?,
        next: at + 46 + name + extra + comment,
    })
}

/// A file as it is in the archive.
fn packed<'a>(bytes: &'a [u8], entry: &Entry) -> Option<&'a [u8]> {
    let at = entry.start;
    if bytes.get(at..)?.first_chunk()? != b"PK\x03\x04" {
        return None;
    }
    let from = at + 30 + u16_at(bytes, at + 26)? + u16_at(bytes, at + 28)?;
    bytes.get(from..from.checked_add(entry.size)?)
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// An archive with one stored file.
    pub fn archive(name: &str, content: &[u8]) -> Vec<u8> {
        packed_by(STORED, name, content, content.len())
    }

    fn packed_by(method: u16, name: &str, content: &[u8], whole: usize) -> Vec<u8> {
        let (size, whole) = ((content.len() as u32).to_le_bytes(), (whole as u32).to_le_bytes());
        let length = (name.len() as u16).to_le_bytes();
        let mut bytes = b"PK\x03\x04".to_vec();
        bytes.extend([0; 14]);
        bytes.extend([size, whole].concat());
        bytes.extend([length, [0, 0]].concat());
        bytes.extend(name.as_bytes());
        bytes.extend(content);
        let start = bytes.len() as u32;
        bytes.extend(b"PK\x01\x02");
        bytes.extend([0; 6]);
        bytes.extend(method.to_le_bytes());
        bytes.extend([0; 8]);
        bytes.extend([size, whole].concat());
        bytes.extend(length);
        bytes.extend([0; 16]);
        bytes.extend(name.as_bytes());
        bytes.extend(b"PK\x05\x06\0\0\0\0\x01\0\x01\0");
        bytes.extend((46 + name.len() as u32).to_le_bytes());
        bytes.extend(start.to_le_bytes());
        bytes.extend([0, 0]);
        bytes
    }

    #[test]
    fn deflated_arrays_are_those_that_were_packed() {
        let header = "{'descr': '<f8', 'fortran_order': False, 'shape': (2, 3), }";
        let mut npy = b"\x93NUMPY\x01\0".to_vec();
        npy.extend((header.len() as u16).to_le_bytes());
        npy.extend(header.as_bytes());
        (0..6).for_each(|i| npy.extend(f64::from(i).to_le_bytes()));
        let deflated = miniz_oxide::deflate::compress_to_vec(&npy, 6);
        let both = [archive("K.npy", &npy), packed_by(DEFLATED, "K.npy", &deflated, npy.len())];
        let [plain, packed] = both.map(|bytes| parse(&bytes).expect("an archive"));
        assert_eq!(plain, packed);
        let bytes = packed_by(DEFLATED, "K.npy", &deflated[..deflated.len() / 2], npy.len());
        assert!(parse(&bytes).is_err_and(|(what, _)| what.contains("damaged")));
    }
}
