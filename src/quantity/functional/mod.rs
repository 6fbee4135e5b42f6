//! A quantity on a mesh, as a functional of the exact solution:
//!
//! Q = constant + ∫ q·u + ∫ χ:τ + ∫_{ΓK} φ t,
//!
//! with a load q, strains χ, and weights φ of the normal traction t, all per unit thickness. A force of a support is brought
//! into that form by a displacement w̃ that moves the support and vanishes at all vertices beyond it: with w̃ = −w there,
//! ∫_{Γu} T·w = F(w̃) − ∫ τ:e(w̃) + ∫_{ΓK} t j(w̃).
pub(super) mod form;
pub(super) mod local;
pub(super) mod projection;
pub(super) mod region;
pub(super) mod value;

use std::borrow::Cow;
use std::collections::BTreeSet;

use super::adjoint::lift::lift;
use super::adjoint::revolved;
use super::point::{Point, Wanted};
use super::tip::{NoTip, Tip};
use crate::bounds::{holds_at, jumps, work};
use crate::dual::Load;
use crate::element::Displacement;
use crate::element::revolved::Tensor;
use crate::load::BodyForce;
use crate::problem::{Condition, ContactPair, Problem, Sizes};
use crate::scene::{Component, Extent, Holder, PointValue, Quantity, Region, SupportKind, Target};
use local::Local;
use region::{Cut, cut, twice_area};

/// What a quantity is, for the words of reports.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Mean displacement.
    Displacement,
    /// Force of a contact or support.
    Force,
    /// Moment of a contact or support.
    Moment,
    /// Mean stress.
    Stress,
    /// Stress intensity at the tip of a crack.
    StressIntensity,
}

impl Kind {
    /// Whether it is what contacts or supports carry.
    pub fn is_carried(self) -> bool {
        matches!(self, Kind::Force | Kind::Moment)
    }

    /// The word for it.
    pub fn name(self) -> &'static str {
        match self {
            Kind::Displacement => "displacement",
            Kind::Force => "force",
            Kind::Moment => "moment",
            Kind::Stress => "stress",
            Kind::StressIntensity => "stress_intensity",
        }
    }

    /// What such a quantity has of `sizes`; a moment has the largest arm.
    pub fn size(self, problem: &Problem, sizes: &Sizes) -> f64 {
        match self {
            Kind::Displacement => sizes.displacement,
            Kind::Stress => sizes.stress,
            Kind::StressIntensity => {
                let [low, high] = [f64::min, f64::max]
                    .map(|of| [0, 1].map(|c| problem.mesh.points.iter().map(|p| p[c]).reduce(of).unwrap_or(0.0)));
                sizes.stress * (high[0] - low[0]).hypot(high[1] - low[1]).sqrt()
            }
            Kind::Moment => sizes.force * problem.mesh.points.iter().flatten().fold(0.0_f64, |m, x| m.max(x.abs())),
            Kind::Force => sizes.force,
        }
    }
}

/// Why a quantity is no bounded functional on a mesh.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NotBounded {
    /// A force of a support that meets another one.
    #[error(
        "the support meets another one at ({x}, {y}), and how they share the force there is no bounded functional; ask for \
         the force of what lies apart from it"
    )]
    Shared {
        /// Where.
        x: f64,
        /// Where.
        y: f64,
    },
    /// A region that leaves its body.
    #[error("of the region only {inside} % lie inside body '{body}'; give a region inside the body")]
    Outside {
        /// Per cent of the area, with one digit.
        inside: String,
        /// Name of the body.
        body: String,
    },
    /// A stress intensity where there is no tip of a crack.
    #[error(transparent)]
    NoTip(#[from] NoTip),
    /// A number that is no linear functional, but a function of several.
    #[error("`{word}` is no linear functional of the solution")]
    NotLinear {
        /// The word of the format.
        word: &'static str,
    },
    /// A point in a body whose values at points are no means with a known weight.
    #[error(
        "body '{body}' is not isotropic: the value at a point is a mean with a known weight only in isotropic bodies; ask for the mean over a \
         small region, `polygon = [...]` or `box = [...]` in the place of `point`"
    )]
    PointInAnisotropic {
        /// Name of the body.
        body: String,
    },
    /// A point that is not in its body.
    #[error("the point ({x}, {y}) does not lie in body '{body}'; give a point inside the body")]
    PointOutside {
        /// As written.
        x: f64,
        /// As written.
        y: f64,
        /// Name of the body.
        body: String,
    },
    /// A point where values are not bounded.
    #[error(
        "the point ({x}, {y}) lies on the outline of body '{body}', where a value at a point is no bounded functional; ask for {instead}"
    )]
    PointOnOutline {
        /// As written.
        x: f64,
        /// As written.
        y: f64,
        /// Name of the body.
        body: String,
        /// What is bounded, in the words of a scene.
        instead: String,
    },
    /// What has no interval in bodies of revolution.
    #[error(
        "a body of revolution has no interval for {what}; ask for the force of a contact, the axial force of a support, or a mean displacement or \
         stress"
    )]
    Revolved {
        /// In words.
        what: &'static str,
    },
    /// A boundary without edges.
    #[error("no edge of the mesh belongs to '{name}'")]
    Empty {
        /// Name of the boundary or body.
        name: String,
    },
}

/// A quantity on a mesh.
#[derive(Debug, Clone)]
pub struct Functional {
    /// What it is.
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
    /// What the load leaves of the quantity on a displacement w is at most Σ b_T ‖e(w)‖_T: triangles with their b_T.
    pub oscillation: Vec<(usize, f64)>,
    /// The part that is known.
    pub constant: f64,
    /// A displacement, linear on triangles, with jumps −φ, where there is one that meets the supports.
    pub lift: Option<Displacement>,
    /// What the value per unit thickness is multiplied by.
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
            Target::ContactForce { contact, window } => {
                let weight = |s: f64| window.map_or(1.0, |window| trapezoid(window, s));
                // Pressure is positive.
                Ok(on_contact(problem, *contact, Kind::Force, |_, pair| pair.arc.map(|s| -weight(s)).to_vec()))
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

    /// Whether it changes with a displacement that has no strain.
    pub fn is_of_place(&self) -> bool {
        let load = &self.load;
        !load.tractions.is_empty()
            || load.force.iter().any(|f| !f.is_none())
            || self.local.as_ref().is_some_and(|local| local.is_of_place())
    }

    /// Whether nothing but the normal traction of contacts, and what is known, enters.
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

/// What a force has that is not along the axis.
const RADIAL: &str = "a force of a support that is not along the axis";

/// Refuses what has no interval in bodies of revolution.
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

/// A weight: 0 at the first and last arc length, 1 between the inner two.
fn trapezoid([a, b, c, d]: [f64; 4], s: f64) -> f64 {
    let rise = if b > a {
        (s - a) / (b - a)
    } else if s < a {
        0.0
    } else {
        1.0
    };
    let fall = if d > c {
        (d - s) / (d - c)
    } else if s > d {
        0.0
    } else {
        1.0
    };
    rise.min(fall).clamp(0.0, 1.0)
}

fn on_boundary(problem: &Problem, name: &str, d: [f64; 2]) -> Result<Functional, NotBounded> {
    let edges = problem.mesh.boundary(name);
    let length = |e: usize| problem.mesh.edge_frame(e).0;
    // ∫ of a linear function, times the weight of the section.
    let integral = |e: usize, ends: [[f64; 2]; 2]| {
        let own = problem.weighted(e, ends);
        [0, 1].map(|c| length(e) * own.iter().map(|v| v[c]).sum::<f64>() / own.len() as f64)
    };
    let total: f64 = edges.iter().map(|&e| integral(e, [[1.0, 0.0]; 2])[0]).sum();
    if edges.is_empty() || total <= 0.0 {
        return Err(NotBounded::Empty { name: name.to_string() });
    }
    let mut functional = Functional::empty(problem, Kind::Displacement);
    let q = d.map(|d| d / total);
    for e in edges {
        match problem.conditions[e] {
            Condition::Clamped(ends) => {
                let [x, y] = integral(e, ends);
                functional.constant += q[0] * x + q[1] * y;
            }
            Condition::Roller { direction: [x, y], displacement } => {
                // What the roller prescribes is known; the load acts across it.
                let along = q[0] * x + q[1] * y;
                functional.constant += along * integral(e, [[displacement, 0.0]; 2])[0];
                functional.load.tractions.push((e, [[q[0] - along * x, q[1] - along * y]; 2]));
            }
            _ => functional.load.tractions.push((e, [q; 2])),
        }
    }
    Ok(functional)
}

fn on_body(problem: &Problem, body: usize, d: [f64; 2]) -> Result<Functional, NotBounded> {
    let volume = volume(problem, body)?;
    let mut functional = Functional::empty(problem, Kind::Displacement);
    functional.load.force[body] = d.map(|d| d / volume).into();
    Ok(functional)
}

/// The area of a body, with the weight of its section.
fn volume(problem: &Problem, body: usize) -> Result<f64, NotBounded> {
    let mesh = &problem.mesh;
    let own = (0..mesh.triangles.len()).filter(|&t| mesh.body[t] == body);
    let section = problem.section();
    let of = |t: usize| if section.is_revolved() { section.volume(mesh.corners(t)) } else { mesh.area(t) };
    let volume: f64 = own.map(of).sum();
    if volume > 0.0 { Ok(volume) } else { Err(NotBounded::Empty { name: problem.scene.bodies[body].name.clone() }) }
}

/// Parts of a region outside its body, relative to its area, that are rounding.
const OUTSIDE: f64 = 1e-9;

fn mean_stress(
    problem: &Problem,
    body: usize,
    region: &Region,
    component: Component,
) -> Result<Functional, NotBounded> {
    let mesh = &problem.mesh;
    let whole = |t: usize| Cut { triangle: t, pieces: Vec::new(), part: 1.0 };
    let (cuts, area) = match region {
        Region::Whole => {
            let own = (0..mesh.triangles.len()).filter(|&t| mesh.body[t] == body);
            (own.map(whole).collect(), volume(problem, body)?)
        }
        Region::Polygon(points) => {
            let (cuts, inside) = cut(problem, body, points);
            let area = 0.5 * twice_area(points);
            if inside < (1.0 - OUTSIDE) * area {
                let name = problem.scene.bodies[body].name.clone();
                return Err(NotBounded::Outside { inside: format!("{:.1}", 100.0 * inside / area), body: name });
            }
            (cuts, area)
        }
    };
    let mut functional = Functional::empty(problem, Kind::Stress);
    let [xx, yy, xy] = component.factors();
    if let Some(revolved) = problem.section().revolved() {
        let volume = revolved::volume(problem, revolved, &cuts);
        let chi = [xx, yy, component.hoop(), 0.5 * xy].map(|c| c / volume);
        functional.load.turned = cuts.iter().map(|cut| (cut.triangle, chi.map(|c| cut.part * c))).collect();
        functional.turned = Some((chi, cuts));
        return Ok(functional.beside(problem));
    }
    let chi = [xx / area, yy / area, 0.5 * xy / area];
    let mean = |cut: &Cut| (cut.triangle, chi.map(|c| cut.part * c));
    functional.load.strains = cuts.iter().map(mean).collect();
    functional.region = Some((chi, cuts));
    Ok(functional)
}

/// Weights on the pairs of one contact, by the coefficients that `weight` gives.
fn on_contact(
    problem: &Problem,
    contact: usize,
    kind: Kind,
    weight: impl Fn(&Problem, &ContactPair) -> Vec<f64>,
) -> Functional {
    let mut functional = Functional::empty(problem, kind);
    let mut next = 0;
    for (i, interface) in problem.interfaces.iter().enumerate() {
        for pair in &interface.pairs {
            if i == contact {
                functional.load.weights[next] = weight(problem, pair);
                let young = pair.edges[0].and_then(|e| problem.mesh.edges[e].triangles[0]);
                let young = young.map_or(0.0, |t| problem.material(problem.mesh.body[t]).young()[1]);
                functional.natural += young * functional.load.weights[next].iter().map(|w| w * w).sum::<f64>();
            }
            next += 1;
        }
    }
    functional.lift = lift(problem, &functional.load.weights);
    functional
}

/// r × n̂ about a point, as coefficients along the pair.
fn moment_of(problem: &Problem, pair: &ContactPair, about: [f64; 2]) -> Vec<f64> {
    let [a, b] = pair.first.map(|v| [0, 1].map(|c| problem.mesh.points[v][c] - about[c]));
    let [m, n] = pair.direction.ends;
    let cross = |r: [f64; 2], n: [f64; 2]| r[0] * n[1] - r[1] * n[0];
    // The product of two linear functions.
    vec![cross(a, m), 0.5 * (cross(a, n) + cross(b, m)), cross(b, n)]
}

/// Adds ∫ T·j(w) over all springs, whose traction T is −k j(u), for a motion w by edge and vertex, linear between.
fn pull_springs(problem: &Problem, functional: &mut Functional, motion: impl Fn(usize, usize) -> [f64; 2]) {
    let mesh = &problem.mesh;
    for (pair, stiffness) in problem.bed_pairs() {
        let [a, b] = mesh.edges[pair.edge].vertices;
        let facing = |v: usize, end: usize| {
            let other = pair.opposite.map_or([0.0; 2], |e| motion(e, mesh.edges[e].vertices[1 - end]));
            let own = motion(pair.edge, v);
            [own[0] - other[0], own[1] - other[1]]
        };
        let pulled = [facing(a, 0), facing(b, 1)].map(|jump| {
            let mut force = [0.0; 2];
            for (axis, k) in pair.axes.iter().zip(stiffness) {
                let along = -k * (jump[0] * axis[0] + jump[1] * axis[1]);
                (0..2).for_each(|c| force[c] += along * axis[c]);
            }
            force
        });
        if pulled != [[0.0; 2]; 2] {
            functional.load.tractions.push((pair.edge, pulled));
            let [first, last] = pulled.map(|force| force.map(|f| -f));
            functional.load.tractions.extend(pair.opposite.map(|e| (e, [last, first])));
        }
    }
}

/// The force or moment of a support, by the motion w that does unit work on it.
fn on_support(
    problem: &Problem,
    support: usize,
    kind: Kind,
    motion: impl Fn([f64; 2]) -> [f64; 2],
) -> Result<Functional, NotBounded> {
    let mesh = &problem.mesh;
    let name = &problem.scene.supports[support].on;
    let own: BTreeSet<usize> = mesh.boundary(name).into_iter().collect();
    if own.is_empty() {
        return Err(NotBounded::Empty { name: name.clone() });
    }
    if let SupportKind::Spring { .. } = problem.scene.supports[support].kind {
        let moved = |e: usize, v: usize| if own.contains(&e) { motion(mesh.points[v]) } else { [0.0; 2] };
        let mut functional = Functional::empty(problem, kind);
        pull_springs(problem, &mut functional, moved);
        return Ok(functional);
    }
    let prescribed = |e: usize, v: usize| {
        if own.contains(&e) { motion(mesh.points[v]).map(|w| -w) } else { [0.0; 2] }
    };
    let holds = holds_at(problem, prescribed).map_err(|error| match error {
        crate::bounds::NoUpperBound::SupportsDisagree { x, y }
        | crate::bounds::NoUpperBound::ForcedPenetration { x, y, .. } => NotBounded::Shared { x, y },
    })?;
    let mut vertex = vec![[0.0; 2]; mesh.points.len()];
    for v in own.iter().flat_map(|&e| mesh.edges[e].vertices) {
        vertex[v] = holds.vertices[v].impose([0.0; 2]);
    }
    if problem.section().is_revolved() && vertex.iter().any(|u| u[0] != 0.0) {
        return Err(NotBounded::Revolved { what: RADIAL });
    }
    let moved = Displacement::from_p1(mesh, &vertex);
    let mut functional = Functional::empty(problem, kind);
    pull_springs(problem, &mut functional, |_, v| vertex[v]);
    functional.constant = work(problem, &moved).value();
    let young: Vec<f64> = problem.materials().iter().map(|material| material.young()[1]).collect();
    for (t, triangle) in mesh.triangles.iter().enumerate() {
        let u = triangle.map(|v| vertex[v]);
        if u == [[0.0; 2]; 3] {
            continue;
        }
        let g = crate::element::geometry::gradients(mesh.corners(t));
        let d = |c: usize, x: usize| (0..3).map(|i| (u[i][c] - u[0][c]) * g[i][x]).sum::<f64>();
        let e = [d(0, 0), d(1, 1), 0.5 * (d(0, 1) + d(1, 0))];
        if problem.section().is_revolved() {
            let volume = problem.section().volume(mesh.corners(t));
            functional.load.turned.push((t, [0.0, -e[1], 0.0, -e[2]]));
            functional.natural += young[mesh.body[t]] * volume * (e[1] * e[1] + e[2] * e[2]);
            continue;
        }
        functional.load.strains.push((t, e.map(|e| -e)));
        functional.natural += young[mesh.body[t]] * mesh.area(t) * e.iter().map(|e| e * e).sum::<f64>();
    }
    let pairs = problem.pairs();
    for (weights, pair) in functional.load.weights.iter_mut().zip(pairs) {
        let along = jumps(problem, &moved, pair);
        if along.iter().any(|w| *w != 0.0) {
            *weights = along;
        }
    }
    Ok(functional.beside(problem))
}
