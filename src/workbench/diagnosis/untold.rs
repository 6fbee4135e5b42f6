//! Mistakes that a matrix of one shape cannot reveal, since they leave it unchanged.

use super::Reference;
use crate::report::text::number::significant;
use crate::workbench::displacement::DisplacementElement;
use crate::workbench::formulas::{Correction, Family, Variant};

/// Relative difference of what is the same.
const SAME: f64 = 1e-9;

/// In words; `None` for a formula, which is looked at on other shapes.
pub fn untold(e: &DisplacementElement) -> Option<String> {
    if e.has_formula() {
        return None;
    }
    let always = "A matrix of one shape cannot tell whether its formula is right on other shapes, sizes and directions, in other materials and on \
                  meshes: a right matrix is no right formula";
    let of_plane = || Reference::all(e).map(|all| unseen(e, &all[0])).unwrap_or_default();
    let list = if e.is_ring() { Vec::new() } else { of_plane() };
    let here = match list.as_slice() {
        [] => String::new(),
        list => format!(". On this shape it cannot tell {}", list.join("; ")),
    };
    let remedy = "Give the formula, from Python, or the matrix of an element without parallel sides, turned against the axes, with E and t \
                  that are not 1";
    Some(format!("{always}{here}. {remedy}."))
}

/// Mistakes that this shape and this material do not show.
fn unseen(e: &DisplacementElement, r: &Reference) -> Vec<String> {
    let mut list: Vec<String> = Vec::new();
    let mut push = |is_unseen: bool, text: String| {
        if is_unseen {
            list.push(text);
        }
    };
    let base = r.variant(&r.hooke, Variant::Right).unwrap_or_else(|_| r.matrix.clone());
    let same = |k: &nalgebra::DMatrix<f64>| (k - &base).amax() <= SAME.max(e.precision) * base.amax();
    let is_same = |variant| r.variant(&r.hooke, variant).is_ok_and(|k| same(&k));
    let coordinates = |nodes: &[[f64; 2]]| r.on(nodes, &r.hooke, Variant::Right).is_ok_and(|k| same(&k));
    let tolerance = SAME.max(e.precision);
    let points = r.family.points(&r.nodes, Variant::Right).unwrap_or_default();
    let is_constant = points.iter().all(|p| (p.det / points[0].det - 1.0).abs() <= tolerance);
    if let (true, Some(first)) = (is_constant, points.first()) {
        let det = if r.family.corners() == 4 { 0.25 * first.det } else { first.det };
        push(r.family.corners() == 4, "where det J is taken, for it is the same at all points".into());
        let text = match (det - 1.0).abs() <= tolerance {
            true => "whether det J, which is 1, is omitted or squared".into(),
            false => {
                format!("whether det J, {}, is omitted or squared from another Young's modulus", significant(det, 4))
            }
        };
        push(true, text);
    }
    if r.family == Family::Q4 {
        let [with, without] = [Correction::Taylor, Correction::None]
            .map(|c| r.family.stiffness(&r.nodes, &r.hooke, 1.0, Variant::Incompatible(c, 2)));
        if let (Ok(with), Ok(without)) = (with, without) {
            let is_alike = (&with - &without).amax() <= tolerance * with.amax();
            push(is_alike, "incompatible modes without Taylor's correction from those with it".into());
        }
    }
    push(is_same(Variant::Transposed), "J from its transpose".into());
    push(coordinates(&r.family.nodes()), "the element's coordinates from those of the reference element".into());
    let swapped: Vec<[f64; 2]> = r.nodes.iter().map(|[x, y]| [*y, *x]).collect();
    push(coordinates(&swapped), "x from y of the nodes".into());
    let first = [r.nodes[0], r.nodes[1]];
    push((first[1][1] - first[0][1]).abs() <= 1e-4 * e.outline.size, "local axes that are not rotated back".into());
    match e.material {
        None => push(true, "a wrong factor or a wrong material, for none is given to hold K against".into()),
        Some(m) => {
            push(m.young == 1.0, "whether E, which is 1, is there".into());
            push(m.thickness == 1.0, "whether t, which is 1, is there".into());
            push(m.poisson == 0.0, "plane strain from plane stress, for ν is 0".into());
        }
    }
    list
}
