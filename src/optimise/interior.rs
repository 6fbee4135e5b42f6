//! The primal–dual interior point with predictor and corrector (Mehrotra 1992).
//!
//! Every step is one factorisation of A with the barriers on its diagonal, definite whatever motions A leaves free. Of all
//! minima it comes to one in the middle: where the solution is not unique, nothing that is loose touches anything.

use super::barrier::{Barrier, barriers};
use super::law::{Law, State};
use super::tolerance::TOLERANCES;
use super::{Program, Solution};
use crate::vector::long::{axpy, largest};

/// Steps at most; twenty to thirty are usual.
const MOST: usize = 80;
/// Steps that win nothing, neither of the equations nor of all that is asked, before it ends where it is.
const PATIENCE: usize = 3;
/// Equations that hold to this part of the mean product of room and force hold: a step that leaves more than `WORSE` of the products wins
/// nothing there …
const HELD: f64 = 1e-3;
const WORSE: f64 = 0.9;
/// … and one towards this part of it is taken in its place.
const CENTRED: f64 = 0.3;
/// Residual of the equations, relative to data of size one, at which the state may be read.
const BALANCED: f64 = 1e-9;
/// Products of room and force at which a point that comes no further still tells the state.
const NEARLY: f64 = 1e-7;

/// The minimum to about as many digits as the factor has; nothing where it does not come near one. It ends where the mean product of
/// room and force, for data of size one, is `enough`, or where it comes no further.
pub fn interior_point(program: &Program<'_>, enough: f64) -> Option<Solution> {
    // From where friction holds: y = x − c has laws without a centre, and the load b − Ac.
    let origin: Vec<f64> = program.laws.iter().map(|law| law.centre()).collect();
    let laws: Vec<Law> = program.laws.iter().map(|law| law.centred()).collect();
    let load: Vec<f64> = program.form.gradient(program.load, &origin).iter().map(|force| -force).collect();
    let size = Program { load: &load, laws: &laws, ..*program }.size();
    let n = load.len();
    let load: Vec<f64> = load.iter().map(|b| b / size).collect();
    let laws: Vec<Law> = laws.iter().map(|law| law.scaled(size)).collect();
    let mut owner = Vec::new();
    let mut all: Vec<Barrier> = Vec::new();
    for (i, law) in laws.iter().enumerate() {
        all.extend(barriers(*law));
        owner.resize(all.len(), i);
    }
    let springs: Vec<f64> =
        laws.iter().map(|law| if let Law::Spring { stiffness } = law { *stiffness } else { 0.0 }).collect();
    let nothing_held = vec![false; n];
    let mut x = vec![0.0; n];
    let count: f64 = all.iter().map(|b| b.product().1).sum::<f64>().max(1.0);
    let mean = |all: &[Barrier]| all.iter().map(|b| b.product().0).sum::<f64>() / count;
    let (mut least, mut patience, mut steps) = ([f64::INFINITY; 2], PATIENCE, 0);
    let mut left;
    loop {
        let mu = mean(&all);
        // Ax − b + Σ forces.
        let mut forces = program.form.gradient(&load, &x);
        forces.iter_mut().zip(&springs).zip(&x).for_each(|((f, k), x)| *f += k * x);
        let smooth = forces.clone();
        all.iter().zip(&owner).for_each(|(b, i)| forces[*i] += b.force());
        let misfit = all.iter().zip(&owner).fold(0.0_f64, |m, (b, i)| m.max(b.misfit(x[*i]).abs()));
        let unbalanced = largest(&forces).max(misfit / (1.0 + largest(&x)));
        left = mu.max(unbalanced);
        if !left.is_finite() {
            return None;
        }
        if mu <= enough && left <= BALANCED || all.is_empty() && left <= TOLERANCES.identified {
            break;
        }
        // On the way to values that are large beside the data, products grow while the equations come near.
        let now = [left, unbalanced];
        let gains = (0..2).any(|i| now[i] < 0.9 * least[i]);
        patience = if gains { PATIENCE } else { patience - 1 };
        least = [0, 1].map(|i| least[i].min(now[i]));
        if steps == MOST || patience == 0 {
            break;
        }
        steps += 1;
        let mut added = springs.clone();
        all.iter().zip(&owner).for_each(|(b, i)| added[*i] += b.stiffness());
        let factor = TOLERANCES.regular.into_iter().find_map(|part| {
            let added: Vec<f64> = added.iter().enumerate().map(|(i, a)| a + part * program.form.diagonal(i)).collect();
            program.form.factor(&added, &nothing_held)
        });
        let Some(factor) = factor else { break };
        let toward = |all: &mut [Barrier], target: f64, second_order: bool| -> (Vec<f64>, f64) {
            let mut b: Vec<f64> = smooth.iter().map(|g| -g).collect();
            all.iter().zip(&owner).for_each(|(bar, i)| b[*i] -= bar.offset(x[*i], target, second_order));
            let dx = factor.solve(&b);
            all.iter_mut().zip(&owner).for_each(|(bar, i)| bar.direct(x[*i], dx[*i], target, second_order));
            let reach = all.iter().fold(1.0_f64, |m, bar| m.min(bar.reach()));
            (dx, reach)
        };
        let (_, reach) = toward(&mut all, 0.0, false);
        let after = all.iter().map(|b| b.product_after(reach)).sum::<f64>() / count;
        let target = mu * (after / mu).powi(3).min(1.0);
        let (mut dx, mut reach) = toward(&mut all, target, true);
        let product = all.iter().map(|b| b.product_after(reach)).sum::<f64>() / count;
        if unbalanced <= HELD * mu && product > WORSE * mu {
            // The products of a long step can lead in circles; a step towards the centre without them does not.
            (dx, reach) = toward(&mut all, CENTRED * mu, false);
        }
        axpy(&mut x, reach, &dx);
        all.iter_mut().for_each(|b| b.advance(reach));
    }
    if left > NEARLY {
        return None;
    }
    let mut states: Vec<State> = laws.iter().map(|law| law.slack_state()).collect();
    for (b, i) in all.iter().zip(&owner) {
        let state = b.state(laws[*i]);
        // Of two faces at most one is held.
        if state != State::Between {
            states[*i] = state;
        }
    }
    let x = x.into_iter().zip(origin).map(|(x, from)| from + x * size).collect();
    Some(Solution { x, states, steps, settled: false })
}

impl Law {
    /// The state in which nothing holds the unknown.
    fn slack_state(self) -> State {
        match self {
            Law::Between { .. } => State::Between,
            _ => State::Below,
        }
    }

    /// Where friction holds; zero for every other law.
    fn centre(self) -> f64 {
        if let Law::Friction { centre, .. } = self { centre } else { 0.0 }
    }

    /// The law of the distance from [`Law::centre`].
    fn centred(self) -> Self {
        match self {
            Law::Friction { threshold, .. } => Law::Friction { threshold, centre: 0.0 },
            _ => self,
        }
    }

    /// The law of x / `size`, when forces are divided by `size` too.
    fn scaled(self, size: f64) -> Self {
        match self {
            Law::AtMost { bound } => Law::AtMost { bound: bound / size },
            Law::Between { lower, upper } => Law::Between { lower: lower / size, upper: upper / size },
            Law::Elastic { gap, stiffness } => Law::Elastic { gap: gap / size, stiffness },
            Law::Friction { threshold, centre } => Law::Friction { threshold: threshold / size, centre: centre / size },
            Law::Free | Law::Spring { .. } => self,
        }
    }
}

impl Program<'_> {
    /// The size of the data: of the loads, and of what overlaps at x = 0.
    fn size(&self) -> f64 {
        let overlap = |law: &Law| match *law {
            Law::AtMost { bound } => (-bound).max(0.0),
            Law::Between { lower, upper } => (-upper).max(lower).max(0.0),
            Law::Elastic { gap, stiffness } => (-gap).max(0.0) * stiffness.min(1.0),
            _ => 0.0,
        };
        let size = self.laws.iter().map(overlap).fold(largest(self.load), f64::max);
        if size > 0.0 { size } else { 1.0 }
    }
}
