//! Matrices and nodes from files: NumPy's `.npy` and `.npz`, MatrixMarket's `.mtx`, and tables of numbers.

mod mtx;
mod npy;
mod npz;
mod table;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use nalgebra::DMatrix;

/// Bytes of a file beyond which it is no element.
const LARGEST: u64 = 16 << 20;

/// A file that cannot be used.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{}: {what}; {remedy}", .file.display())]
pub struct ReadError {
    /// The file.
    pub file: PathBuf,
    /// The finding.
    pub what: String,
    /// The remedy.
    pub remedy: String,
}

/// Numbers in rows and columns; text and single numbers as they are.
#[derive(Debug, Clone, PartialEq)]
pub enum Array {
    /// A matrix; a list is one column. True if its numbers have single precision.
    Numbers(DMatrix<f64>, bool),
    /// Text.
    Text(String),
}

impl Array {
    /// The matrix.
    pub fn numbers(&self) -> Option<&DMatrix<f64>> {
        match self {
            Array::Numbers(matrix, _) => Some(matrix),
            Array::Text(_) => None,
        }
    }

    /// Its only number.
    pub fn number(&self) -> Option<f64> {
        self.numbers().filter(|m| m.len() == 1).map(|m| m[0])
    }
}

/// A fault inside a file: the finding and the remedy.
type Fault = (String, &'static str);

/// The arrays of a file by name. A file that holds one array calls it `K`.
///
/// # Errors
/// [`ReadError`].
pub fn arrays(file: &Path) -> Result<BTreeMap<String, Array>, ReadError> {
    let fault = |(what, remedy): Fault| ReadError { file: file.into(), what, remedy: remedy.into() };
    let kind = std::fs::metadata(file).map_err(|e| fault((format!("cannot be opened: {e}"), "check the path")))?;
    if !kind.is_file() {
        return Err(fault(("this is not a regular file".into(), "give the path of a file")));
    }
    if kind.len() > LARGEST {
        let what = format!("it has {} bytes, which is too much for one element", kind.len());
        return Err(fault((what, "write the matrix of a single element")));
    }
    let bytes = std::fs::read(file).map_err(|e| fault((format!("cannot be read: {e}"), "check its permissions")))?;
    let name = file.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default();
    parse(&bytes, &name).map_err(fault)
}

/// The arrays in the content of a file whose name ends with `extension`.
///
/// # Errors
/// The content cannot be read; the error is the finding and the remedy.
pub fn parse(bytes: &[u8], extension: &str) -> Result<BTreeMap<String, Array>, (String, &'static str)> {
    let one = |array| BTreeMap::from([("K".to_string(), array)]);
    match extension {
        "npz" => npz::parse(bytes),
        "npy" => npy::parse(bytes).map(one),
        "mtx" => mtx::parse(bytes).map(|m| one(Array::Numbers(m, false))),
        _ => table::parse(bytes).map(|m| one(Array::Numbers(m, false))),
    }
}

/// Points from a matrix of two columns.
///
/// # Errors
/// It has neither two columns nor a third one of zeros.
pub fn points(matrix: &DMatrix<f64>) -> Result<Vec<[f64; 2]>, String> {
    let flat = matrix.ncols() == 3 && matrix.column(2).iter().all(|z| *z == 0.0);
    if matrix.ncols() != 2 && !flat {
        return Err(format!(
            "nodes are {} × {} numbers; give x and y of a node on each row",
            matrix.nrows(),
            matrix.ncols()
        ));
    }
    Ok(matrix.row_iter().map(|row| [row[0], row[1]]).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Written by NumPy 1.24: np.save of np.array([[1., 2.], [3., 4.]]).
    fn npy(header: &str, data: &[u8]) -> Vec<u8> {
        let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
        let padded = format!("{header:<117}\n");
        bytes.extend((padded.len() as u16).to_le_bytes());
        bytes.extend(padded.as_bytes());
        bytes.extend(data);
        bytes
    }

    fn doubles() -> Vec<u8> {
        [1.0_f64, 2.0, 3.0, 4.0].iter().flat_map(|x| x.to_le_bytes()).collect()
    }

    #[test]
    fn numpy_arrays_of_either_order_are_read() {
        for (fortran, expected) in [("False", [1.0, 3.0, 2.0, 4.0]), ("True", [1.0, 2.0, 3.0, 4.0])] {
            let header = format!("{{'descr': '<f8', 'fortran_order': {fortran}, 'shape': (2, 2), }}");
            let found = parse(&npy(&header, &doubles()), "npy").expect("valid");
            assert_eq!(found["K"].numbers().expect("numbers").as_slice(), expected);
        }
    }

    #[test]
    fn matrix_market_has_both_layouts() {
        let text = "%%MatrixMarket matrix coordinate real symmetric\n% a comment\n2 2 2\n1 1 4.0\n2 1 -1e0\n";
        let found = parse(text.as_bytes(), "mtx").expect("valid");
        assert_eq!(found["K"].numbers().expect("numbers").as_slice(), [4.0, -1.0, -1.0, 0.0]);
        let text = "%%MatrixMarket matrix array real general\n2 2\n1\n2\n3\n4\n";
        let found = parse(text.as_bytes(), "mtx").expect("valid");
        assert_eq!(found["K"].numbers().expect("numbers").as_slice(), [1.0, 2.0, 3.0, 4.0]);
    }

    #[test]
    fn tables_may_have_commas_and_comments() {
        let found = parse(b"# x, y\n0, 0\n1,0 # a corner\n\n0 1\n", "csv").expect("valid");
        let nodes = points(found["K"].numbers().expect("numbers")).expect("two columns");
        assert_eq!(nodes, [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]);
        assert!(parse(b"0 0\n1\n", "txt").is_err() && parse(b"", "txt").is_err() && parse(b"a b\n", "txt").is_err());
    }

    /// Every change of one byte and every cut end in an answer or in an error.
    #[test]
    fn nothing_panics_on_changed_files() {
        let header = "{'descr': '<f8', 'fortran_order': False, 'shape': (2, 2), }";
        let market = "%%MatrixMarket matrix coordinate real symmetric\n2 2 2\n1 1 4.0\n2 1 -1e0\n";
        let array = npy(header, &doubles());
        let files = [
            ("npy", array.clone()),
            ("mtx", market.as_bytes().to_vec()),
            ("npz", npz::tests::archive("K.npy", &array)),
        ];
        for (kind, bytes) in files {
            assert!(parse(&bytes, kind).is_ok(), "{kind}");
            for at in 0..bytes.len() {
                let _ = parse(&bytes[..at], kind);
                for value in [0, 1, b'9', b'-', b' ', 0x7f, 0xff, bytes[at].wrapping_add(1)] {
                    let mut changed = bytes.clone();
                    changed[at] = value;
                    let _ = parse(&changed, kind);
                }
            }
        }
    }
}
