//! Functions of the arc length along a contact, piecewise linear by rows [s, value].

use std::ops::Range;

use crate::scene::reading::error::{Fault, SceneError};
use crate::scene::reading::raw::{At, Pair};
use crate::scene::reading::source::Source;

/// Least distance of two rows, in parts of the last arc length: both become vertices of the mesh.
const CLOSEST: f64 = 1e-9;
const CLOSE: (&str, &str) = (
    "no mesh can have vertices as close together as this row and the one before it",
    "move the two apart, or leave out one of them",
);
const ARC: (&str, &str) =
    ("an arc length is not negative", "measure s along the first side, from its end that comes first in (x, y) order");

/// The value at arc length `s`; constant beyond the first and the last row.
pub(in crate::scene) fn at(rows: &[[f64; 2]], s: f64) -> f64 {
    let after = rows.partition_point(|row| row[0] <= s);
    if after == 0 {
        rows[0][1]
    } else if after == rows.len() {
        rows[after - 1][1]
    } else {
        let ([s0, g0], [s1, g1]) = (rows[after - 1], rows[after]);
        g0 + (g1 - g0) * ((s - s0) / (s1 - s0))
    }
}

/// Checks the rows of `key`, whose values are not negative; `negative` says so.
pub(in crate::scene) fn table_of(
    rows: &[Pair],
    span: Range<usize>,
    (table, key): (&str, &'static str),
    negative: (&'static str, &'static str),
    source: &Source,
) -> Result<Vec<[f64; 2]>, SceneError> {
    if rows.is_empty() {
        let remedy = "write at least one row [s, value], or a number";
        let (found, expected) = ("0 rows".to_owned(), "at least one".to_owned());
        let fault = Fault::Count { key: key.to_owned(), table: table.to_owned(), found, expected, remedy };
        return Err(source.error(span, fault));
    }
    let mut checked: Vec<[f64; 2]> = Vec::with_capacity(rows.len());
    for (i, row) in rows.iter().enumerate() {
        let name = format!("{key}[{i}]");
        let [s, value] = source.vector(row, (table, &name))?;
        for (value, words) in [(s, ARC), (value, negative)] {
            let number = At { value, start: row.start, end: row.end };
            source.number(&number, (table, &name), |x| x >= 0.0, words)?;
        }
        if let Some([before, _]) = checked.last()
            && s <= *before
        {
            let relation = if s == *before { "the same as" } else { "less than" };
            let fault = Fault::GapOrder { row: i + 1, key, table: table.to_owned(), s: format!("{s:?}"), relation };
            return Err(source.error(row.span(), fault));
        }
        checked.push([s, value]);
    }
    let length = checked.last().map_or(0.0, |row| row[0]);
    if let Some(i) = (1..checked.len()).find(|&i| checked[i][0] - checked[i - 1][0] < CLOSEST * length) {
        let (key, found) = (format!("{key}[{i}]"), source.written(rows[i].span()));
        let fault = Fault::Number { key, table: table.to_owned(), found, rule: CLOSE.0, remedy: CLOSE.1 };
        return Err(source.error(rows[i].span(), fault).with_related(rows[i - 1].span(), "the row before"));
    }
    Ok(checked)
}
