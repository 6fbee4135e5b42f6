//! NumPy's format of several arrays: a ZIP archive of `.npy` files, stored as they are.

use std::collections::BTreeMap;

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
        if entry.method != 0 {
            let what = format!("'{}' in it is compressed", entry.name);
            return Err((what, "write it with numpy.savez, not with numpy.savez_compressed"));
        }
        let content = stored(bytes, &entry).ok_or_else(|| fault(&format!("'{}' in it is cut off", entry.name)))?;
        let name = entry.name.strip_suffix(".npy").unwrap_or(&entry.name).to_string();
        arrays.insert(name, npy::parse(content)?);
        at = entry.next;
    }
    Ok(arrays)
}

/// A file of the archive.
struct Entry {
    name: String,
    method: u16,
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
        size: u32_at(bytes, at + 24)?,
        start: u32_at(bytes, at + 42)?,
        next: at + 46 + name + extra + comment,
    })
}

fn stored<'a>(bytes: &'a [u8], entry: &Entry) -> Option<&'a [u8]> {
    let at = entry.start;
    if bytes.get(at..)?.first_chunk()? != b"PK\x03\x04" {
        return None;
    }
    let from = at + 30 + u16_at(bytes, at + 26)? + u16_at(bytes, at + 28)?;
    bytes.get(from..from.checked_add(entry.size)?)
}

#[cfg(test)]
pub(super) mod tests {
    /// An archive with one stored file.
    pub fn archive(name: &str, content: &[u8]) -> Vec<u8> {
        let (size, length) = ((content.len() as u32).to_le_bytes(), (name.len() as u16).to_le_bytes());
        let mut bytes = b"PK\x03\x04".to_vec();
        bytes.extend([0; 14]);
        bytes.extend([size, size].concat());
        bytes.extend([length, [0, 0]].concat());
        bytes.extend(name.as_bytes());
        bytes.extend(content);
        let start = bytes.len() as u32;
        bytes.extend(b"PK\x01\x02");
        bytes.extend([0; 16]);
        bytes.extend([size, size].concat());
        bytes.extend(length);
        bytes.extend([0; 16]);
        bytes.extend(name.as_bytes());
        bytes.extend(b"PK\x05\x06\0\0\0\0\x01\0\x01\0");
        bytes.extend((46 + name.len() as u32).to_le_bytes());
        bytes.extend(start.to_le_bytes());
        bytes.extend([0, 0]);
        bytes
    }
}
