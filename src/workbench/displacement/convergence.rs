//! Meshes of the element on a solved scene, against a bound that needs no exact solution.
//!
//! −Π(λ) ≤ 𝓛(u) ≤ 𝓛(u_h) for every conforming element with exact integrals, and √(𝓛(u_h) + Π(λ)) / 𝒮(λ)^½ bounds its relative error in
//! the energy norm. An energy below the bound is impossible for such an element.

use super::{DisplacementElement, mesh::Patch};
use crate::report::text::number::{percent, significant};
use crate::workbench::diagnosis::known;
use crate::workbench::finding::{Fault, Measured, Property};
use crate::workbench::formulas::Family;
use crate::workbench::material::Material;
use crate::workbench::picture;
use crate::workbench::scene::{self, Exact};

pub const BOUND: Property<DisplacementElement> = Property {
    name: "bound",
    asks: "the energy of a solved scene lies above the guaranteed lower bound, on every mesh",
    usual: true,
    measure: bound,
};

pub const RATE: Property<DisplacementElement> = Property {
    name: "convergence",
    asks: "the guaranteed error of a smooth scene falls like h^k, k the degree along the sides, 2 at most",
    usual: true,
    measure: rate,
};

/// The solution has no more derivatives than this rate needs: mirrored at the roller, the load has a kink.
const SMOOTH: usize = 2;
/// Unknowns beyond which a dense factor takes too long.
const MOST_UNKNOWNS: usize = 700;
/// Largest shortfall of the rate from k that passes: meshes are coarse.
const SHORT: f64 = 0.4;
/// Of the energy, what rounding may take.
const ROUNDING: f64 = 1e-9;

/// One mesh.
pub struct Level {
    /// Cells along a side.
    pub cells: usize,
    /// Unknowns.
    pub unknowns: usize,
    /// 𝓛(u_h).
    pub energy: f64,
}

/// The scene solved on meshes of 2, 4, 8, … cells a side.
///
/// # Errors
/// There is no formula, or it fails.
pub fn levels(e: &DisplacementElement, material: &Material) -> Result<Vec<Level>, Fault> {
    let mut levels = Vec::new();
    for cells in [2, 4, 8, 16] {
        let patch = Patch::new(e, cells, 0.12)?;
        if 2 * patch.nodes.len() > MOST_UNKNOWNS {
            break;
        }
        let (energy, unknowns) = patch.energy(e, material, scene::load)?;
        levels.push(Level { cells: patch.cells(), unknowns, energy });
    }
    Ok(levels)
}

/// The enclosure of the exact energy, and the element solved on its meshes: computed once for the two properties that use it.
fn solved(e: &DisplacementElement) -> Result<&(Exact, Vec<Level>), Fault> {
    if let Some(solved) = e.solved.get() {
        return Ok(solved);
    }
    e.formula()?;
    let material = e.material()?;
    let solved = (scene::exact(&material)?, levels(e, &material)?);
    Ok(e.solved.get_or_init(|| solved))
}

/// By how much an energy is below the bound, relative to it.
fn below(exact: &Exact, level: &Level) -> f64 {
    ((exact.lower - level.energy) / exact.strain).max(0.0)
}

fn bound(e: &DisplacementElement) -> Result<Measured, Fault> {
    let (exact, levels) = solved(e)?;
    let below = |l: &Level| below(exact, l);
    let worst = levels.iter().max_by(|a, b| below(a).total_cmp(&below(b))).map_or((0.0, 0), |l| (below(l), l.cells));
    let sentence = match worst.0 <= ROUNDING {
        true => format!("Energies of {} meshes lie above the guaranteed bound; by this part below it", levels.len()),
        false => format!(
            "On {0} × {0} cells the energy lies below the guaranteed bound by the fraction given, which no conforming element with exact integrals can do",
            worst.1
        ),
    };
    Ok(Measured::new(worst.0, ROUNDING, sentence))
}

fn rate(e: &DisplacementElement) -> Result<Measured, Fault> {
    let (exact, levels) = solved(e)?;
    let material = e.material()?;
    // The energy of an element that does not conform may lie on either side.
    let conforms = known(e).is_none_or(|r| r.is_conforming());
    if conforms && levels.iter().any(|l| below(exact, l) > ROUNDING) {
        return Err(Fault::Failed(
            "The energy lies below the guaranteed bound: convergence cannot be measured.".into(),
        ));
    }
    let error = |l: &Level| if conforms { exact.guaranteed(l.energy) } else { exact.apart(l.energy) };
    let errors: Vec<f64> = levels.iter().map(error).collect();
    let (Some([before, last]), Some(level)) = (errors.last_chunk::<2>(), levels.last()) else {
        return Err(Fault::NotMade("two meshes would have too many unknowns".into()));
    };
    let (rate, wanted) = ((before / last).log2(), e.outline.degree().min(SMOOTH) as f64);
    let kind = if conforms { "guaranteed error" } else { "error, from the energy on either side of the exact one," };
    let text = format!(
        "The {kind} falls to {} on {2} × {2} cells, at the end like h^{1}; of the expected h^{wanted} this much is missing",
        percent(*last),
        significant(rate, 3),
        level.cells
    );
    let mut series = vec![(e.name.clone(), points(exact, levels))];
    for family in [Family::P1, Family::P2] {
        let other = family.element(family.words(), material, Default::default()).map_err(Fault::Failed)?;
        series.push((family.words().into(), points(exact, &self::levels(&other, &material)?)));
    }
    let drawn = picture::curves("Unknowns for a guaranteed error", ["guaranteed relative error", "unknowns"], &series);
    Ok(Measured::new((wanted - rate).max(0.0), SHORT, text).drawn(drawn))
}

fn points(exact: &Exact, levels: &[Level]) -> Vec<[f64; 2]> {
    levels.iter().map(|l| [exact.guaranteed(l.energy), l.unknowns as f64]).collect()
}
