//! Rows of numbers as text.

use nalgebra::DMatrix;

use super::Fault;

/// Numbers with spaces, commas or semicolons between them, one row a line; `#` begins a comment.
pub fn parse(bytes: &[u8]) -> Result<DMatrix<f64>, Fault> {
    let remedy = "write one row a line, numbers separated by spaces or commas";
    let text = std::str::from_utf8(bytes).map_err(|_| ("it is no text".to_string(), remedy))?;
    let mut rows: Vec<Vec<f64>> = Vec::new();
    for (line, number) in text.lines().zip(1..) {
        let words = line.split('#').next().unwrap_or_default().split([' ', '\t', ',', ';']).filter(|w| !w.is_empty());
        let row: Result<Vec<f64>, _> = words.map(str::parse).collect();
        let row =
            row.map_err(|_| (format!("line {number} has a word that is no number: '{}'", line.trim()), remedy))?;
        if rows.first().is_some_and(|first| !row.is_empty() && first.len() != row.len()) {
            return Err((
                format!("line {number} has {} numbers and the first has {}", row.len(), rows[0].len()),
                remedy,
            ));
        }
        if !row.is_empty() {
            rows.push(row);
        }
    }
    let columns = rows.first().map_or(0, Vec::len);
    match columns {
        0 => Err(("there is no number in it".into(), remedy)),
        _ => Ok(DMatrix::from_row_slice(rows.len(), columns, &rows.concat())),
    }
}
