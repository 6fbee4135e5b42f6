//! Coulomb friction in the balance of rigid pieces: forces of contact within their cones.
//!
//! Along a straight run the tangential force is at most μ times the normal one, so that with the rows g of the jump and h of the slip at
//! its two ends the forces of contact are the sums Σ c (g ± μ h), c ≥ 0. Loads outside that cone have no equilibrium, whatever happens
//! inside the pieces. Where the cone contains a line that the rows g alone do not have, forces of contact balance each other without a
//! load: the piece is wedged, and the loads do not say how much it presses.

use nalgebra::DVector;

use super::balance::RANK;
use super::cone::span::Span;
use super::friction::{PUSHES, held_to, nearest};
use super::restraint::{Group, Run, clamped, groups, runs};
use super::{Components, LoadResultants, words};
use crate::optimise::Law;
use crate::problem::Problem;

/// Largest remainder of a force, relative to it, that counts as balanced by others.
const BALANCED: f64 = 1e-7;
/// Groups with more ends of contact are not looked into.
const MOST_ENDS: usize = 60;

/// Pieces whose contacts can hold each other by friction without any load.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Wedged {
    /// The bodies, in words.
    pub bodies: String,
    /// The names of these contacts.
    pub contacts: Vec<String>,
}

/// A force of contact that pushes, or one of friction with a given bound.
struct Force {
    row: DVector<f64>,
    law: Law,
    interface: usize,
    /// False for a radial pressure on a body of revolution, which moves no piece: hoop stresses say how large it is.
    pushes: bool,
}

/// True if contact forces within their cones balance the loads on every piece; also where this was not examined.
pub fn friction_can_balance(problem: &Problem) -> bool {
    let components = Components::new(problem);
    let loads = LoadResultants::new(problem, &components);
    let runs = runs(problem, &components, &|_| 1);
    groups(&components, &clamped(problem, &components), &runs).iter().all(|group| {
        let supports = group.span(&group.rollers(problem));
        let forces = forces(problem, group, &supports, |interface| problem.coefficient(interface).unwrap_or(0.0));
        let load = supports.residual(&group.load(&loads));
        let allowed = BALANCED * group.magnitude(&loads);
        forces.len() > 4 * MOST_ENDS || balancing(&forces, &load).is_none_or(|(left, _)| left <= allowed)
    })
}

/// The pieces that friction can wedge.
pub fn wedged(problem: &Problem) -> Vec<Wedged> {
    let components = Components::new(problem);
    let runs = runs(problem, &components, &|_| 1);
    let all = groups(&components, &clamped(problem, &components), &runs);
    all.iter().filter_map(|group| wedged_in(problem, group)).collect()
}

fn wedged_in(problem: &Problem, group: &Group) -> Option<Wedged> {
    let rubs = |run: &Run| problem.coefficient(run.interface).is_some();
    if 2 * group.runs.len() > MOST_ENDS || !group.runs.iter().any(|run| rubs(run)) {
        return None;
    }
    let supports = group.span(&group.rollers(problem));
    let with = |friction: bool| {
        let coefficient = |interface| if friction { problem.coefficient(interface).unwrap_or(0.0) } else { 0.0 };
        let mut forces = forces(problem, group, &supports, coefficient);
        // Friction with a given bound takes a part alone.
        forces.retain(|force| force.law == PUSHES && force.pushes && force.row.norm() > RANK);
        balanced_without_load(&mut forces)
    };
    if with(false).is_some() {
        return None;
    }
    let mut contacts: Vec<String> = Vec::new();
    for interface in with(true)? {
        let name = problem.interfaces[interface].name.clone();
        if !contacts.contains(&name) {
            contacts.push(name);
        }
    }
    Some(Wedged { bodies: words::all_names(group), contacts })
}

/// The contacts whose forces balance that of one of them; none where no forces do.
fn balanced_without_load(forces: &mut Vec<Force>) -> Option<Vec<usize>> {
    for i in 0..forces.len() {
        let own = forces.remove(i);
        let found = balancing(forces, &-own.row.normalize());
        let together = found.filter(|(left, _)| *left <= BALANCED).map(|(_, sizes)| {
            let others = forces.iter().zip(sizes).filter(|(_, size)| *size > BALANCED);
            std::iter::once(own.interface).chain(others.map(|(force, _)| force.interface)).collect()
        });
        forces.insert(i, own);
        if together.is_some() {
            return together;
        }
    }
    None
}

/// The forces of contact on a group beside those of its supports, with a coefficient of friction for each contact.
fn forces(problem: &Problem, group: &Group, supports: &Span, coefficient: impl Fn(usize) -> f64) -> Vec<Force> {
    let mut all = Vec::new();
    for run in &group.runs {
        let mu = coefficient(run.interface);
        for end in run.ends {
            let normal = group.dense(&group.across(run, end));
            let slip = group.dense(&group.slip(run, end)) * mu;
            let rows = if mu > 0.0 { vec![&normal + &slip, &normal - &slip] } else { vec![normal.clone()] };
            let pushes = !problem.section().is_revolved() || supports.residual(&normal).norm() > RANK;
            let push = |row| Force { row: supports.residual(&row), law: PUSHES, interface: run.interface, pushes };
            all.extend(rows.into_iter().map(push));
        }
        if run.friction > 0.0 && problem.coefficient(run.interface).is_none() {
            let row = supports.residual(&group.dense(&group.slip(run, run.ends[0])));
            all.push(Force { row, law: held_to(run.friction), interface: run.interface, pushes: false });
        }
    }
    all
}

/// The least that forces leave of a load, and their sizes then; none where it was not found.
fn balancing(forces: &[Force], load: &DVector<f64>) -> Option<(f64, Vec<f64>)> {
    if forces.is_empty() {
        return Some((load.norm(), Vec::new()));
    }
    let (rows, laws): (Vec<_>, Vec<_>) = forces.iter().map(|force| (force.row.clone(), force.law)).unzip();
    let sizes = nearest(&rows, &laws, load)?;
    let left = rows.iter().zip(&sizes).fold(load.clone(), |left, (row, size)| left - row * *size);
    Some((left.norm(), sizes))
}
