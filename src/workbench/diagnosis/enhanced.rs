//! Mistakes of quadrilaterals that are more than their shape functions: incompatible modes, B-bar.

use super::{Reference, Trial};
use crate::scene::Kinematics;
use crate::workbench::displacement::DisplacementElement;
use crate::workbench::formulas::{Correction, Family, Variant, one_sided, with_rows};

/// Matrices that differ by less, relative to their size, are one.
const SAME: f64 = 1e-9;

/// Corrections of incompatible modes that are missing or halved, volume changes in some rows only.
pub(super) fn trials(e: &DisplacementElement, r: &Reference) -> Vec<Trial> {
    if r.family != Family::Q4 || r.rule != Variant::Right {
        return Vec::new();
    }
    let mut all = modes(r);
    if e.material.is_some_and(|m| m.kinematics == Kinematics::PlaneStrain) {
        all.extend(rows(r));
    }
    all
}

fn modes(r: &Reference) -> Vec<Trial> {
    let list = [
        (
            Correction::None,
            "the incompatible modes lack Taylor's correction: their gradients must be made by J of the middle, times det J₀ / det J",
        ),
        (Correction::WithoutRatio, "the incompatible modes lack the factor det J₀ / det J of Taylor's correction"),
        (
            Correction::RatioOnly,
            "the incompatible modes have the factor det J₀ / det J of Taylor's correction, but not J of the middle",
        ),
    ];
    let of = |(correction, text): (Correction, &'static str)| {
        [2, 3].into_iter().filter_map(move |points| {
            let matrix = r.variant(&r.hooke, Variant::Incompatible(correction, points)).ok()?;
            Some(Trial { rank: 2, cause: "taylor-correction", sentence: text.into(), matrix })
        })
    };
    list.into_iter().flat_map(of).collect()
}

fn rows(r: &Reference) -> Vec<Trial> {
    let (points, Ok(middle)) = (r.points(), r.family.middle(&r.nodes)) else { return Vec::new() };
    let mut all = Vec::new();
    let third = 1.0 / 3.0;
    for kind in 1..7 {
        let is = |bit: usize| kind >> bit & 1 == 1;
        let parts = std::array::from_fn(|i| if is(i) { third } else { 0.0 });
        let named: Vec<&str> = (0..3).filter(|i| is(*i)).map(|i| ["xx", "yy", "zz"][i]).collect();
        let plural = if named.len() == 1 { "row" } else { "rows" };
        let sentence = format!("B-bar (a third of the volume change) is in the {plural} {} only", named.join(" and "));
        let matrix = r.placed(&with_rows(&points, &middle, &r.hooke, parts));
        all.push(Trial { rank: 2, cause: "b-bar-rows", sentence, matrix });
    }
    for (row, parts) in [("xx", [0.5, 0.0, 0.0]), ("yy", [0.0, 0.5, 0.0])] {
        let sentence = format!("B-bar (half of the volume change) is in the row {row} only");
        let matrix = r.placed(&with_rows(&points, &middle, &r.hooke, parts));
        all.push(Trial { rank: 2, cause: "b-bar-rows", sentence, matrix });
    }
    for (row, parts) in [("xx", [1.0, 0.0, 0.0]), ("yy", [0.0, 1.0, 0.0]), ("xx and yy", [1.0, 1.0, 0.0])] {
        let sentence =
            format!("the whole volume change of the middle is put into {row}: a third, or half, belongs there");
        let matrix = r.placed(&with_rows(&points, &middle, &r.hooke, parts));
        all.push(Trial { rank: 2, cause: "b-bar-rows", sentence, matrix });
    }
    for parts in [[third; 3], [0.5, 0.5, 0.0]] {
        let [k, right] = [one_sided(&points, &middle, &r.hooke, parts), with_rows(&points, &middle, &r.hooke, parts)];
        // Where the change of volume in the middle is the mean one, one side is as good as both.
        if (&k - &right).norm() <= SAME * right.norm() {
            continue;
        }
        let k = r.placed(&k);
        let text = "B-bar stands on one side of Hooke's law only: Bᵀ D B̄ in place of B̄ᵀ D B̄";
        all.push(Trial { rank: 2, cause: "b-bar-rows", sentence: text.into(), matrix: k.transpose() });
        all.push(Trial { rank: 2, cause: "b-bar-rows", sentence: text.into(), matrix: k });
    }
    all
}
