//! Contact checks, interface by interface.

pub(super) mod friction;
pub(super) mod mean;
pub(super) mod nodal;
pub(super) mod peak;
pub(super) mod piece;
pub mod pressure;
pub(super) mod resultant;
pub(super) mod slides;

use self::friction::on_contact;
use self::slides::{friction_resultant, reported_moment, trace_friction};
use super::candidate::{Judged, Reactions};
use super::ceiling::{Allowance, Ceilings};
use super::name::OfContact;
use super::outcome::{ContactSummary, Profile, TwoSides};
use super::tolerance::chosen;
use super::{Basis, Check};
use crate::dual::DualSolution;
use crate::problem::{ContactPair, Interface, Problem, Scales};
use nodal::{NodalDifference, nodal_pressures};
use peak::Peaks;
use pressure::{
    Piece, contact_ends, disagreement, dual_pressure, l2, maximum, open_length, profile, reaction_moment,
    reaction_pressure, resultant, resultant_of_pressure, trace_pressure, unweighted, without_radial,
};
use resultant::{forces, resultant_check};

/// Pressures below this fraction of the largest count as zero.
const NO_PRESSURE: f64 = 1e-9;
/// Pressures below this fraction of the stress scale of the loads count as zero, however large the others are.
const NO_STRESS: f64 = 1e-10;
/// Largest pressures below this fraction of it are not compared.
const SEEN: f64 = 1e-6;
/// Reactions below this fraction of the largest are solver residuals of zero.
const NO_REACTION: f64 = 1e-7;
/// A trace scatters around zero where the bodies are apart, by a few per cent of the largest pressure.
const NO_TRACE: f64 = 0.05;
/// Edges on which the models may disagree about contact, at its end.
const SETTLED: f64 = 3.0;
/// Round-off and solver accuracy of a single reaction, relative to all forces.
const REACTION: f64 = 1e-8;

/// The two sides of a comparison of contacts.
pub struct Sides<'a> {
    /// The scene on its mesh.
    pub problem: &'a Problem,
    /// Scales of round-off.
    pub scales: &'a Scales,
    /// Upper limits of the tolerances.
    pub ceilings: &'a Ceilings,
    /// λ_h.
    pub dual: &'a DualSolution,
    /// Gap between the lower bound and the best upper bound.
    pub gap: f64,
    /// The displacement solution to compare with.
    pub best: Option<&'a Judged>,
}

impl Sides<'_> {
    /// Compares the contacts; `all` are the displacement solutions to draw.
    pub fn compare(&self, all: &[Judged]) -> (Vec<ContactSummary>, Vec<Check>) {
        let (mut summaries, mut checks) = (Vec::new(), Vec::new());
        for (index, interface) in self.problem.interfaces.iter().enumerate() {
            let weighted = dual_pressure(self.dual, index);
            let own = unweighted(self.problem, interface, &weighted);
            let mut summary = self.summary((index, interface), &weighted);
            for judged in all {
                summary.profiles.extend(self.profiles(index, interface, judged));
            }
            if let Some(best) = self.best {
                checks.extend(self.primal_side(best, (index, interface), &own, &mut summary));
            }
            summaries.push(summary);
        }
        (summaries, checks)
    }

    /// Summary of a contact in the dual solution, with the pressure `own`.
    fn summary(&self, (index, interface): (usize, &Interface), own: &[Piece]) -> ContactSummary {
        let problem = self.problem;
        let length: f64 = interface.pairs.iter().map(|p| p.length).sum();
        let (force, moment) = resultant(problem, interface, own);
        let own = &unweighted(problem, interface, own);
        let (largest, at) = maximum(problem, interface, own);
        let threshold = self.open_below(NO_PRESSURE * largest);
        let open = open_length(interface, own, threshold);
        let friction = on_contact(problem, self.dual, index, (own, threshold));
        let (tangential, turning) = friction.as_ref().map_or(([0.0; 2], 0.0), |friction| friction.resultant);
        let (force, moment) = ([force[0] + tangential[0], force[1] + tangential[1]], moment + turning);
        // Of elastic contact no displacement moves the pressure alone.
        let bounded = !problem.section().is_revolved() && !is_elastic(interface);
        let around = || mean::around(problem, (index, interface), own, at, length - open, self.gap);
        ContactSummary {
            name: interface.name.clone(),
            resultant: TwoSides { dual: force, primal: None },
            moment: TwoSides { dual: about_zero(problem, moment, force), primal: None },
            pressure_max: TwoSides { dual: largest, primal: None },
            pressure_max_at: TwoSides { dual: problem.scene.as_written(at), primal: None },
            pressure_mean: if bounded { around() } else { None },
            open_fraction: open / length,
            open_fraction_primal: None,
            contact_ends: contact_ends(interface, own, threshold),
            pressure_l2_difference: None,
            friction: friction.map(|friction| friction.summary),
            length,
            profiles: vec![Profile { model: "dual".to_string(), points: profile(interface, own) }],
        }
    }

    /// Pressure curves of a displacement solution: from its reactions, and from its stresses.
    fn profiles(&self, index: usize, interface: &Interface, judged: &Judged) -> Vec<Profile> {
        let name = &judged.candidate.name;
        let reactions = reactions_on(judged, (index, interface)).map(|reactions| {
            let pieces = reaction_pressure(self.problem, interface, reactions);
            Profile { model: format!("{name} reactions"), points: profile(interface, &pieces) }
        });
        let pieces = trace_pressure(self.problem, interface, judged);
        let trace = Profile { model: format!("{name} trace"), points: profile(interface, &pieces) };
        reactions.into_iter().chain([trace]).collect()
    }

    fn primal_side(
        &self,
        best: &Judged,
        (index, interface): (usize, &Interface),
        own: &[Piece],
        summary: &mut ContactSummary,
    ) -> Vec<Check> {
        let problem = self.problem;
        let reactions = reactions_on(best, (index, interface));
        let pieces = match reactions {
            Some(reactions) => reaction_pressure(problem, interface, reactions),
            None => trace_pressure(problem, interface, best),
        };
        let along = friction_resultant(problem, interface, &trace_friction(problem, interface, best));
        let (force, moment) = together(resultant_of_pressure(problem, interface, &pieces), along);
        let force = reactions.map_or(force, |r| without_radial(problem, r.resultant));
        let of_reactions = |r| reaction_moment(problem, interface, r) + reported_moment(problem, interface, r);
        let moment = reactions.map_or(moment, of_reactions);
        let (largest, at) = maximum(problem, interface, &pieces);
        let (norm, difference) = l2(interface, own, &pieces);
        // Reactions are zero or not; a trace is never quite zero.
        let threshold = self.open_below(largest * if reactions.is_some() { NO_REACTION } else { NO_TRACE });
        summary.resultant.primal = Some(force);
        summary.moment.primal = Some(about_zero(problem, moment, force));
        summary.pressure_max.primal = Some(largest);
        summary.pressure_max_at.primal = Some(problem.scene.as_written(at));
        summary.open_fraction_primal = Some(open_length(interface, &pieces, threshold) / summary.length);
        let presses = norm > 0.0 && summary.pressure_max.dual > self.no_pressure();
        summary.pressure_l2_difference = presses.then(|| difference / norm);

        let mut checks = Vec::new();
        // A field that solves nothing promises no pressure; its trace is shown, and judged by the energy alone.
        if !best.candidate.is_solution || is_elastic(interface) {
            return checks;
        }
        // Elsewhere than on parallelograms the integrals of the solution are those of its own rule: no identity, and no bound.
        let by_rule = !best.candidate.is_polynomial() || problem.section().is_revolved();
        let bounded = reactions.filter(|_| !by_rule);
        let nodes = bounded.map(|r| nodal_pressures(problem, (index, interface), own, self.dual, best, r));
        let means = nodes.as_deref().and_then(nodal::difference);
        let floor = self.no_pressure().max(SEEN * self.scales.data.stress);
        let peaks = Peaks::new(problem, interface, nodes.as_deref().unwrap_or_default(), [own, &pieces]);
        checks.extend(means.and_then(|means| peaks.compared(summary, &means, &best.candidate.name, floor)));
        if reactions.is_some() {
            checks.push(resultant_check(self, best, (index, interface), summary.resultant.dual, force));
            let unexplained = means.map_or(0.0, |d| d.unexplained);
            checks.push(self.reactions_check(best, (index, interface), own, unexplained));
        }
        // Pressures that are round-off have neither a size nor an end.
        if largest.max(summary.pressure_max.dual) <= self.pressure_round_off(best, (index, interface)) {
            return checks;
        }
        match means {
            Some(difference) => checks.extend(self.bounded_pressure(best, (index, interface), &difference)),
            None => checks.extend(chosen_pressure(summary)),
        }
        let own_threshold = self.open_below(NO_PRESSURE * summary.pressure_max.dual);
        let disagree = disagreement(interface, (own, own_threshold), (&pieces, threshold));
        let pressed = 1.0 - summary.open_fraction;
        checks.push(Check::with_difference(
            &OfContact::OpenLength.of(&interface.name),
            summary.open_fraction,
            summary.open_fraction_primal.unwrap_or(f64::NAN),
            disagree.length / summary.length,
            (chosen("open-length") * pressed).max(SETTLED * disagree.longest / summary.length),
            Basis::Chosen,
            "Fraction of the contact that carries no pressure; what only one model calls open may be a tenth of what \
             carries pressure, or three edges.",
        ));
        checks
    }

    /// The pressure below which a contact is open, from the loads of the scene.
    fn no_pressure(&self) -> f64 {
        self.scales.round_off.stress.max(NO_STRESS * self.scales.data.stress)
    }

    /// The pressure below which an edge is open, if pressures of its contact below `part` count as zero.
    fn open_below(&self, part: f64) -> f64 {
        part.max(self.no_pressure())
    }

    /// Error of a single reaction by rounding and the accuracy of a solver, thickness included.
    fn reaction_round_off(&self, best: &Judged, (index, interface): (usize, &Interface), own: &[Piece]) -> f64 {
        let length: f64 = interface.pairs.iter().map(|p| p.length).sum();
        let largest = own.iter().flat_map(Piece::coefficients).fold(0.0_f64, |m, p| m.max(p.abs()));
        let carried = forces(self.problem).max(self.problem.scene.thickness * largest * length);
        let of_displacements = best.balance.as_ref().map(|b| b.reaction_tolerance(index));
        REACTION * carried + of_displacements.unwrap_or(0.0) + self.scales.round_off.force
    }

    /// Allowance for a force of interface `index` with the total error `all`, part of which is owing to the displacements of `best`.
    pub fn of_reaction(&self, best: &Judged, index: usize, all: f64) -> Allowance {
        let digits = best.balance.as_ref().map_or(0.0, |balance| balance.reaction_tolerance(index));
        Allowance { exact: all - digits, digits, ceiling: self.ceilings.force }
    }

    /// A force known to round-off is a pressure known to round-off over the length it acts on.
    fn pressure_round_off(&self, best: &Judged, (index, interface): (usize, &Interface)) -> f64 {
        let shortest = interface.pairs.iter().map(|p| p.length).fold(f64::INFINITY, f64::min);
        self.reaction_round_off(best, (index, interface), &[]) / (self.problem.scene.thickness * shortest)
            + self.scales.round_off.stress
    }

    fn reactions_check(
        &self,
        best: &Judged,
        (index, interface): (usize, &Interface),
        own: &[Piece],
        unexplained: f64,
    ) -> Check {
        let misreported = best.balance.as_ref().and_then(|b| b.reactions.get(index)).copied().unwrap_or(0.0);
        let name = OfContact::Reactions.of(&interface.name);
        let value = misreported.max(self.problem.scene.thickness * unexplained);
        let why = "Every reaction that the displacement model reports is what its stresses ask for at this vertex, their sum is \
             the reported resultant, and each differs from the dual force at its vertex by exactly the work of \
             λ_h − σ(u_h) on moving this vertex alone; the largest remainder.";
        self.of_reaction(best, index, self.reaction_round_off(best, (index, interface), own))
            .check_of_large(|allowed| Check::at_most(&name, value, 0.0, allowed, Basis::RoundOff, why))
    }

    /// Checks of pressures averaged at each vertex of Γ_K, whose difference is bounded by that of the stresses around it.
    fn bounded_pressure(
        &self,
        best: &Judged,
        (index, interface): (usize, &Interface),
        nodes: &NodalDifference,
    ) -> [Check; 2] {
        let length: f64 = interface.pairs.iter().map(|p| p.length).sum();
        let norm = nodes.norm.max(f64::MIN_POSITIVE);
        let largest = nodes.largest[0].max(f64::MIN_POSITIVE);
        let round_off = self.pressure_round_off(best, (index, interface)) + REACTION * norm / length.sqrt();
        [
            Check::at_most(
                &OfContact::PressureL2.of(&interface.name),
                nodes.l2 / norm,
                0.0,
                (nodes.l2_allowed + round_off * length.sqrt()) / norm,
                Basis::Guaranteed,
                "Contact pressures averaged with the hat function of each vertex, L² difference relative to the dual ones: \
                 the reaction at a vertex differs at most by what λ_h − σ(u_h) around it does on moving this vertex alone.",
            ),
            Check::with_difference(
                &OfContact::PressureMax.of(&interface.name),
                nodes.largest[0],
                nodes.largest[1],
                (nodes.largest[0] - nodes.largest[1]).abs() / largest,
                (nodes.largest_allowed + round_off) / largest,
                Basis::Guaranteed,
                "Largest of the contact pressures averaged with the hat function of each vertex, relative difference: \
                 limited by λ_h − σ(u_h) around that vertex.",
            ),
        ]
    }
}

/// The sum of forces and moments.
fn together((force, moment): ([f64; 2], f64), (other, more): ([f64; 2], f64)) -> ([f64; 2], f64) {
    ([force[0] + other[0], force[1] + other[1]], moment + more)
}

/// Checks of pressures of a field without reactions: theory does not limit their difference.
fn chosen_pressure(summary: &ContactSummary) -> Vec<Check> {
    let l2 = summary.pressure_l2_difference.map(|relative| {
        Check::at_most(
            &OfContact::PressureL2.of(&summary.name),
            relative,
            0.0,
            chosen("pressure-l2"),
            Basis::Chosen,
            "L² difference of the contact pressures relative to the dual one; the energy bound does not control it.",
        )
    });
    let (dual, primal) = (summary.pressure_max.dual, summary.pressure_max.primal.unwrap_or(f64::NAN));
    let max = Check::with_difference(
        &OfContact::PressureMax.of(&summary.name),
        dual,
        primal,
        (dual - primal).abs() / dual.max(primal),
        chosen("pressure-max"),
        Basis::Chosen,
        "Largest contact pressure, relative difference; a maximum is not controlled by the energy bound.",
    );
    l2.into_iter().chain([max]).collect()
}

/// The moment about the point (0, 0) of the file, from the moment about the origin of the internal coordinates.
fn about_zero(problem: &Problem, moment: f64, force: [f64; 2]) -> f64 {
    let [x, y] = problem.scene.origin;
    if [x, y] == [0.0; 2] || problem.section().is_revolved() { moment } else { moment + (x * force[1] - y * force[0]) }
}

fn is_elastic(interface: &Interface) -> bool {
    interface.pairs.iter().any(|pair| pair.stiffness.is_some())
}

/// The reactions of a solution on a contact, if all of them can be determined and compared: at the tip of a crack both sides end in
/// one vertex, where the jump is zero, and the reactions of elastic contact are spring forces.
fn reactions_on<'a>(judged: &'a Judged, (index, interface): (usize, &Interface)) -> Option<&'a Reactions> {
    let at_tip = |pair: &ContactPair| (0..2).any(|end| pair.shared(end).is_some());
    let all = judged.candidate.reactions.as_ref()?;
    all.get(index).filter(|_| !is_elastic(interface) && !interface.pairs.iter().any(at_tip))
}
