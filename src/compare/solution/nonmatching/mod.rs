//! A claimed solution on the triangles of its own file, where contact sides have different vertices.
//!
//! Its test functions are those of the file. Whatever the method, mortar, node to segment or quadrature, contact is a pressure
//! λ ≥ 0 along the direction of contact, the same on both sides: on the parts of edges between the vertices of either side, the work of
//! λ on the jump is that of forces ≥ 0 on its Bernstein coefficients there, or at the nodes of the file. The part of the nodal forces that
//! such forces cannot balance is the residual; the energy identity checks that they do no work on the opening. A method may decide if contact is closed at the nodes
//! of one side, or in the mean with the functions of one side, plain or dual, or edge by edge: the least penetration among these counts.

mod forces;
mod penetration;
mod space;

use self::forces::{Row, groups, take};
use self::space::Space;
use super::Solution;
use super::weak::{OF_THE_RULE, Shape, Weak, nitsche};
use crate::compare::Basis;
use crate::compare::name::{OfRun, OfSolutionContact};
use crate::compare::{Allowances, Check};
use crate::problem::{Interface, Problem, Scales};

/// Largest number of coefficients of one contact for which its forces are computed.
const MOST_ROWS: usize = 1500;

/// The solution with its contact.
pub struct Nonmatching<'a> {
    /// The solution on its own triangles.
    pub solution: Solution<'a>,
    /// The problem whose sides were made to match.
    glued: &'a Problem,
    /// The contacts with more coefficients than [`MOST_ROWS`].
    too_many: Vec<usize>,
    /// For every contact: Nitsche's law, if its forces follow it.
    laws: Vec<Option<Weak>>,
}

impl<'a> Nonmatching<'a> {
    /// `solution` is on the mesh of `glued` before contact cut it.
    pub fn new(mut solution: Solution<'a>, glued: &'a Problem) -> Self {
        let space = Space::new(solution.problem, glued, solution.candidate.degree);
        let rows = |contact: &Interface| {
            let (mut rows, between) = (space.rows(&contact.pairs), space.between(&contact.pairs));
            if rows.len() + between.len() <= MOST_ROWS {
                rows.extend(between);
            }
            rows
        };
        let mut rows: Vec<Vec<Row>> = glued.interfaces.iter().map(rows).collect();
        let too_many: Vec<usize> = (0..rows.len()).filter(|i| rows[*i].len() > MOST_ROWS).collect();
        let law = |i: usize| {
            let pairs = &glued.interfaces[i].pairs;
            let limits = solution.limits(i);
            let points = |rule: usize, _: Shape| space.points(&solution, pairs, rule);
            let found = nitsche(&solution, &limits, &[Shape::Chords], points)?;
            (found.misfit <= solution.weak_part(i)).then_some(found)
        };
        let laws: Vec<Option<Weak>> =
            (0..rows.len()).map(|i| if too_many.contains(&i) { None } else { law(i) }).collect();
        for row in laws.iter().zip(&mut rows).filter(|(law, _)| law.is_some()).flat_map(|(_, rows)| rows) {
            row.overlap = row.excess(solution.candidate);
        }
        solution.beside.resize(solution.rest.len(), [0.0; 2]);
        for (node, force) in laws.iter().flatten().flat_map(|law| &law.terms) {
            let force = solution.hold(*node).project(*force);
            (0..2).for_each(|c| {
                solution.rest[*node][c] -= force[c];
                solution.beside[*node][c] += force[c];
            });
        }
        let all: Vec<&Row> = rows.iter().flatten().collect();
        for group in groups(&all, solution.rest.len()) {
            if group.len() <= MOST_ROWS {
                let rows: Vec<&Row> = group.into_iter().map(|row| all[row]).collect();
                let [on_gaps, force] = take(&rows, &mut solution);
                solution.on_gaps += on_gaps;
                let deepest = rows.iter().map(|row| row.excess(solution.candidate)).fold(0.0, f64::max);
                solution.of_the_rule += solution.rule() * force * deepest;
            }
        }
        Nonmatching { solution, glued, too_many, laws }
    }

    /// All checks; `scales` gives the forces and energies that count as zero, `allow` the tolerances asked for.
    pub fn checks(&self, scales: &Scales, allow: &Allowances) -> Vec<Check> {
        let mut checks = self.solution.checks(scales, &Allowances::default());
        if let Some(first) = self.too_many.first() {
            let name = &self.glued.interfaces[*first].name;
            let why = format!(
                "The sides of contact {name} have different vertices, more than {MOST_ROWS} together, and the forces between them were \
                 not looked for; give both sides the same vertices."
            );
            let forces = [OfRun::Residual, OfRun::SolutionReactions, OfRun::EnergyIdentity].map(OfRun::name);
            for check in checks.iter_mut().filter(|check| forces.contains(&check.name.as_str())) {
                *check = Check::not_made(&check.name, check.allowed, check.basis, why.as_str());
            }
        }
        checks.extend((0..self.glued.interfaces.len()).map(|index| self.penetration_check(index)));
        if let Some(contact) = self.glued.interfaces.iter().find(|contact| self.bends(contact)) {
            let why = format!(
                "The sides of contact {} divide a curve differently. What lies between their edges and along which normals forces act \
                 there each program decides for itself, and no field of its own is a solution for the edges of this report. Give both \
                 sides the same vertices.",
                contact.name
            );
            let of_contact =
                |check: &&mut Check| !check.passed && check.decides() && check.name != OfRun::Supports.name();
            for check in checks.iter_mut().filter(of_contact) {
                *check = Check::not_made(&check.name, check.allowed, check.basis, why.as_str());
            }
        }
        allow.apply(&mut checks);
        checks
    }

    /// True if vertices of the other side were inserted away from straight edges that represent a curve.
    fn bends(&self, contact: &Interface) -> bool {
        let Some(uncut) = &self.glued.uncut else { return false };
        let mesh = &self.glued.mesh;
        let is_cut = |e: &usize| mesh.edges[*e].triangles[0].is_some_and(|t| uncut.is_cut(mesh, t));
        contact.pairs.iter().any(|pair| !pair.direction.is_constant() && pair.edges.iter().flatten().any(is_cut))
    }

    /// The residual on the triangles of `glued`: that of the triangle of the file that each is a part of.
    pub fn by_triangle(&self) -> Vec<f64> {
        let own = self.solution.by_triangle();
        match &self.glued.uncut {
            Some(uncut) => uncut.parent.iter().map(|parent| own[*parent]).collect(),
            None => own,
        }
    }

    fn penetration_check(&self, index: usize) -> Check {
        let contact = &self.glued.interfaces[index];
        let (way, depth) = self.penetration(&contact.pairs);
        let depth = depth.max(0.0);
        let deepest = self.excesses(&contact.pairs).into_iter().flatten().fold(0.0, f64::max);
        let name = OfSolutionContact::Penetration.of(&contact.name);
        if let Some(law) = &self.laws[index] {
            let why = format!(
                "The sides have different vertices, and contact holds {}: what of the contact forces does not follow this law, relative \
                 to all of this contact. The sides overlap by up to {deepest:.3e}, which is no mistake of such a method; the bounds of \
                 this report are those of the field made admissible.",
                law.in_words()
            );
            return Check::at_most(&name, law.misfit, 0.0, self.solution.weak_part(index), Basis::Claimed, why);
        }
        let why = format!(
            "The sides have different vertices, and nothing penetrates {way}, relative to the largest displacement. Between these \
             places the deepest penetration is {deepest:.3e}."
        );
        let mut allowance = self.solution.of_displacements(2.0);
        let of_the_rule = |part: f64| part * self.solution.relative(deepest).min(allowance.ceiling);
        let claimable = self.solution.relative(depth) <= of_the_rule(OF_THE_RULE);
        allowance.exact += of_the_rule(self.solution.rule());
        let mut check = self.solution.claimed(&name, self.solution.relative(depth), allowance, why);
        if !check.passed && claimable {
            check.why += " A method that integrates contact by a rule of its own leaves as little; with --contact weak the field \
                          may say that it comes from one.";
        }
        check
    }
}
