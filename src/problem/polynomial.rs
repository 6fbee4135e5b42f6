//! Tractions of higher degree than one: on every edge the nearest affine traction replaces them, and the remainder is known.
//!
//! The remainder on an edge is orthogonal to all affine functions on it, so it has neither a resultant nor a moment, and a stress on
//! the one adjacent triangle balances it. The energy of that stress is part of the bracket ([`crate::bounds`]).
//!
//! On a body of revolution tractions are weighted with the distance r from the axis: r times the remainder is orthogonal to all affine
//! functions.

use std::borrow::Cow;
use std::collections::HashMap;

use super::build::section;
use super::{EdgeWeight, Note, Problem};
use crate::element::polynomial::side;
use crate::mesh::Triangulation;
use crate::scene::{Load, Scene, Term, Traction};

/// The remainder of a traction of the scene after its affine part on an edge is subtracted.
#[derive(Debug, Clone, PartialEq)]
pub struct Oscillation {
    /// The edge.
    pub edge: usize,
    /// Bernstein coefficients of the rest times the weight of the section, from the first vertex of the edge to its second.
    pub rest: Vec<[f64; 2]>,
    /// The largest coefficient of the traction that it was taken from: what rounding in it is relative to.
    pub size: f64,
}

/// What the nodal forces of a displacement have of polynomial tractions.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Counted {
    /// The nearest affine traction on every edge: the loads that both models of this program have.
    #[default]
    Nearest,
    /// The polynomial, which other programs are given.
    Whole,
}

impl Problem {
    /// This problem for a displacement of another program, whose loads are the polynomials.
    pub fn with_whole_tractions(&self) -> Cow<'_, Problem> {
        match self.has_polynomial_tractions() {
            true => Cow::Owned(Problem { counted: Counted::Whole, ..self.clone() }),
            false => Cow::Borrowed(self),
        }
    }

    /// Bernstein coefficients of a function on edge `e` times the weight of the section.
    pub fn times_weight(&self, e: usize, f: &[[f64; 2]]) -> Vec<[f64; 2]> {
        times(&EdgeWeight::on(self.section(), &self.mesh, e), f)
    }

    /// Bernstein coefficients of the traction on every edge that has one, from its first vertex to its second, as nodal forces count it.
    pub fn pressed_edges(&self) -> Vec<(usize, Vec<[f64; 2]>)> {
        let has_more = |traction: &&Traction| self.counted == Counted::Whole && !traction.terms.is_empty();
        let polynomials = self.scene.tractions.iter().filter(has_more);
        let mut whole: HashMap<usize, _> = polynomials
            .flat_map(|traction| self.mesh.boundary(&traction.on).into_iter().map(move |e| (e, traction)))
            .map(|(e, traction)| (e, whole(&self.scene, &self.mesh, e, traction)))
            .collect();
        self.tractions().map(|(e, ends)| (e, whole.remove(&e).unwrap_or_else(|| ends.to_vec()))).collect()
    }

    /// True if a traction of the scene is of higher degree than one.
    pub fn has_polynomial_tractions(&self) -> bool {
        self.scene.tractions.iter().any(|traction| !traction.terms.is_empty())
    }

    /// Remainders of the tractions on the edges of this mesh.
    pub fn oscillations(&self) -> Vec<Oscillation> {
        let of = |traction: &Traction| -> Vec<Oscillation> {
            let edges = self.mesh.boundary(&traction.on).into_iter();
            edges
                .map(|edge| {
                    let whole = along(&self.scene, &self.mesh, edge, &traction.terms);
                    let weight = EdgeWeight::on(self.section(), &self.mesh, edge);
                    let nearest = nearest(&whole, &weight);
                    let less = nearest.map(|end| end.map(|p| -p));
                    let size = whole.iter().flatten().fold(0.0_f64, |m, p| m.max(p.abs())) * weight.largest();
                    Oscillation { edge, rest: times(&weight, &plus(whole, less)), size }
                })
                .collect()
        };
        self.scene.tractions.iter().filter(|traction| !traction.terms.is_empty()).flat_map(of).collect()
    }
}

/// P at the ends of edge `e`: of the affine traction that is nearest to the one that is given.
pub(super) fn ends(scene: &Scene, mesh: &Triangulation, e: usize, traction: &Traction) -> [[f64; 2]; 2] {
    let own = affine(mesh, e, traction);
    if traction.terms.is_empty() {
        return own;
    }
    let more = nearest(&along(scene, mesh, e, &traction.terms), &EdgeWeight::on(section(scene), mesh, e));
    [0, 1].map(|end| [0, 1].map(|c| own[end][c] + more[end][c]))
}

/// The affine part of a traction at the ends of edge `e`.
fn affine(mesh: &Triangulation, e: usize, traction: &Traction) -> [[f64; 2]; 2] {
    match traction.load {
        Load::Pressure(p) => {
            let (_, normal) = mesh.edge_frame(e);
            [normal.map(|n| 0.0 - p * n); 2]
        }
        Load::Affine(load) => mesh.edges[e].vertices.map(|v| load.at(mesh.points[v])),
    }
}

/// Bernstein coefficients of a traction along edge `e`.
fn whole(scene: &Scene, mesh: &Triangulation, e: usize, traction: &Traction) -> Vec<[f64; 2]> {
    plus(along(scene, mesh, e, &traction.terms), affine(mesh, e, traction))
}

/// The sum of a polynomial and the affine function with values `ends` at the ends.
fn plus(mut f: Vec<[f64; 2]>, [a, b]: [[f64; 2]; 2]) -> Vec<[f64; 2]> {
    for c in 0..2 {
        let linear = side::linear([a[c], b[c]], f.len() - 1);
        f.iter_mut().zip(linear).for_each(|(sum, linear)| sum[c] += linear);
    }
    f
}

/// Coefficients of a function times the weight.
fn times(weight: &EdgeWeight, f: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let [x, y] = [0, 1].map(|c| weight.times(&side::component(f, c)));
    x.into_iter().zip(y).map(|(x, y)| [x, y]).collect()
}

/// Bernstein coefficients of terms along edge `e`.
fn along(scene: &Scene, mesh: &Triangulation, e: usize, terms: &[Term]) -> Vec<[f64; 2]> {
    let ends = mesh.edges[e].vertices.map(|v| [0, 1].map(|c| mesh.points[v][c] + scene.origin[c]));
    let degree = terms.iter().map(Term::degree).max().unwrap_or(1);
    let mut out = vec![[0.0; 2]; degree + 1];
    for term in terms {
        let mut power = vec![1.0];
        for (c, times) in term.powers.into_iter().enumerate() {
            (0..times).for_each(|_| power = product(&power, &[ends[0][c], ends[1][c]]));
        }
        for (sum, own) in out.iter_mut().zip(side::elevate(&power, degree)) {
            (0..2).for_each(|c| sum[c] += own * term.value[c]);
        }
    }
    out
}

/// The product of two polynomials by their coefficients.
fn product(f: &[f64], g: &[f64]) -> Vec<f64> {
    let (p, q) = (f.len() - 1, g.len() - 1);
    let mut out = vec![0.0; p + q + 1];
    for (i, f) in f.iter().enumerate() {
        for (j, g) in g.iter().enumerate() {
            out[i + j] += side::binomial(p, i) * side::binomial(q, j) / side::binomial(p + q, i + j) * f * g;
        }
    }
    out
}

/// The ends of the affine function that is nearest in the weighted mean square.
fn nearest(whole: &[[f64; 2]], weight: &EdgeWeight) -> [[f64; 2]; 2] {
    let along = |c: usize| weight.linear(&weight.times(&side::component(whole, c)));
    let [x, y] = [along(0), along(1)];
    [[x[0], y[0]], [x[1], y[1]]]
}

/// How remarks on polynomials begin.
const REMARK: &str = "The polynomial traction on '";

/// True if a note is one of [`remarks`], of this mesh or a coarser one.
pub(super) fn is_remark(note: &Note) -> bool {
    note.text.starts_with(REMARK)
}

/// Says of every polynomial traction how much of it the mesh does not hold.
pub(super) fn remarks(problem: &Problem) -> Vec<Note> {
    let all = problem.oscillations();
    let of = |traction: &Traction| {
        let name = problem.mesh.boundary(&traction.on);
        let size = |p: &[[f64; 2]]| {
            let square = |c: usize| {
                let own = side::component(p, c);
                side::integral(&own, &own)
            };
            square(0) + square(1)
        };
        let (mut left, mut whole) = (0.0, 0.0);
        for Oscillation { edge, rest, .. } in all.iter().filter(|rest| name.contains(&rest.edge)) {
            let length = problem.mesh.edge_frame(*edge).0;
            left += length * size(rest);
            let ends = ends(&problem.scene, &problem.mesh, *edge, traction);
            whole += length * size(&problem.weighted(*edge, ends));
        }
        let part = 100.0 * (left / (left + whole)).sqrt();
        let degree = traction.terms.iter().map(Term::degree).max().unwrap_or(1);
        let text = format!(
            "{REMARK}{}' is of degree {degree}: on every edge the nearest affine one stands for it, and what is left, {part:.2e} % of it in \
             the mean square, is part of the bracket, which is guaranteed for the polynomial.",
            traction.on
        );
        Note { weakens_guarantee: false, text }
    };
    problem.scene.tractions.iter().filter(|traction| !traction.terms.is_empty()).map(of).collect()
}
