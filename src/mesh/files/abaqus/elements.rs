//! Data lines of `*ELEMENT`.

use super::DAMAGED;
use super::keyword::{Keyword, Place};
use crate::mesh::MeshError;
use crate::mesh::files::content::Kind;

/// Number, nodes and place of an element.
type Row = (u64, Vec<u64>, Place);

/// The elements of a type with `count` nodes; one goes on in the next line until it has all its nodes.
pub(super) fn rows(keyword: &Keyword, name: &str, kind: Kind, count: usize) -> Result<Vec<Row>, MeshError> {
    let (mut rows, mut fields, mut place) = (Vec::new(), Vec::new(), &keyword.place);
    for line in &keyword.lines {
        if fields.is_empty() {
            place = &line.place;
        }
        for i in 0..line.fields.len() {
            fields.push(line.whole(i)?);
        }
        // Behind the nodes of a beam stands one for its direction.
        if fields.len() > count + 1 && kind != Kind::Line {
            let what = format!(
                "element {} of type {name} has {count} nodes, and {} numbers stand here",
                fields[0],
                fields.len() - 1
            );
            return Err(line.fault(what, "write each element into a line of its own"));
        }
        if fields.len() > count {
            rows.push((fields[0], fields[1..=count].to_vec(), place.clone()));
            fields.clear();
        }
    }
    if let (Some(tag), Some(line)) = (fields.first(), keyword.lines.last()) {
        let what = format!("element {tag} of type {name} has {} nodes, not {count}", fields.len() - 1);
        return Err(line.fault(what, DAMAGED));
    }
    Ok(rows)
}

/// Elements of any count of nodes, which go on behind a comma at the end of a line.
pub(super) fn of_any_length(keyword: &Keyword) -> Vec<Row> {
    let mut all: Vec<Row> = Vec::new();
    let mut continued = false;
    for line in &keyword.lines {
        let numbers = |from: usize| line.fields.iter().skip(from).filter_map(|field| field.parse().ok());
        match (all.last_mut(), line.fields.first().and_then(|field| field.parse().ok())) {
            (Some((_, nodes, _)), _) if continued => nodes.extend(numbers(0)),
            (_, Some(tag)) => all.push((tag, numbers(1).collect(), line.place.clone())),
            (_, None) => {}
        }
        continued = line.continues;
    }
    all
}

/// The error for elements in space, with how many there are where their name says how many nodes each has.
pub(super) fn in_space(keyword: &Keyword, name: &str) -> MeshError {
    let numbers: usize = keyword.lines.iter().map(|line| line.fields.len()).sum();
    let upper = name.to_ascii_uppercase();
    let rest = upper.split_once("3D").map(|(_, rest)| rest).or(upper.strip_prefix("SC"));
    let nodes = rest.and_then(|rest| {
        let digits = rest.find(|c: char| !c.is_ascii_digit()).unwrap_or(rest.len());
        rest[..digits].parse::<usize>().ok().filter(|n| *n > 0 && *n < 100)
    });
    let count = nodes.map_or(String::new(), |nodes| format!(", {} of them here", numbers / (nodes + 1)));
    let what = format!("elements {name} are cells in space{count}");
    keyword.fault(what, "this program is plane: write CPE, CPS or CAX elements")
}
