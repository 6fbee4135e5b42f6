//! Least squares on the residual, term by term and with two terms together.

use nalgebra::{DMatrix, DVector};

use super::physical::is_simple;
use super::space::Space;
use super::{Finding, Trial};

/// Directions in which columns differ by less than this part of their length say nothing.
const DEPENDENT: f64 = 1e-9;
/// Pairs are made of this many terms at most: those that explain most alone.
const PAIRED: usize = 16;

/// Of what either leaves alone, what a pair may leave.
const TOGETHER: f64 = 1e-2;
/// Of the length of the residual, what each of a pair has to move at least, and may move at most: of two that are longer, one
/// undoes the other.
const MOVED: [f64; 2] = [0.03, 10.0];

/// Turns the coefficients of a term into findings.
type Told<'a> = Box<dyn Fn(&[f64]) -> Vec<Finding> + 'a>;

struct Term<'a> {
    rank: usize,
    columns: Vec<Vec<f64>>,
    told: Told<'a>,
}

/// Changes of the model under which the residual is r + Σ α_k c_k, with coefficients α to be found.
pub struct Terms<'a> {
    residual: &'a [f64],
    square: f64,
    list: Vec<Term<'a>>,
}

impl<'a> Terms<'a> {
    /// None yet.
    pub fn new(space: &'a Space<'a>) -> Self {
        Terms { residual: &space.residual, square: space.square, list: Vec::new() }
    }

    /// One more, told from its coefficients; without effect where its columns are zero, or too many for what they explain.
    pub fn push(&mut self, rank: usize, columns: Vec<Vec<f64>>, told: impl Fn(&[f64]) -> Vec<Finding> + 'a) {
        let numbers = self.residual.iter().filter(|r| **r != 0.0).count();
        if is_simple(columns.len(), numbers) && columns.iter().flatten().any(|x| *x != 0.0) {
            self.list.push(Term { rank, columns, told: Box::new(told) });
        }
    }

    /// Every term by itself.
    pub fn alone(&self) -> Vec<Trial> {
        self.list.iter().map(|term| self.trial(&[term])).filter(Trial::is_possible).collect()
    }

    /// Two terms together, those that explain most alone.
    pub fn together(&self) -> Vec<Trial> {
        let mut order: Vec<(f64, &Term<'a>)> = self.list.iter().map(|t| (self.trial(&[t]).left, t)).collect();
        order.sort_by(|a, b| a.0.total_cmp(&b.0));
        order.truncate(PAIRED);
        let pairs = (0..order.len()).flat_map(|i| (i + 1..order.len()).map(move |j| (i, j)));
        let pairs = pairs.filter_map(|(i, j)| {
            let terms = [order[i].1, order[j].1];
            let trial = self.trial(&terms);
            // A part has a number beside the whole that is none of its own.
            if trial.is_of_all_and_a_part() {
                return None;
            }
            let alone = order[i].0.min(order[j].0);
            (trial.left <= TOGETHER * alone && self.both_move(terms)).then_some(trial)
        });
        pairs.filter(Trial::is_possible).collect()
    }

    /// True if each of two terms that are fitted together takes a substantial part of the residual.
    fn both_move(&self, terms: [&Term<'a>; 2]) -> bool {
        let columns: Vec<&[f64]> = terms.iter().flat_map(|t| t.columns.iter().map(Vec::as_slice)).collect();
        let (coefficients, _) = fit(&columns, self.residual, self.square);
        let split = terms[0].columns.len();
        [0..split, split..columns.len()].into_iter().all(|own| {
            let at = |k: usize| own.clone().map(|i| columns[i][k] * coefficients[i]).sum::<f64>();
            let moved = ((0..self.residual.len()).map(|k| at(k).powi(2)).sum::<f64>() / self.square).sqrt();
            (MOVED[0]..=MOVED[1]).contains(&moved)
        })
    }

    fn trial(&self, terms: &[&Term<'a>]) -> Trial {
        let columns: Vec<&[f64]> = terms.iter().flat_map(|t| t.columns.iter().map(Vec::as_slice)).collect();
        let (coefficients, left) = fit(&columns, self.residual, self.square);
        let mut findings = Vec::new();
        let mut rest = coefficients.as_slice();
        for term in terms {
            let (own, others) = rest.split_at(term.columns.len());
            findings.extend((term.told)(own));
            rest = others;
        }
        Trial { rank: terms.iter().map(|t| t.rank).sum::<usize>() + 4 * (terms.len() - 1), left, findings }
    }
}

/// The coefficients that bring r + Σ α_k c_k nearest to zero, and what is left of its square, relative to that of r.
pub fn fit(columns: &[&[f64]], residual: &[f64], square: f64) -> (Vec<f64>, f64) {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
    let n = columns.len();
    let sizes: Vec<f64> = columns.iter().map(|c| dot(c, c).sqrt().max(f64::MIN_POSITIVE)).collect();
    // A column of zeros, as of a node that supports hold, has no product with any other.
    let cosine = |i: usize, j: usize| dot(columns[i], columns[j]) / sizes[i] / sizes[j];
    let gram = DMatrix::from_fn(n, n, |i, j| if cosine(i, j).is_finite() { cosine(i, j) } else { 0.0 });
    let load = DVector::from_fn(n, |i, _| -dot(columns[i], residual) / sizes[i]);
    let solution = gram.svd(true, true).solve(&load, DEPENDENT).unwrap_or_else(|_| DVector::zeros(n));
    let coefficients: Vec<f64> = solution.iter().zip(&sizes).map(|(x, size)| x / size).collect();
    // From the vector itself: differences of squares would lose what is small.
    let at = |k: usize| residual[k] + columns.iter().zip(&coefficients).map(|(c, x)| x * c[k]).sum::<f64>();
    let left = (0..residual.len()).map(|k| at(k).powi(2)).sum::<f64>() / square;
    (coefficients, left)
}
