//! A quantity on a mesh, as a functional of the exact solution:
//!
//! Q = constant + ∫ q·u + ∫ χ:τ + ∫_{ΓK} φ t,
//!
//! with a load q, strains χ, and weights φ of the normal traction t, all per unit thickness. A force of a support is brought
//! into that form by a displacement w̃ that moves the support and vanishes at all vertices beyond it: with w̃ = −w there,
//! ∫_{Γu} T·w = F(w̃) − ∫ τ:e(w̃) + ∫_{ΓK} t j(w̃).

mod carried;
mod contacts;
pub(super) mod form;
mod kind;
pub(super) mod local;
mod means;
mod not_bounded;
pub(super) mod projection;
pub(super) mod region;
mod supports;
pub(super) mod value;

use std::borrow::Cow;

use carried::{moment_on_first, tangential_force};
use contacts::{moment_of, on_contact, trapezoid};
pub use kind::Kind;
use means::{mean_stress, on_body, on_boundary};
pub use not_bounded::NotBounded;
use supports::on_support;

use super::point::{Point, Wanted};
use super::tip::Tip;
use crate::dual::Load;
use crate::element::Displacement;
use crate::element::revolved::Tensor;
use crate::load::BodyForce;
use crate::problem::Problem;
use crate::scene::{Extent, Holder, PointValue, Quantity, Target};
use local::Local;
use region::Cut;

/// A quantity on a mesh.
#[derive(Debug, Clone)]
pub struct Functional {
    /// Its kind.
    pub kind: Kind,
    /// q, φ, and χ as its mean over triangles that are cut.
    pub load: Load,
    /// χ of a region, constant in it; the load has it too.
    pub region: Option<([f64; 3], Vec<Cut>)>,
    /// χ (rr, zz, tt, rz) of a region of a body of revolution.
    pub turned: Option<(Tensor, Vec<Cut>)>,
    /// c χ on the triangles that the load has χ on.
    pub beside: Vec<(usize, Tensor)>,
    /// A value at a point or a stress intensity. The load has it once it is [`Self::loaded`].
    pub local: Option<Box<Local>>,
    /// ∫ c(χ − Πχ):(χ − Πχ) for each of the shaped strains Πχ of the load.
    pub rests: Vec<f64>,
    /// Bound Σ b_T ‖e(w)‖_T on the difference between quantity and load for a displacement w: triangles with their b_T.
    pub oscillation: Vec<(usize, f64)>,
    /// The part that is known.
    pub constant: f64,
    /// A displacement, linear on triangles, with jumps −φ, where there is one that meets the supports.
    pub lift: Option<Displacement>,
    /// Limits of the value per unit thickness, whatever the solution.
    pub within: [f64; 2],
    /// The factor from the value per unit thickness to the quantity.
    pub scale: f64,
    /// ‖σ‖² of a stress that such a quantity has where it is no matter of statics alone, in order of magnitude.
    pub natural: f64,
}

impl Functional {
    /// The functional of `quantity`.
    ///
    /// # Errors
    /// [`NotBounded`].
    pub fn new(problem: &Problem, quantity: &Quantity) -> Result<Self, NotBounded> {
        if problem.section().is_revolved() {
            refuse_in_revolved(&quantity.target)?;
        }
        match &quantity.target {
            Target::Displacement { of: Extent::Boundary(name), direction } => on_boundary(problem, name, *direction),
            Target::Displacement { of: Extent::Body(body), direction } => on_body(problem, *body, *direction),
            Target::Stress { body, region, component } => mean_stress(problem, *body, region, *component),
            Target::Point { body, at, value, smoothness } => {
                let wanted = match value {
                    PointValue::Displacement(direction) => Wanted::Displacement(*direction),
                    PointValue::Stress(component) => Wanted::Stress(component.factors()),
                    PointValue::Invariant(invariant) => return Err(NotBounded::NotLinear { word: invariant.word() }),
                };
                Self::at_point(problem, *body, *at, *smoothness, wanted)
            }
            Target::StressIntensity { mode, tip } => {
                let tip = Tip::new(problem, *mode, *tip)?;
                let constant = tip.of_body_force(problem);
                let own = Functional::empty(problem, Kind::StressIntensity);
                Ok(Functional { local: Some(Box::new(Local::Tip(tip))), constant, ..own })
            }
            Target::ContactForce { contact, tangential, window } => {
                if let (Some(window), Some([from, to])) = (window, extent(problem, *contact))
                    && (window[3] <= from || to <= window[0])
                {
                    return Err(NotBounded::WindowOutside { window: [window[0], window[3]], contact: [from, to] });
                }
                let weight = |s: f64| window.map_or(1.0, |window| trapezoid(window, s));
                if *tangential {
                    return tangential_force(problem, *contact, weight);
                }
                // Pressure is positive.
                Ok(on_contact(problem, *contact, Kind::Force, |_, pair| pair.arc.map(|s| -weight(s)).to_vec()))
            }
            Target::Moment { of: Holder::Contact(contact), about } if problem.rubs_on(*contact) => {
                moment_on_first(problem, *contact, *about)
            }
            Target::Moment { of: Holder::Contact(contact), about } => {
                Ok(on_contact(problem, *contact, Kind::Moment, |problem, pair| moment_of(problem, pair, *about)))
            }
            Target::SupportForce { support, direction } => on_support(problem, *support, Kind::Force, |_| *direction),
            Target::Moment { of: Holder::Support(support), about } => {
                on_support(problem, *support, Kind::Moment, |[x, y]| [about[1] - y, x - about[0]])
            }
        }
    }

    /// The signs that the value cannot have, negative and positive: contact does not pull, so that a force of it alone whose weight
    /// does not change its sign has one sign too.
    pub fn cannot_be(&self) -> [bool; 2] {
        if !self.is_of_contact_alone() || self.constant != 0.0 {
            return [false; 2];
        }
        // t ≤ 0.
        let all = |sign: f64| self.load.weights.iter().flatten().all(|w| sign * w >= 0.0);
        [all(-1.0), all(1.0)]
    }

    /// The value at a point.
    ///
    /// # Errors
    /// [`NotBounded::PointOutside`], [`NotBounded::PointOnOutline`].
    pub fn at_point(
        problem: &Problem,
        body: usize,
        at: [f64; 2],
        smoothness: usize,
        wanted: Wanted,
    ) -> Result<Self, NotBounded> {
        if problem.section().is_revolved() {
            return Err(NotBounded::Revolved { what: "values at points" });
        }
        let kind = match wanted {
            Wanted::Stress(_) => Kind::Stress,
            Wanted::Displacement(_) => Kind::Displacement,
        };
        let point = Point::new(problem, body, at, smoothness, wanted)?;
        Ok(Functional { local: Some(Box::new(Local::Point(point))), ..Functional::empty(problem, kind) })
    }

    /// The functional with all of its load, for fields of these degrees on each triangle and tractions of these on each edge.
    pub fn loaded(
        &self,
        problem: &Problem,
        stress_degree: impl Fn(usize) -> usize,
        edge_degree: impl Fn(usize) -> usize,
    ) -> Cow<'_, Functional> {
        let Some(local) = &self.local else { return Cow::Borrowed(self) };
        let mut own = Functional { local: None, ..self.clone() };
        local.load(problem, &mut own, stress_degree, edge_degree);
        Cow::Owned(own)
    }

    /// True if it changes with a displacement that has no strain.
    pub fn is_of_place(&self) -> bool {
        let load = &self.load;
        !load.tractions.is_empty()
            || load.force.iter().any(|f| !f.is_none())
            || self.local.as_ref().is_some_and(|local| local.is_of_place())
    }

    /// True if it depends on nothing but the normal traction of contacts and known terms.
    pub fn is_of_contact_alone(&self) -> bool {
        let load = &self.load;
        self.local.is_none()
            && load.tractions.is_empty()
            && load.strains.is_empty()
            && load.turned.is_empty()
            && load.shaped.is_empty()
            && load.edges.is_empty()
            && load.force.iter().all(BodyForce::is_none)
    }

    fn empty(problem: &Problem, kind: Kind) -> Self {
        let pairs = problem.interfaces.iter().map(|i| i.pairs.len()).sum();
        Functional {
            kind,
            load: Load {
                force: vec![BodyForce::NONE; problem.scene.bodies.len()],
                tractions: Vec::new(),
                strains: Vec::new(),
                turned: Vec::new(),
                shaped: Vec::new(),
                edges: Vec::new(),
                weights: vec![Vec::new(); pairs],
            },
            region: None,
            turned: None,
            beside: Vec::new(),
            local: None,
            rests: Vec::new(),
            oscillation: Vec::new(),
            constant: 0.0,
            lift: None,
            within: [f64::NEG_INFINITY, f64::INFINITY],
            scale: if matches!(kind, Kind::Force | Kind::Moment) { problem.scene.thickness } else { 1.0 },
            natural: 0.0,
        }
    }
}

impl Functional {
    /// With the stresses of the strains of its load in a body of revolution.
    fn beside(mut self, problem: &Problem) -> Self {
        let materials = problem.materials();
        let stress = |(t, chi): &(usize, Tensor)| (*t, materials[problem.mesh.body[*t]].revolved().stress(*chi));
        self.beside = self.load.turned.iter().map(stress).collect();
        self
    }
}

/// The arc lengths between which a contact lies; `None` where it has no edges.
fn extent(problem: &Problem, contact: usize) -> Option<[f64; 2]> {
    let pairs = &problem.interfaces.get(contact)?.pairs;
    Some([pairs.first()?.arc[0], pairs.last()?.arc[1]])
}

/// Name, in messages, of a force with a component across the axis.
const RADIAL: &str = "a force of a support that is not along the axis";

/// Refuses targets that have no interval in bodies of revolution.
fn refuse_in_revolved(target: &Target) -> Result<(), NotBounded> {
    let what = match target {
        Target::Displacement { .. } | Target::ContactForce { .. } | Target::Stress { .. } => return Ok(()),
        Target::SupportForce { direction: [across, _], .. } if *across == 0.0 => return Ok(()),
        Target::Point { .. } => "values at points",
        Target::StressIntensity { .. } => "stress intensities",
        Target::SupportForce { .. } => RADIAL,
        Target::Moment { .. } => "moments",
    };
    Err(NotBounded::Revolved { what })
}
