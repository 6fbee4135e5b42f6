//! Guaranteed intervals for quantities, of second order (Prager and Synge's hypercircle, for contact).
//!
//! The exact stress τ lies within ‖τ − m‖² = H − X of m = (λ + σ(v))/2, where X ≥ 0 is what the contact conditions leave of
//! the gap G = 𝓛(v) + Π(λ) with the exact solution, and H = (G + C)/2 with the contact part C of G. An adjoint pair (σ_z, z)
//! with the normal traction s on Γ_K and k = j(z) + φ gives
//!
//! Q = Q_h + ∫ (σ_z − σ(z)) : a (τ − m) + ∫ t k + ∫ s (g − j(u)), Q_h = constant + F(z) − ∫ s g − ∫_{Γu} T(σ̂)·u0 + ∫ (σ_z − σ(z)) : a m,
//!
//! and with s ≥ ρ t(λ) and k ≤ ρ (g − j(v)), both by coefficients, Q ≥ Q_h − B(ρ), where B(ρ) is the largest
//! D √(H − X) + ρ X with D = ‖σ_z − σ(z)‖_a. The upper end is the lower one of −Q. Every pair gives a bound, good or poor.

use super::functional::Functional;
use super::pass::{Fields, Pass, pass, strained};
use crate::bounds::{
    Bracket, Nearest, NoUpperBound, NodalValues, Pull, Sum, Until, UpperBound, mid_field, openings, work, work_on_edge,
};
use crate::dual::equilibrium::edge_traction;
use crate::dual::{Bounds, DualSolution, Factorised, Loaded, Options, Response, Responses};
use crate::element::{Displacement, StressField, side, triangle};
use crate::problem::{Condition, ContactPair, Problem};

/// Relative error that the evaluation of a term can pick up.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Jumps beyond their bound by this part of the largest displacement are rounding, and enclosed as such.
const BEYOND: f64 = 1e-11;

/// Relative squares of stresses that are none: what is left is a matter of statics.
const NO_STRESS: f64 = 1e-18;

/// Contacts of up to so many jumps have a dense Schur complement.
const LONGEST_DENSE: usize = 6000;

/// How often, and by what factor, the ratio is raised where it gives nothing.
const MOST_RAISES: usize = 8;
const RAISE: f64 = 4.0;

/// Pressures below this part of the largest are none.
const NO_PRESSURE: f64 = 1e-9;

/// Factors of the ratio at which the contact costs nothing that are tried, beside one.
const FACTORS: [f64; 2] = [2.0, 0.5];

/// Part of the width that a sweep over z has to gain for another one to follow.
const WORTH_A_SWEEP: f64 = 0.01;

/// Tries in either direction at most.
const MOST_TRIES: usize = 3;

/// An interval that holds the exact value.
#[derive(Debug, Clone, PartialEq)]
pub struct Interval {
    /// Its ends; infinite where nothing is guaranteed.
    pub ends: [f64; 2],
    /// The interval that the stresses alone give, of first order.
    pub first_order: [f64; 2],
    /// The value of λ for forces and stresses, of v for displacements: nearer to the truth than the middle.
    pub value: f64,
    /// Whether equilibrium alone determines the value.
    pub exact_by_statics: bool,
    /// Why an end is infinite.
    pub reasons: [Option<String>; 2],
    /// What each triangle adds to the width.
    pub shares: Vec<f64>,
}

impl Interval {
    /// Nothing is known, for this reason.
    pub fn unknown(reason: &str) -> Self {
        let ends = [f64::NEG_INFINITY, f64::INFINITY];
        Interval {
            ends,
            first_order: ends,
            value: f64::NAN,
            exact_by_statics: false,
            reasons: [Some(reason.to_string()), Some(reason.to_string())],
            shares: Vec::new(),
        }
    }

    /// Half of the width.
    pub fn half_width(&self) -> f64 {
        0.5 * (self.ends[1] - self.ends[0])
    }
}

/// What is known of a problem that was solved.
pub struct Known<'a> {
    problem: &'a Problem,
    dual: &'a DualSolution,
    upper: &'a UpperBound,
    /// H, per unit thickness.
    square: f64,
    responses: Responses<'a>,
    nearest: Nearest<'a>,
    /// Coefficients of g − j(v) on every pair, not negative, in the degree of the bounds of z.
    openings: Vec<Vec<f64>>,
    /// m, of the degree of λ.
    middle: StressField,
    /// Coefficients of t(λ) one after the other.
    pressure: Vec<f64>,
}

impl<'a> Known<'a> {
    /// Gathers what all quantities need; `upper` is the bound of `bracket` that was built from `dual`.
    ///
    /// # Errors
    /// A sentence on what is missing.
    pub fn new(
        problem: &'a Problem,
        dual: &'a DualSolution,
        bracket: &Bracket,
        upper: &'a UpperBound,
        factorised: &'a Factorised,
        options: &Options,
    ) -> Result<Self, String> {
        let nearest = Nearest::new(problem, &dual.moments).map_err(|error| error.to_string())?;
        let gap = (upper.upper() - bracket.lower()).max(0.0);
        let of_contact = upper.local.pairs.iter().flatten().map(|p| p.max(0.0)).sum::<f64>() + upper.widening;
        let square = 0.5 * (gap + of_contact.min(gap)) / problem.scene.thickness;
        let open = |(pair, count): (&ContactPair, usize)| {
            let found = openings(problem, &upper.displacement, pair);
            in_degree(&found, count.max(1) - 1).into_iter().map(|o| o.max(0.0)).collect()
        };
        Ok(Known {
            problem,
            dual,
            upper,
            square,
            responses: factorised.responses(problem, LONGEST_DENSE, options),
            openings: pairs(problem).zip(nearest.counts()).map(open).collect(),
            nearest,
            middle: mid_field(problem, &dual.stress, &upper.displacement).ok_or("λ and v are on different meshes")?,
            pressure: dual.contact_traction.iter().flat_map(|of| of.values()).map(|t| t.min(0.0)).collect(),
        })
    }

    /// The interval of a quantity.
    pub fn interval(&self, functional: &Functional) -> Interval {
        let value = self.value(functional);
        let loaded = self.responses.to(&functional.load);
        let free = vec![f64::NEG_INFINITY; self.pressure.len()];
        let neutral = self.respond(&loaded, &free, 1.0);
        let search = Search { known: self, functional, loaded: &loaded };
        let (mut ends, mut reasons) = ([f64::NEG_INFINITY, f64::INFINITY], [None, None]);
        let mut first_order = ends;
        let mut shares = vec![0.0; self.problem.mesh.triangles.len()];
        let mut exact = false;
        match neutral {
            Err(reason) => reasons = [Some(reason.clone()), Some(reason)],
            Ok(neutral) => {
                let none = Pass::default();
                let mut found: [Option<End>; 2] = [None, None];
                for (end, sign) in [(0, 1.0), (1, -1.0)] {
                    let best = match &found[0] {
                        // Without contact one pair serves both ends.
                        Some(lower) if self.pressure.is_empty() => Ok(search.turned(lower)),
                        _ => search.best(&neutral, sign),
                    };
                    match best {
                        Ok(best) => {
                            ends[end] = sign * best.bound;
                            if let Some(first) = best.first_order {
                                first_order[end] = sign * first.0;
                            }
                            found[end] = Some(best);
                        }
                        Err(reason) => reasons[end] = Some(reason),
                    }
                }
                let pass = found.iter().flatten().map(|end| &end.pass).next().unwrap_or(&none);
                exact = functional.natural > 0.0
                    && found.iter().all(Option::is_some)
                    && pass.balanced <= NO_STRESS * functional.natural;
                for end in found.iter().flatten() {
                    self.add_shares(end, &mut shares);
                }
            }
        }
        let scaled = |v: f64| functional.scale * v;
        Interval {
            ends: ends.map(scaled),
            first_order: first_order.map(scaled),
            value: scaled(value.max(ends[0]).min(ends[1])),
            exact_by_statics: exact,
            reasons,
            shares: shares.into_iter().map(|s| functional.scale * s).collect(),
        }
    }

    fn respond(&self, loaded: &Loaded<'_>, floor: &[f64], sign: f64) -> Result<Response, String> {
        let bounds = Bounds { closed: self.dual.closed.values(), floor, sign };
        loaded.respond(bounds, &self.dual.moments).map_err(|error| error.to_string())
    }

    /// The ratio that the traction of `response` asks for where the contact presses.
    fn needed(&self, response: &Response, sign: f64) -> f64 {
        let most = self.pressure.iter().fold(0.0_f64, |m, t| m.max(-t));
        let pressing = self.pressure.iter().zip(response.contact.values()).filter(|(t, _)| -**t > NO_PRESSURE * most);
        pressing.map(|(t, s)| sign * s / t).fold(0.0, f64::max)
    }

    /// The quantity of λ and v.
    fn value(&self, functional: &Functional) -> f64 {
        let stress = &self.dual.stress;
        let mut sum = functional.constant
            + strained(self.problem, functional, |t| stress.degree(t), |t, s, l| stress.at(t, s, l));
        let pressures = self.dual.contact_traction.iter().flat_map(|of| of.iter());
        for ((pair, weights), t) in pairs(self.problem).zip(&functional.load.weights).zip(pressures) {
            sum += pair.length * side::integral(weights, t);
        }
        sum + displaced(self.problem, functional, &self.upper.displacement)
    }

    /// Adds what each triangle contributes to ρH + D²/(4ρ).
    fn add_shares(&self, end: &End, shares: &mut [f64]) {
        let ratio = end.weight(self.square);
        let thickness = self.problem.scene.thickness;
        for ((share, square), gap) in shares.iter_mut().zip(&end.pass.squares).zip(&self.upper.local.triangles) {
            *share += 0.5 * (ratio * 0.5 * gap.max(0.0) / thickness + square.max(0.0) / (4.0 * ratio));
        }
    }
}

/// ∫ q·v.
fn displaced(problem: &Problem, functional: &Functional, v: &Displacement) -> f64 {
    let mesh = &problem.mesh;
    let mut sum = Sum::default();
    for (e, ends) in &functional.load.tractions {
        sum.add(work_on_edge(problem, v, *e, *ends));
    }
    for t in 0..mesh.triangles.len() {
        let force = functional.load.force[mesh.body[t]];
        if force != [0.0; 2] {
            // Every Bernstein polynomial has the same mean.
            let values: Vec<[f64; 2]> = (0..3).flat_map(|sub| v.sub(t, sub)).collect();
            let count = values.len() as f64;
            let [x, y] = values.iter().fold([0.0; 2], |[x, y], u| [x + u[0], y + u[1]]);
            sum.add(mesh.area(t) / count * (force[0] * x + force[1] * y));
        }
    }
    sum.value()
}

/// The quantity of an admissible displacement alone: means of it and of its stress, and forces by the work that they do on
/// the motion which lifts them; `None` where no such motion meets the supports.
pub fn value_of(problem: &Problem, functional: &Functional, v: &Displacement) -> Option<f64> {
    use crate::bounds::strain::Strains;
    let materials = crate::dual::modes::materials(problem);
    let mut strains = Strains::default();
    let mut stress = |t: usize, sub: usize, l: [f64; 3]| {
        let material = &materials[problem.mesh.body[t]];
        material.stress(strains.on(problem.mesh.corners(t), v, t, sub).at(l))
    };
    let cell = std::cell::RefCell::new(&mut stress);
    let at = |t: usize, sub: usize, l: [f64; 3]| (cell.borrow_mut())(t, sub, l);
    let mut sum = functional.constant + displaced(problem, functional, v);
    sum += strained(problem, functional, |t| v.degree(t) - 1, at);
    if functional.load.weights.iter().any(|w| !w.is_empty()) {
        // ∫ φ t = −∫ t j(w̃) = F(w̃) − ∫ σ(v) : e(w̃).
        let lift = functional.lift.as_ref()?;
        sum += work(problem, lift).value() - product(problem, v, lift);
    }
    Some(functional.scale * sum)
}

/// ∫ σ(v) : e(w).
fn product(problem: &Problem, v: &Displacement, w: &Displacement) -> f64 {
    use crate::bounds::strain::{Strains, sub_area};
    use crate::element::quadrature::triangle_rule;
    let materials = crate::dual::modes::materials(problem);
    let (mut of_v, mut of_w) = (Strains::default(), Strains::default());
    let mut sum = Sum::default();
    for t in 0..problem.mesh.triangles.len() {
        if w.largest(t) == 0.0 {
            continue;
        }
        let corners = problem.mesh.corners(t);
        for sub in 0..3 {
            of_v.on(corners, v, t, sub);
            of_w.on(corners, w, t, sub);
            for (l, weight) in triangle_rule(v.degree(t) + w.degree(t) - 2) {
                let product = materials[problem.mesh.body[t]].strain_product(of_v.at(*l), of_w.at(*l));
                sum.add(weight * sub_area(corners) * product);
            }
        }
    }
    sum.value()
}

/// All pairs, one interface after the other.
fn pairs(problem: &Problem) -> impl Iterator<Item = &ContactPair> {
    problem.interfaces.iter().flat_map(|i| &i.pairs)
}

/// The coefficients of degree `degree` of a polynomial of no higher degree.
fn in_degree(coefficients: &[f64], degree: usize) -> Vec<f64> {
    match (coefficients.len() - 1).cmp(&degree) {
        std::cmp::Ordering::Equal => coefficients.to_vec(),
        std::cmp::Ordering::Less => side::elevate(coefficients, degree),
        std::cmp::Ordering::Greater => side::from_moments(&side::moments(coefficients, degree)),
    }
}

/// The search for one end.
struct Search<'s, 'a> {
    known: &'s Known<'a>,
    functional: &'s Functional,
    loaded: &'s Loaded<'s>,
}

/// A bound from one pair.
struct End {
    /// Lower bound of sign · Q, per unit scale.
    bound: f64,
    /// sign · Q_h.
    centre: f64,
    /// Bound and Q_h from z = 0, or a lift, where that has a finite one.
    first_order: Option<(f64, f64)>,
    /// D, rounding included.
    distance: f64,
    /// The ratio that s and k ask for.
    ratio: f64,
    pass: Pass,
    /// sign · z.
    nodes: NodalValues,
}

impl End {
    /// The ρ that makes ρH + D²/(4ρ) the width: at least the one that costs nothing.
    fn weight(&self, square: f64) -> f64 {
        let free = self.distance / (2.0 * square.sqrt());
        let ratio = self.ratio.max(free);
        if ratio.is_finite() && ratio > 0.0 { ratio } else { 1.0 }
    }
}

impl Search<'_, '_> {
    /// The best end for sign · Q that a few ratios give.
    fn best(&self, neutral: &Response, sign: f64) -> Result<End, String> {
        let known = self.known;
        let sigma = self.stress(&neutral.stress, sign);
        let moments = if sign < 0.0 { negated(neutral.moments.clone()) } else { neutral.moments.clone() };
        let mut start = known.nearest.start(&sigma, &moments);
        let begun = known.nearest.filled(&start, Pull { scene: 0.0, stress: Some(&sigma) });
        let begun = self.measured(neutral, Some((&begun, sign)), sign);
        // The ratio at which the contact begins to cost width.
        let free = |distance: f64| distance / (2.0 * known.square.sqrt());
        let mut best: Option<End> = None;
        let mut first_order = None;
        let mut attempt = |ratio: f64, best: &mut Option<End>| -> Result<bool, String> {
            let floor: Vec<f64> = known.pressure.iter().map(|t| ratio * t).collect();
            let response = known.respond(self.loaded, &floor, sign)?;
            let end = self.end(&response, sign, ratio, start.clone())?;
            first_order = first_order.into_iter().chain(end.first_order).reduce(better_of);
            let better = best.as_ref().is_none_or(|best| end.bound > best.bound);
            if better {
                start.clone_from(&end.nodes);
                *best = Some(end);
            }
            Ok(better)
        };
        let first = free(begun.distance);
        let first = if first.is_finite() && first > 0.0 { first } else { 1.0 };
        let mut reason = attempt(first, &mut best).err();
        // A body that contact alone holds needs a pressure to take off from.
        let finite = |best: &Option<End>| best.as_ref().is_some_and(|end| end.bound.is_finite());
        let needed = known.needed(neutral, sign);
        let mut ratio = first.max(needed);
        for _ in 0..MOST_RAISES {
            if finite(&best) {
                break;
            }
            ratio *= RAISE;
            reason = attempt(ratio, &mut best).err().or(reason);
        }
        let costs = |best: &Option<End>| best.as_ref().is_none_or(|end| end.ratio > free(end.distance));
        for factor in FACTORS {
            let mut ratio = first;
            for _ in 0..MOST_TRIES {
                if best.as_ref().is_some_and(|end| end.bound.is_finite()) && !costs(&best) {
                    break;
                }
                ratio *= factor;
                match attempt(ratio, &mut best) {
                    Ok(true) => {}
                    Ok(false) => break,
                    Err(why) => reason = Some(why),
                }
            }
        }
        match best.filter(|best| best.bound.is_finite()) {
            Some(best) => Ok(End { first_order, ..best }),
            None => Err(reason.unwrap_or_else(unbounded)),
        }
    }

    /// The other end of an interval without contact, from the pair of the lower one.
    fn turned(&self, lower: &End) -> End {
        let other = |bound: f64, centre: f64| bound - 2.0 * centre;
        End {
            bound: other(lower.bound, lower.centre),
            first_order: lower.first_order.map(|(bound, centre)| (other(bound, centre), -centre)),
            centre: -lower.centre,
            pass: lower.pass.clone(),
            nodes: lower.nodes.clone(),
            ..*lower
        }
    }

    /// sign · (σ̂ + cχ), χ by its mean where a triangle is cut.
    fn stress(&self, adjoint: &StressField, sign: f64) -> StressField {
        let problem = self.known.problem;
        let materials = crate::dual::modes::materials(problem);
        let mut sigma = adjoint.clone();
        for (t, chi) in &self.functional.load.strains {
            let add = materials[problem.mesh.body[*t]].stress(*chi);
            sigma.block_mut(*t).iter_mut().for_each(|s| (0..3).for_each(|c| s[c] += add[c]));
        }
        if sign < 0.0 {
            sigma.values_mut().as_flattened_mut().iter_mut().for_each(|s| *s = -*s);
        }
        sigma
    }

    /// The bound of `response` with the best z for `ratio`: the one that makes Q_h − ρH − D²/(4ρ) largest, which has the least
    /// energy under the pull of σ_z − 2ρm and of the loads of the scene times 2ρ.
    fn end(&self, response: &Response, sign: f64, ratio: f64, start: NodalValues) -> Result<End, String> {
        let known = self.known;
        let stress = less(self.stress(&response.stress, sign), 2.0 * ratio, &known.middle);
        let bounds: Vec<Vec<f64>> = known
            .openings
            .iter()
            .zip(&self.functional.load.weights)
            .map(|(open, weights)| {
                let weights =
                    if weights.is_empty() { vec![0.0; open.len()] } else { in_degree(weights, open.len() - 1) };
                open.iter().zip(weights).map(|(o, w)| ratio * o - sign * w).collect()
            })
            .collect();
        let pull = Pull { scene: 2.0 * ratio, stress: Some(&stress) };
        let until = Until::Gains(WORTH_A_SWEEP * 4.0 * ratio * ratio * known.square);
        let (z, nodes) = known.nearest.to(pull, &bounds, vec![start], until).map_err(|error| match error {
            NoUpperBound::ForcedPenetration { x, y, .. } | NoUpperBound::SupportsDisagree { x, y } => format!(
                "how contact and support share the force at ({x}, {y}), where they meet, is no bounded functional"
            ),
        })?;
        let end = self.measured(response, Some((&z, sign)), sign);
        let first = self.measured(response, self.functional.lift.as_ref().map(|lift| (lift, 1.0)), sign);
        let first_order = Some((first.bound, first.centre)).filter(|(bound, _)| bound.is_finite());
        Ok(End { nodes, first_order, ..end })
    }

    /// The bound of a pair; z is `lifted` times its sign, zero where there is none.
    fn measured(&self, response: &Response, lifted: Option<(&Displacement, f64)>, sign: f64) -> End {
        let Known { problem, dual, upper, square, pressure, .. } = self.known;
        let turned;
        let lifted = match lifted {
            Some((z, factor)) if factor < 0.0 => {
                turned = z.negated();
                Some(&turned)
            }
            other => other.map(|(z, _)| z),
        };
        let fields =
            Fields { stress: &dual.stress, displacement: &upper.displacement, adjoint: &response.stress, lifted };
        let pass = pass(problem, self.functional, fields);
        let slip = [0, 1].map(|i| ROUNDING * pass.uncancelled[i].sqrt());
        let distance = pass.square.max(0.0).sqrt() + slip[0];
        let mut rounding = distance * slip[1] + slip[0] * pass.middle.max(0.0).sqrt() + response.remainder;

        let mut sum = Sum::default();
        sum.add(self.functional.constant);
        sum.add(pass.work);
        if let Some(z) = lifted {
            let work = work(problem, z);
            sum.add(work.value());
            rounding += ROUNDING * work.magnitude();
        }
        for (pair, s) in pairs(problem).zip(response.contact.iter()) {
            sum.add(-pair.length * side::integral(s, &pair.gap));
        }
        for (e, condition) in problem.conditions.iter().enumerate() {
            let Condition::Clamped(u0) = condition else { continue };
            if *u0 != [0.0; 2] {
                let (length, _) = problem.mesh.edge_frame(e);
                let degree = problem.mesh.edges[e].triangles[0].map_or(1, |t| response.stress.degree(t));
                let tractions = edge_traction(problem, &response.stress, e, 0, degree);
                let share = length / tractions.len() as f64;
                tractions.iter().for_each(|t| sum.add(-share * (t[0] * u0[0] + t[1] * u0[1])));
            }
        }
        rounding += ROUNDING * sum.magnitude();

        let ratio = |over: f64, of: f64| {
            if over <= 0.0 {
                0.0
            } else if of > 0.0 {
                over / of
            } else {
                f64::INFINITY
            }
        };
        let mut asked = 0.0_f64;
        for (s, t) in response.contact.values().iter().zip(pressure) {
            asked = asked.max(ratio(-sign * s, -t));
        }
        // Jumps beyond their bound by rounding do work on the exact pressure, of the size of that of λ.
        let size = lifted.map_or(0.0, |z| (0..z.len()).map(|t| z.largest(t)).fold(0.0, f64::max));
        let mut excess = Vec::with_capacity(pressure.len());
        let pressures = dual.contact_traction.iter().flat_map(|of| of.iter());
        for ((pair, weights), t) in pairs(problem).zip(&self.functional.load.weights).zip(pressures) {
            let jumps = lifted.map_or_else(|| vec![0.0], |z| super::functional::jumps(problem, z, pair));
            let open = openings(problem, &upper.displacement, pair);
            let degree = jumps.len().max(open.len()).max(weights.len()) - 1;
            let [jumps, open] = [jumps, open].map(|c| side::elevate(&c, degree));
            let weights = if weights.is_empty() { vec![0.0; degree + 1] } else { side::elevate(weights, degree) };
            let slack = BEYOND * weights.iter().fold(size, |m, w| m.max(w.abs()));
            let force = 2.0 * pair.length * t.iter().map(|t| t.abs()).sum::<f64>() / t.len().max(1) as f64;
            for ((j, w), o) in jumps.iter().zip(&weights).zip(&open) {
                let (k, o) = (sign * (j + w), o.max(0.0));
                asked = asked.max(ratio(k - slack, o));
                excess.push((k, o, force));
            }
        }
        if asked.is_finite() {
            // Of the coefficients of a pair the largest excess counts; their sum is more.
            rounding += excess.iter().map(|(k, o, force)| (k - asked * o).max(0.0) * force).sum::<f64>();
        }
        let centre = sign * sum.value();
        let bound = centre - width(distance, *square, asked) - rounding;
        End { bound, centre, first_order: None, distance, ratio: asked, pass, nodes: NodalValues::none() }
    }
}

/// σ − factor · m, of the degree of m, which is no lower.
fn less(sigma: StressField, factor: f64, middle: &StressField) -> StressField {
    let mut out = middle.clone();
    for t in 0..out.len() {
        let degree = middle.degree(t);
        let nodes: Vec<[f64; 3]> = if degree == sigma.degree(t) {
            sigma.block(t).to_vec()
        } else {
            let points = || triangle::indices(degree).map(|i| i.map(|i| i as f64 / degree as f64));
            (0..3).flat_map(|sub| points().map(move |l| (sub, l))).map(|(sub, l)| sigma.at(t, sub, l)).collect()
        };
        for (value, sigma) in out.block_mut(t).iter_mut().zip(nodes) {
            *value = [0, 1, 2].map(|c| sigma[c] - factor * value[c]);
        }
    }
    out
}

fn negated(mut moments: crate::element::SideValues<[f64; 2]>) -> crate::element::SideValues<[f64; 2]> {
    moments.values_mut().as_flattened_mut().iter_mut().for_each(|m| *m = -*m);
    moments
}

/// The one with the larger bound.
fn better_of(a: (f64, f64), b: (f64, f64)) -> (f64, f64) {
    if b.0 > a.0 { b } else { a }
}

fn unbounded() -> String {
    "no adjoint stress and displacement fit the contact as it is".to_string()
}

/// The largest D √(H − X) + ρX for 0 ≤ X ≤ H.
fn width(distance: f64, square: f64, ratio: f64) -> f64 {
    if square == 0.0 {
        return if ratio.is_finite() { 0.0 } else { f64::INFINITY };
    }
    if 2.0 * ratio * square.sqrt() <= distance {
        return distance * square.sqrt();
    }
    ratio * square + distance * distance / (4.0 * ratio)
}
