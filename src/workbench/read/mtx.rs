//! MatrixMarket's text format.

use nalgebra::DMatrix;

use super::Fault;

const REMEDY: &str = "write it with scipy.io.mmwrite";
/// Rows and columns beyond which a matrix is none of one element.
const MOST: usize = 1000;

/// A real matrix, general, symmetric or skew-symmetric, by coordinates or in full.
pub fn parse(bytes: &[u8]) -> Result<DMatrix<f64>, Fault> {
    let fault = |what: String| (what, REMEDY);
    let text = std::str::from_utf8(bytes).map_err(|_| fault("it is no text".into()))?;
    let mut lines = text.lines().zip(1..);
    let head = lines.next().map(|(line, _)| line.to_lowercase()).unwrap_or_default();
    let words: Vec<&str> = head.split_whitespace().collect();
    let ["%%matrixmarket", "matrix", layout, kind, symmetry] = words[..] else {
        return Err(fault("it does not begin with %%MatrixMarket matrix".into()));
    };
    let by_coordinates = layout == "coordinate";
    let known = ["general", "symmetric", "skew-symmetric"].contains(&symmetry);
    if !["real", "integer", "double"].contains(&kind) || !known || !by_coordinates && layout != "array" {
        return Err(fault(format!(
            "it is {layout} {kind} {symmetry}; a stiffness matrix is real and general or symmetric"
        )));
    }
    let mut rows = lines.filter(|(line, _)| !line.trim_start().starts_with('%') && !line.trim().is_empty());
    let numbers =
        |line: &str| line.split_whitespace().map(|word| word.parse::<f64>().ok()).collect::<Option<Vec<f64>>>();
    let size: Vec<usize> = rows
        .next()
        .and_then(|(line, _)| line.split_whitespace().map(|word| word.parse().ok()).collect())
        .ok_or_else(|| fault("it has no line with its size".into()))?;
    let (n, m) = match size[..] {
        [n, m] if !by_coordinates => (n, m),
        [n, m, _] if by_coordinates => (n, m),
        _ => return Err(fault("the line with its size has the wrong number of figures".into())),
    };
    if n > MOST || m > MOST || symmetry != "general" && n != m {
        return Err(fault(format!("it is {n} × {m}, which is no matrix of one element")));
    }
    let sign = if symmetry == "skew-symmetric" { -1.0 } else { 1.0 };
    let mut matrix = DMatrix::zeros(n, m);
    // The entries that an array lists, column by column.
    let mut places = (0..m).flat_map(|j| (0..n).map(move |i| (i, j))).filter(|(i, j)| match symmetry {
        "general" => true,
        "symmetric" => i >= j,
        _ => i > j,
    });
    let mut found = 0;
    for (line, number) in rows {
        let place = |text: f64, end: usize| (1..=end).find(|k| *k as f64 == text).map(|k| k - 1);
        let entry = match (numbers(line).as_deref(), by_coordinates) {
            (Some([i, j, x]), true) => place(*i, n).zip(place(*j, m)).map(|at| (at, *x)),
            (Some([x]), false) => places.next().map(|at| (at, *x)),
            _ => None,
        };
        let Some(((i, j), x)) = entry else { return Err(fault(format!("line {number} is no entry of it: '{line}'"))) };
        matrix[(i, j)] += x;
        if symmetry != "general" && i != j {
            matrix[(j, i)] += sign * x;
        }
        found += 1;
    }
    let missing = if by_coordinates { found != size[2] } else { places.next().is_some() };
    if missing { Err(fault(format!("it has {found} entries and announces others"))) } else { Ok(matrix) }
}
