//! Multipliers along a contact: ∫ψ(j − g) ≤ 0 for each shape function ψ of theirs, and forces ∫λφ with a λ ≥ 0 of them.
//!
//! An augmented Lagrangian that is evaluated at quadrature points, ∫(λ − [λ + r(j − g)]₊)ψ = 0, imposes the same on every ψ whose
//! support is closed; where contact ends inside an edge it depends on the rule, and nothing is required there.

use std::collections::BTreeMap;

use super::super::Solution;
use super::least::Rows;
use super::stations::{Shape, Station};
use super::{Law, Limits, Weak};

/// Exact for a quadratic jump and a quadratic multiplier, and for a parabola.
const DEGREE: usize = 6;
/// Work that contact may do on penetrations where it ends inside an edge, relative to the strain energy: three per cent of the stresses.
const AT_ENDS: f64 = 1e-3;

/// A mean of penetrations that is smaller than this part of the largest of them is zero.
const ZERO: f64 = 1e-3;
/// Edges whose conditions all have to be met for any to be passed over at ends of contact.
const LEAST: usize = 2;

/// The space of the multiplier.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Multiplier {
    /// Constant on every edge.
    Edges,
    /// Linear on every edge, continuous.
    Hats,
    /// Quadratic on every edge, continuous.
    Quadratic,
    /// Biorthogonal to the linear shape functions of the displacement.
    Dual,
}

impl Multiplier {
    /// The multipliers used with displacements of a degree.
    pub fn of_degree(degree: usize) -> &'static [Multiplier] {
        match degree {
            1 => &[Multiplier::Hats, Multiplier::Edges, Multiplier::Dual],
            _ => &[Multiplier::Quadratic, Multiplier::Hats, Multiplier::Edges],
        }
    }

    /// Values at a station, each with the number of its shape function.
    fn values(self, station: &Station) -> Vec<(usize, f64)> {
        let ends = |of: fn(f64, f64) -> f64| {
            let s = station.at;
            let (first, last) = (station.sites[0].0, station.sites[1].0);
            vec![(first, of(1.0 - s, s)), (last, of(s, 1.0 - s))]
        };
        match self {
            Multiplier::Edges => vec![(station.edge, 1.0)],
            Multiplier::Hats => ends(|own, _| own),
            Multiplier::Dual => ends(|own, other| 2.0 * own - other),
            Multiplier::Quadratic => station.sites.clone(),
        }
    }
}

/// The conditions that multipliers impose, with the forces that they can exert.
struct Conditions {
    /// ∫ψ(j − g)/∫|ψ| for every ψ.
    means: Vec<f64>,
    /// ∫|ψ|.
    sizes: Vec<f64>,
    /// ∫ψφ for every φ of the jump, by place.
    forces: BTreeMap<usize, Vec<(usize, f64)>>,
    /// The ψ and the places of every edge.
    edges: BTreeMap<usize, [Vec<usize>; 2]>,
    /// ∫(j − g)φ of every edge by place.
    jumps: BTreeMap<usize, Vec<(usize, f64)>>,
}

impl Conditions {
    fn new(stations: &[Station], multiplier: Multiplier) -> Self {
        let mut known: BTreeMap<usize, usize> = BTreeMap::new();
        let mut new = Conditions {
            means: Vec::new(),
            sizes: Vec::new(),
            forces: BTreeMap::new(),
            edges: BTreeMap::new(),
            jumps: BTreeMap::new(),
        };
        for station in stations {
            let [functions, places] = new.edges.entry(station.edge).or_default();
            for (key, value) in multiplier.values(station) {
                let next = known.len();
                let i = *known.entry(key).or_insert(next);
                if i == next {
                    new.means.push(0.0);
                    new.sizes.push(0.0);
                }
                if !functions.contains(&i) {
                    functions.push(i);
                }
                new.means[i] += station.weight * value * station.excess;
                new.sizes[i] += station.weight * value.abs();
                for (site, shape) in &station.sites {
                    add(new.forces.entry(*site).or_default(), i, station.weight * value * shape);
                }
            }
            for (site, shape) in &station.sites {
                if !places.contains(site) {
                    places.push(*site);
                }
                let part = station.weight * station.excess * shape;
                add(new.jumps.entry(station.edge).or_default(), *site, part);
            }
        }
        new.means.iter_mut().zip(&new.sizes).for_each(|(mean, size)| *mean /= size);
        new
    }
}

fn add(row: &mut Vec<(usize, f64)>, column: usize, value: f64) {
    match row.iter_mut().find(|(c, _)| *c == column) {
        Some((_, known)) => *known += value,
        None => row.push((column, value)),
    }
}

/// A multiplier whose conditions the field meets.
pub fn mortar(solution: &Solution<'_>, interface: usize, limits: &Limits, shape: Shape) -> Option<Weak> {
    let stations = solution.stations(interface, DEGREE, shape);
    let all = Multiplier::of_degree(solution.candidate.degree).iter();
    all.copied().find_map(|multiplier| exact(solution, &Conditions::new(&stations, multiplier), multiplier, limits))
}

/// A continuous multiplier whose conditions the field meets wherever contact is closed around a shape function.
pub fn augmented(solution: &Solution<'_>, interface: usize, limits: &Limits, shape: Shape) -> Option<Weak> {
    let stations = solution.stations(interface, DEGREE, shape);
    let mut all = Multiplier::of_degree(solution.candidate.degree).iter().filter(|m| **m != Multiplier::Edges);
    all.find_map(|multiplier| inside(solution, &Conditions::new(&stations, *multiplier), *multiplier, limits))
}

fn exact(solution: &Solution<'_>, conditions: &Conditions, multiplier: Multiplier, limits: &Limits) -> Option<Weak> {
    let penetration = conditions.means.iter().copied().fold(0.0, f64::max);
    if penetration > limits.length {
        return None;
    }
    let closed = |i: usize| conditions.means[i] >= -limits.length;
    let (mut rows, mut wanted) = (Vec::new(), Vec::new());
    for (site, row) in &conditions.forces {
        if !solution.sites.is_held(*site) {
            rows.push(row.iter().copied().filter(|(i, _)| closed(*i)).collect());
            wanted.push(solution.pressing[*site]);
        }
    }
    let (multipliers, left) = Rows { rows, columns: conditions.means.len() }.least_squares(&wanted);
    let size = wanted.iter().map(|f| f * f).sum::<f64>().sqrt();
    let pulling: f64 = match multiplier {
        // The forces of neighbours alternate, and what supports hold hides one of them.
        Multiplier::Edges => wanted.iter().map(|f| (-f).max(0.0)).sum(),
        _ => multipliers.iter().zip(&conditions.sizes).map(|(l, size)| (-l).max(0.0) * size).sum(),
    };
    (left <= limits.part * size && pulling <= limits.force).then_some(Weak {
        law: Law::Mortar(multiplier),
        penetration,
        misfit: left / size,
        pulling,
        terms: Vec::new(),
    })
}

fn inside(solution: &Solution<'_>, conditions: &Conditions, multiplier: Multiplier, limits: &Limits) -> Option<Weak> {
    // A mean is zero beside the values that it is one of.
    let carrying = conditions.forces.keys().filter(|site| solution.pressing[**site].abs() > limits.force);
    let depth = carrying.map(|site| solution.excess[*site].max(0.0)).fold(0.0, f64::max);
    let digits = 4.0 * solution.candidate.precision * solution.reference;
    let zero = limits.length.min(digits.max(ZERO * depth));
    let closed = |i: usize| conditions.means[i].abs() <= zero;
    let quiet = |site: &usize| solution.pressing[*site].abs() <= limits.force;
    let (mut of_closed, mut loose) = (vec![false; conditions.means.len()], Vec::new());
    let (mut acting, mut jump): (usize, BTreeMap<usize, f64>) = (0, BTreeMap::new());
    let mut at_ends = 0.0;
    for (edge, [functions, places]) in &conditions.edges {
        if functions.iter().all(|i| closed(*i)) {
            acting += 1;
            functions.iter().for_each(|i| of_closed[*i] = true);
            conditions.jumps[edge].iter().for_each(|(site, part)| *jump.entry(*site).or_default() += part);
        } else if !places.iter().all(quiet) {
            loose.extend(places.iter().copied());
            at_ends += places.iter().map(|s| solution.pressing[*s].abs() * solution.excess[*s].max(0.0)).sum::<f64>();
        }
    }
    if acting < LEAST || at_ends > AT_ENDS * solution.strain {
        return None;
    }
    // Such a method pushes wherever the sides overlap, and holds in the mean where nothing ends; a node that was forgotten beside
    // nodes that are closed one by one is neither.
    let forgotten = |site: &usize| solution.excess[*site] > limits.length && quiet(site);
    let between = |[functions, places]: &[Vec<usize>; 2]| {
        functions.iter().all(|i| closed(*i))
            && places.iter().any(|s| !loose.contains(s) && solution.excess[*s].abs() > limits.length)
    };
    if conditions.forces.keys().any(forgotten) || !conditions.edges.values().any(between) {
        return None;
    }
    let columns = conditions.means.len();
    let (mut rows, mut wanted) = (Vec::new(), Vec::new());
    for (site, row) in &conditions.forces {
        if solution.sites.is_held(*site) || loose.contains(site) {
            continue;
        }
        let mut row: Vec<(usize, f64)> = row.iter().copied().filter(|(i, _)| of_closed[*i]).collect();
        row.extend(jump.get(site).map(|part| (columns, part / limits.length)));
        rows.push(row);
        wanted.push(solution.pressing[*site]);
    }
    // At the ends of an edge forces of a quadratic displacement may pull under a pressure that does not.
    let (forces, _) = solution.sites.in_coefficients(&solution.pressing, &solution.excess);
    let strict = conditions.forces.keys().filter(|site| !loose.contains(site));
    let pulling: f64 = strict.map(|site| (-forces[*site]).max(0.0)).sum();
    let (_, left) = Rows { rows, columns: columns + 1 }.least_squares(&wanted);
    let size = wanted.iter().map(|f| f * f).sum::<f64>().sqrt();
    (left <= limits.part * size && pulling <= limits.force).then_some(Weak {
        law: Law::Augmented(multiplier),
        penetration: 0.0,
        misfit: left / size,
        pulling,
        terms: Vec::new(),
    })
}
