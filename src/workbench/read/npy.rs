//! NumPy's format of one array.

use nalgebra::DMatrix;

use super::{Array, Fault};

const REMEDY: &str = "write it with numpy.save or numpy.savez, as numbers of type float64";

/// Entries beyond which an array is no element.
const MOST: usize = 1 << 20;

/// Numbers in at most two dimensions, or text.
pub fn parse(bytes: &[u8]) -> Result<Array, Fault> {
    let fault = |what: &str| (what.to_string(), REMEDY);
    let rest = bytes.strip_prefix(b"\x93NUMPY").ok_or_else(|| fault("it does not begin as a NumPy array"))?;
    let (version, rest) = rest.split_first_chunk::<2>().ok_or_else(|| fault("it ends in its header"))?;
    let (length, rest) = match version[0] {
        1 => rest.split_first_chunk::<2>().map(|(n, rest)| (usize::from(u16::from_le_bytes(*n)), rest)),
        _ => rest.split_first_chunk::<4>().map(|(n, rest)| (u32::from_le_bytes(*n) as usize, rest)),
    }
    .ok_or_else(|| fault("it ends in its header"))?;
    let (header, data) = rest.split_at_checked(length).ok_or_else(|| fault("it ends in its header"))?;
    let header = std::str::from_utf8(header).map_err(|_| fault("its header is no text"))?;
    let kind = entry(header, "descr").ok_or_else(|| fault("its header has no type"))?.trim_matches(['\'', '"']);
    let shape = shape(header).ok_or_else(|| fault("its header has no shape"))?;
    let count = shape.iter().try_fold(1_usize, |n, k| n.checked_mul(*k)).filter(|n| *n <= MOST);
    let count = count.ok_or_else(|| fault("it has too many numbers for one element"))?;
    if let Some(length) = kind.strip_prefix("<U") {
        let length = length
            .parse()
            .ok()
            .filter(|n| *n < 1000 && count == 1)
            .ok_or_else(|| fault("its text is no single word"))?;
        let letters = data.chunks_exact(4).take(length).map(|c| u32::from_le_bytes([c[0], c[1], c[2], c[3]]));
        let text: String = letters.filter(|c| *c != 0).filter_map(char::from_u32).collect();
        return Ok(Array::Text(text));
    }
    let (rows, columns) = match *shape.as_slice() {
        [] => (1, 1),
        [n] => (n, 1),
        [n, m] => (n, m),
        _ => return Err(fault(&format!("it has {} dimensions, not two", shape.len()))),
    };
    let numbers = numbers(kind, data, count).ok_or_else(|| {
        fault(&format!("its {count} numbers of type {kind} cannot be read from {} bytes", data.len()))
    })?;
    let matrix = match entry(header, "fortran_order") {
        Some("True") => DMatrix::from_vec(rows, columns, numbers),
        _ => DMatrix::from_row_slice(rows, columns, &numbers),
    };
    Ok(Array::Numbers(matrix, kind.ends_with("f4")))
}

/// The text after a key of the header, up to the next comma or brace.
fn entry<'a>(header: &'a str, key: &str) -> Option<&'a str> {
    let after = header.split_once(&format!("'{key}'"))?.1.trim_start().strip_prefix(':')?.trim_start();
    Some(after[..after.find([',', '}'])?].trim())
}

fn shape(header: &str) -> Option<Vec<usize>> {
    let inside = header.split_once("'shape'")?.1.split_once('(')?.1.split_once(')')?.0;
    inside.split(',').map(str::trim).filter(|n| !n.is_empty()).map(|n| n.parse().ok()).collect()
}

fn numbers(kind: &str, data: &[u8], count: usize) -> Option<Vec<f64>> {
    fn all<const N: usize>(data: &[u8], count: usize, of: impl Fn([u8; N]) -> f64) -> Option<Vec<f64>> {
        let (chunks, _) = data.as_chunks::<N>();
        (chunks.len() >= count).then(|| chunks[..count].iter().map(|c| of(*c)).collect())
    }
    match kind {
        "<f8" => all(data, count, f64::from_le_bytes),
        ">f8" => all(data, count, f64::from_be_bytes),
        "<f4" => all(data, count, |b| f32::from_le_bytes(b).into()),
        ">f4" => all(data, count, |b| f32::from_be_bytes(b).into()),
        "<i8" => all(data, count, |b| i64::from_le_bytes(b) as f64),
        "<i4" => all(data, count, |b| i32::from_le_bytes(b).into()),
        _ => None,
    }
}
