//! Values at points from a table: each line asks the scene for one quantity and holds a value against it.

use crate::scene::{Component, Invariant, PointValue, Quantity, Scene, Target};
use crate::study::GivenValue;

/// A line of the table.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// From 1, the header being the first.
    line: usize,
    name: Option<String>,
    body: Option<String>,
    at: Option<[f64; 2]>,
    quantity: Option<String>,
    value: f64,
    /// The value as it is written.
    written: String,
}

/// Names that the columns may have.
const COLUMNS: [&str; 6] = ["name", "body", "x", "y", "quantity", "value"];

/// The required shape of a table, in words.
pub const SHAPE: &str = "write a header `name,value`, or `x,y,quantity,value` (and `body` where the scene has several), then one line for each \
                         value; quantities are xx, yy, xy, von-mises, largest-principal, smallest-principal, ux and uy";

/// A text without the byte order mark that spreadsheets begin UTF-8 with.
fn unmarked(text: &str) -> &str {
    text.trim_start_matches('\u{feff}')
}

/// True if a file of this text is such a table: its first line has a column for values.
pub fn is_table(text: &str) -> bool {
    unmarked(text).lines().next().is_some_and(|line| {
        let columns = cells(line, separator(line));
        columns.len() > 1 && columns.iter().any(|column| column.eq_ignore_ascii_case("value"))
    })
}

/// Reads a table.
///
/// # Errors
/// A sentence with the line.
pub fn read(text: &str) -> Result<Vec<Row>, String> {
    let mut lines = unmarked(text).lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
    let Some((_, header)) = lines.next() else { return Err("it is empty".to_string()) };
    let by = separator(header);
    let columns: Vec<String> = cells(header, by).iter().map(|column| column.to_lowercase()).collect();
    for (i, column) in columns.iter().enumerate() {
        if !COLUMNS.contains(&column.as_str()) {
            return Err(format!("line 1: nothing is known of a column '{column}'"));
        }
        if columns[..i].contains(column) {
            return Err(format!("line 1: there are two columns '{column}'"));
        }
    }
    let row = |(i, line): (usize, &str)| {
        let line_number = i + 1;
        let found = cells(line, by);
        if found.len() != columns.len() {
            return Err(format!("line {line_number}: {} cells in place of {}", found.len(), columns.len()));
        }
        let cell = |name: &str| {
            let at = columns.iter().position(|column| column == name)?;
            Some(found[at]).filter(|cell| !cell.is_empty())
        };
        let number = |name: &str| match cell(name) {
            None => Ok(None),
            Some(text) => match text.parse::<f64>() {
                Ok(number) if number.is_finite() => Ok(Some(number)),
                _ => Err(format!("line {line_number}: {name} is '{text}', no finite number")),
            },
        };
        let value = number("value")?.ok_or_else(|| format!("line {line_number}: there is no value"))?;
        let at = match (number("x")?, number("y")?) {
            (Some(x), Some(y)) => Some([x, y]),
            (None, None) => None,
            _ => return Err(format!("line {line_number}: one of x and y is missing")),
        };
        let [name, body, quantity] = ["name", "body", "quantity"].map(|name| cell(name).map(str::to_string));
        let written = cell("value").unwrap_or_default().to_string();
        Ok(Row { line: line_number, name, body, at, quantity, value, written })
    };
    lines.map(row).collect()
}

impl Row {
    fn given(&self, name: String) -> GivenValue {
        GivenValue::written(name, self.value, &self.written)
    }

    /// The value, and the quantity that the scene has to be asked for.
    ///
    /// # Errors
    /// A sentence with the line.
    fn asked(&self, scene: &Scene) -> Result<(GivenValue, Option<Quantity>), String> {
        let line = self.line;
        let Some(written) = self.at else {
            let name = self.name.clone().ok_or_else(|| format!("line {line}: neither a name nor a point"))?;
            return Ok((self.given(name), None));
        };
        let word = self.quantity.as_deref().ok_or_else(|| format!("line {line}: no quantity at the point"))?;
        let value = match word {
            "xx" => PointValue::Stress(Component::XX),
            "yy" => PointValue::Stress(Component::YY),
            "xy" => PointValue::Stress(Component::XY),
            "ux" => PointValue::Displacement([1.0, 0.0]),
            "uy" => PointValue::Displacement([0.0, 1.0]),
            other => match Invariant::ALL.into_iter().find(|known| known.word() == other) {
                Some(invariant) => PointValue::Invariant(invariant),
                None => return Err(format!("line {line}: there is no quantity '{other}'")),
            },
        };
        let body = match &self.body {
            Some(body) => scene.bodies.iter().position(|own| own.name == *body),
            None if scene.bodies.len() == 1 => Some(0),
            None => {
                return Err(format!(
                    "line {line}: the scene has several bodies; a column `body` says in which the point lies"
                ));
            }
        };
        let body =
            body.ok_or_else(|| format!("line {line}: there is no body '{}'", self.body.as_deref().unwrap_or("")))?;
        let [x, y] = written;
        let name = self.name.clone().unwrap_or_else(|| format!("{word} at ({x}, {y})"));
        let target = Target::Point { body, at: written, value, smoothness: value.smoothness() };
        Ok((self.given(name.clone()), Some(Quantity { name, target })))
    }
}

/// The scene with the quantities of a table, and the values.
///
/// # Errors
/// A sentence: a line fits no scene, or names a quantity that the scene has already.
pub fn asked(scene: &Scene, rows: &[Row]) -> Result<(Option<Scene>, Vec<GivenValue>), String> {
    let mut values = Vec::with_capacity(rows.len());
    let mut quantities = Vec::new();
    for row in rows {
        let (value, quantity) = row.asked(scene)?;
        if values.iter().any(|known: &GivenValue| known.name == value.name) {
            return Err(format!("line {}: '{}' has a value already", row.line, value.name));
        }
        values.push(value);
        quantities.extend(quantity);
    }
    if quantities.is_empty() {
        return Ok((None, values));
    }
    let changed = scene.changed(|draft| {
        let origin = draft.origin;
        for mut quantity in quantities {
            if let Target::Point { at, .. } = &mut quantity.target {
                *at = [0, 1].map(|c| at[c] - origin[c]);
            }
            draft.quantities.push(quantity);
        }
    });
    Ok((Some(changed.map_err(|error| error.to_string())?), values))
}

/// The sign between cells: a semicolon where the header has one.
fn separator(header: &str) -> char {
    if header.contains(';') { ';' } else { ',' }
}

/// The cells of a line; quotation marks may hold one together.
fn cells(line: &str, by: char) -> Vec<&str> {
    let (mut cells, mut start, mut quoted) = (Vec::new(), 0, false);
    for (i, c) in line.char_indices() {
        match c {
            '"' => quoted = !quoted,
            c if c == by && !quoted => {
                cells.push(&line[start..i]);
                start = i + c.len_utf8();
            }
            _ => {}
        }
    }
    cells.push(&line[start..]);
    cells.into_iter().map(|cell| cell.trim().trim_matches('"').trim()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_is_read_line_by_line() {
        let rows = read("x;y;quantity;value;name\n1.0; 2;xx;-3e1;\"a; b\"\n\n0;0;uy;1;\n").expect("a table");
        assert_eq!(rows.len(), 2);
        assert_eq!(rows[0].name.as_deref(), Some("a; b"));
        assert_eq!((rows[0].at, rows[0].value, rows[1].line), (Some([1.0, 2.0]), -30.0, 4));
        assert!(is_table("name,value\nq,1") && !is_table("q = 1") && !is_table("{\"q\": 1}"));
        for (text, words) in [
            ("", "empty"),
            ("name,value\nq", "line 2: 1 cells"),
            ("name,wert\nq,1", "column 'wert'"),
            ("name,name,value\nq,q,1", "two columns"),
            ("x,y,quantity,value\n1,2,xx,much", "line 2: value is 'much'"),
            ("x,y,quantity,value\n1,,xx,1", "one of x and y"),
            ("name,value\nq,nan", "no finite number"),
        ] {
            let error = read(text).expect_err(text);
            assert!(error.contains(words), "{error}");
        }
    }
}
