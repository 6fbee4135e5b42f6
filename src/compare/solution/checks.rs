//! The checks of a field that claims to be a discrete solution.

use super::{SOLVER, Site, Solution, Weak};
use crate::bounds::Hold;
use crate::compare::ceiling::Allowance;
use crate::compare::name::OfRun;
use crate::compare::name::OfSolutionContact::{
    self, Friction, Penetration, PenetrationAtNodes, PressureWhereOpen, Pulling,
};
use crate::compare::{Allowances, Basis, Check};
use crate::problem::Scales;

/// Forces on a body below this part of those of the scene are none.
const NO_FORCE: f64 = 1e-6;

/// Number of nodes with a large residual that are named.
const NAMED: usize = 3;

impl Solution<'_> {
    /// All checks; `scales` gives the forces and energies that count as zero, `allow` the tolerances asked for.
    pub fn checks(&self, scales: &Scales, allow: &Allowances) -> Vec<Check> {
        let mut checks =
            vec![self.residual_check(), self.supports_check(), self.reactions_check(scales), self.energy_check(scales)];
        for (index, interface) in self.problem.interfaces.iter().enumerate() {
            let name = |of: OfSolutionContact| of.of(&interface.name);
            if let Some(weak) = self.holds_weakly(index) {
                checks.extend(self.weak_checks(index, weak, name));
                continue;
            }
            // Nothing bounds the jump of elastic contact, whose pressures are among the forces of springs.
            if interface.pairs.is_empty() {
                continue;
            }
            checks.push(self.penetration_check(index, &name(Penetration)));
            let [(pulling, pulled), (open, opened)] = self.complementarity(index);
            let forces = self.of_forces();
            checks.push(self.claimed(
                &name(Pulling),
                pulling,
                forces,
                format!("Contact pushes and never pulls: the sum of the nodal forces that pull{pulled}, relative to all forces."),
            ));
            checks.push(self.claimed(
                &name(PressureWhereOpen),
                open,
                forces,
                format!("Contact carries a force only where it is closed: the sum of the nodal forces at open nodes{opened}, relative to all forces."),
            ));
            checks.extend(self.friction_check(index, &name(Friction)));
        }
        allow.apply(&mut checks);
        checks
    }

    fn residual_check(&self) -> Check {
        let worst: Vec<String> = self.worst().into_iter().take(NAMED).map(|n| self.force_at(n)).collect();
        let residual = self.residual();
        // Forces elsewhere say nothing of a piece that stands apart.
        if let (true, Some(piece)) = (residual <= self.allowed(), self.apart()) {
            let what = format!(
                "The stresses of a discrete solution balance the loads on every basis function of degree {}: what is left of the nodal forces \
                 of {}, which nothing connects with the rest, relative to its own.",
                self.candidate.degree,
                piece.bodies.join(", ")
            );
            return self.claimed(OfRun::Residual.name(), piece.residual, piece.allowance, what);
        }
        let places = match residual > self.allowed() {
            true => format!(" Most is left at {}.", worst.join("; ")),
            false => String::new(),
        };
        let digits = match self.rounding > SOLVER * self.scale {
            true => format!(
                " The displacements are kept to {:.1e} of their size, which leaves the rest of the allowance.",
                self.candidate.precision
            ),
            false => String::new(),
        };
        let rule =
            self.points.map_or(String::new(), |n| format!(", integrated with {n} × {n} points in each quadrilateral"));
        let what = format!(
            "The stresses of a discrete solution balance the loads on every basis function of degree {}{rule}, together with forces of \
             supports and along contacts: what is left of the nodal forces, relative to all of them.{places}{digits}",
            self.candidate.degree
        );
        self.claimed(OfRun::Residual.name(), residual, self.of_forces(), what)
    }

    fn force_at(&self, node: usize) -> String {
        let [x, y] = self.rest[node];
        format!("{} (force ({x:.3e}, {y:.3e}))", self.named(node))
    }

    fn supports_check(&self) -> Check {
        let off = |node: usize| {
            let u = self.candidate.value(node);
            let there = self.hold(node).impose(u);
            (u[0] - there[0]).hypot(u[1] - there[1])
        };
        let worst = (0..self.rest.len()).max_by(|a, b| off(*a).total_cmp(&off(*b)));
        let depth = worst.map_or(0.0, off);
        let place = worst.filter(|_| depth > 0.0).map_or(String::new(), |n| format!(", most at {}", self.named(n)));
        self.claimed(
            OfRun::Supports.name(),
            self.relative(depth),
            self.of_displacements(1.0),
            format!(
                "The field has the displacement that supports prescribe{place}, relative to the largest displacement."
            ),
        )
    }

    /// `length` relative to the largest displacement, or to the largest that the problem allows if the field is larger.
    pub(super) fn relative(&self, length: f64) -> f64 {
        if self.reference > 0.0 { length / self.reference } else { length }
    }

    fn reactions_check(&self, scales: &Scales) -> Check {
        let (label, count) = self.bodies().labels();
        // What the balance of a body misses: supports, contacts and loads, which leave the residual.
        let (mut sum, mut size, mut rounded) = (vec![[0.0; 2]; count], vec![0.0; count], vec![0.0; count]);
        for (node, rest) in self.rest.iter().enumerate() {
            let part = label[node];
            (0..2).for_each(|c| sum[part][c] += rest[c]);
            let forces = [self.forces.load[node], self.forces.left[node], self.forces.sprung[node]];
            size[part] += forces.iter().map(|f| f[0].hypot(f[1])).sum::<f64>();
            // Stresses of a cell are in equilibrium whatever its displacements are rounded to.
            rounded[part] += self.candidate.precision * self.forces.sprung_size[node];
        }
        let missing = |part: usize| sum[part][0].hypot(sum[part][1]);
        // What is all but none beside the forces of the scene is held against these.
        let least = scales.round_off.force.max(NO_FORCE * self.applied());
        let against = |part: usize| size[part].max(least);
        let relative = |part: usize| if against(part) > 0.0 { missing(part) / against(part) } else { 0.0 };
        // Forces of closed coefficients alone leave less than those taken at nodes where the direction of contact turns.
        let is_pushed = self.pushed_among(&label, count);
        let worst = (0..count).filter(|part| !is_pushed[*part]);
        let worst = worst.max_by(|a, b| relative(*a).total_cmp(&relative(*b)));
        let value = worst.map_or(self.residual(), relative);
        let force = worst.map_or(String::new(), |p| format!(" ({:.3e}, {:.3e}) is missing.", sum[p][0], sum[p][1]));
        let mut allowance = self.of_forces();
        if let Some(part) = worst.filter(|part| against(*part) > 0.0) {
            allowance.digits = allowance.digits.max(rounded[part] / against(part));
        }
        self.claimed(
            OfRun::SolutionReactions.name(),
            value,
            allowance,
            format!(
                "Forces of supports and contacts, from the stresses of the field, are in equilibrium with the loads on every body.{force}"
            ),
        )
    }

    fn energy_check(&self, scales: &Scales) -> Check {
        let dot = |a: [f64; 2], b: [f64; 2]| a[0] * b[0] + a[1] * b[1];
        let nodes = 0..self.rest.len();
        let work: f64 = nodes.clone().map(|n| dot(self.forces.load[n], self.candidate.value(n))).sum();
        let prescribed = |n: usize| match self.hold(n) {
            Hold::Free => [0.0; 2],
            Hold::Line { normal, value } => normal.map(|x| value * x),
            Hold::Fixed(value) => value,
        };
        let held: f64 = nodes.map(|n| dot(self.supported(n), prescribed(n))).sum();
        // What contacts do on prescribed displacements is theirs, and not that of supports.
        let sites = self.sites.list.iter().zip(self.pressing.iter().zip(&self.rubbing));
        let of_contacts = |(site, (pressing, rubbing)): (&Site, (&f64, &f64))| {
            rubbing * site.slip(prescribed) - pressing * (site.excess(prescribed) + site.gap)
        };
        let supports = held - sites.map(of_contacts).sum::<f64>();
        let gaps = self.work_on_gaps() - self.work_across();
        let beside: f64 = self.beside.iter().enumerate().map(|(n, f)| dot(*f, self.candidate.value(n))).sum();
        let rubbed: f64 = self.rubbing.iter().zip(&self.slip).map(|(force, slip)| force * slip).sum();
        let (left, right) = (2.0 * self.strain, work + supports - gaps + beside + rubbed);
        let scale = left.abs().max(work.abs()).max(scales.round_off.energy);
        self.with_digits(self.of_forces(), |part| {
            Check::equal(
                OfRun::EnergyIdentity.name(),
                left,
                right,
                scale * part + self.of_the_rule + scales.round_off.energy,
                Basis::Claimed,
                match self.problem.has_friction() {
                    false => {
                        "The work that stresses of a discrete solution do on its displacement is that of loads, of supports on what they \
                         prescribe and of contacts on their gaps: a(u, u) = L(u) + ∫T·u0 + ∫T_n g."
                    }
                    true => {
                        "The work that stresses of a discrete solution do on its displacement is that of loads, of supports on what they \
                         prescribe, of contacts on their gaps and of friction on what slides: a(u, u) = L(u) + ∫T·u0 + ∫T_n g − ∫τ̄|j_t|."
                    }
                },
            )
        })
    }

    /// Work that contact takes from the sides on the way to where it is closed: Σ force · distance. Where a force acts although the sides
    /// are apart, that is the gap and not what the sides have moved. What contact does on a penetration has a check of its own.
    fn work_on_gaps(&self) -> f64 {
        let weak: Vec<bool> = (0..self.problem.interfaces.len()).map(|i| self.holds_weakly(i).is_some()).collect();
        let strong = |site: usize| !weak[self.sites.list[site].interface];
        let each = self.sites.list.iter().zip(self.pressing.iter().zip(&self.excess));
        let closed: f64 = each.map(|(site, (force, excess))| force * (site.gap + excess)).sum();
        let apart = |forces: &[f64], distances: &[f64]| {
            let own = (0..forces.len()).filter(|s| strong(*s) && distances[*s] < 0.0 && !self.is_support(*s));
            own.map(|s| forces[s] * distances[s]).sum::<f64>()
        };
        let at_nodes = apart(&self.pressing, &self.excess);
        let (forces, distances) = self.sites.in_coefficients(&self.pressing, &self.excess);
        let in_coefficients = apart(&forces, &distances);
        let least = if at_nodes.abs() <= in_coefficients.abs() { at_nodes } else { in_coefficients };
        // Forces that push at closed coefficients alone do no work on a distance, whichever places share them here.
        let apart = if self.is_pushed() { 0.0 } else { least };
        closed - apart + self.on_gaps
    }

    /// Work of the contact forces across the normal of a place, which they have where the direction of contact turns.
    fn work_across(&self) -> f64 {
        if self.problem.pairs().all(|pair| pair.direction.is_constant()) {
            return 0.0;
        }
        // Forces that push at closed coefficients alone are all of them.
        let part = if self.is_pushed() { 0.0 } else { 1.0 };
        let beside = |n: usize| self.beside.get(n).copied().unwrap_or_default();
        let taken = |n: usize| [0, 1].map(|c| self.unsupported[n][c] - part * self.rest[n][c] - beside(n)[c]);
        let forces: Vec<[f64; 2]> = (0..self.rest.len()).map(taken).collect();
        let free = |n: usize| self.hold(n).project(self.candidate.value(n));
        self.sites.across(&forces, (&self.pressing, &self.rubbing), free)
    }

    /// True where supports take what contact does at a place.
    fn is_support(&self, site: usize) -> bool {
        self.pressing[site] == 0.0 && self.sites.is_held(site)
    }

    /// Checks of contact `interface` in the mean, with a remark on its nodes.
    fn weak_checks(&self, interface: usize, weak: &Weak, name: impl Fn(OfSolutionContact) -> String) -> Vec<Check> {
        let total = self.applied().max(self.carried(interface));
        let share = |force: f64| if total > 0.0 { force / total } else { force };
        let law = weak.in_words();
        let part = self.weak_part(interface);
        let depth = self.deepest(interface).map_or(0.0, |site| self.excess[site].max(0.0));
        let mut nodes = self.penetration_check(interface, &name(PenetrationAtNodes));
        nodes.basis = Basis::Chosen;
        nodes.why = format!(
            "Contact holds {law}. At the nodes the sides overlap by up to {depth:.3e}, which is no mistake of such a method; the bounds of \
             this report are those of the field made admissible."
        );
        vec![
            self.claimed(
                &name(Penetration),
                self.relative(weak.penetration),
                self.of_displacements(2.0),
                format!("Contact holds {law}: the largest of these means of the penetration, relative to the largest displacement."),
            ),
            Check::at_most(
                &name(Pulling),
                share(weak.pulling),
                0.0,
                part,
                Basis::Claimed,
                "Contact pushes and never pulls: the sum of the forces of its law that pull, relative to all forces.",
            ),
            Check::at_most(
                &name(PressureWhereOpen),
                weak.misfit,
                0.0,
                part,
                Basis::Claimed,
                format!("Contact holds {law}: what of the contact forces does not follow this law, relative to all of this contact."),
            ),
            nodes,
        ]
    }

    fn penetration_check(&self, interface: usize, name: &str) -> Check {
        let deepest = self.deepest(interface);
        let depth = deepest.map_or(0.0, |site| self.excess[site].max(0.0));
        let place = deepest.filter(|_| depth > 0.0).map_or(String::new(), |site| {
            format!(" It is deepest, {depth:.3e}, at {}.", self.named(self.sites.list[site].first))
        });
        self.claimed(
            name,
            self.relative(depth),
            self.of_displacements(2.0),
            format!("No node penetrates, relative to the largest displacement.{place}"),
        )
    }

    /// The site of contact `interface` that penetrates most.
    pub fn deepest(&self, interface: usize) -> Option<usize> {
        let own = (0..self.excess.len()).filter(|s| self.sites.list[*s].interface == interface);
        own.max_by(|a, b| self.excess[*a].total_cmp(&self.excess[*b]))
    }

    /// Pulling and pushing where open, each with its place, relative to the forces of the scene.
    fn complementarity(&self, interface: usize) -> [(f64, String); 2] {
        if self.is_pushed() {
            return [(0.0, String::new()), (0.0, String::new())];
        }
        let total = self.applied().max(self.larger * self.carried(interface));
        let share = |force: f64| if total > 0.0 { force / total } else { force };
        let open = -self.sticks_below();
        let (mut forces, distances) = self.sites.in_coefficients(&self.pressing, &self.excess);
        let own = || (0..self.pressing.len()).filter(|s| self.sites.list[*s].interface == interface);
        own().filter(|s| self.is_support(*s)).for_each(|s| forces[s] = 0.0);
        let sum = |force: &dyn Fn(usize) -> f64| {
            let worst = own().max_by(|a, b| force(*a).total_cmp(&force(*b))).filter(|s| force(*s) > 0.0);
            let place = worst.map_or(String::new(), |s| format!(" (most at {})", self.named(self.sites.list[s].first)));
            (share(own().map(force).sum()), place)
        };
        let pulling = sum(&|s| (-forces[s]).max(0.0));
        let pushed = |force: f64, distance: f64| if distance < open { force.max(0.0) } else { 0.0 };
        let at_nodes = sum(&|s| pushed(self.pressing[s], self.excess[s]));
        let in_coefficients = sum(&|s| pushed(forces[s], distances[s]));
        [pulling, if at_nodes.0 <= in_coefficients.0 { at_nodes } else { in_coefficients }]
    }

    /// A check of `value` ≤ `allowance`.
    pub(super) fn claimed(&self, name: &str, value: f64, allowance: Allowance, why: String) -> Check {
        let made = |allowed| Check::at_most(name, value, 0.0, allowed, Basis::Claimed, why.as_str());
        self.with_digits(allowance, made)
    }
}
