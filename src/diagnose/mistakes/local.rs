//! Mistakes in one place: a value, an equation, a triangle, a boundary.

use std::collections::BTreeSet;

use crate::compare::solution::SOLVER;
use crate::diagnose::fit::fit;
use crate::diagnose::physical::is_simple;
use crate::diagnose::space::{Moduli, Space};
use crate::diagnose::words::{factor, near, number};
use crate::diagnose::{Finding, Trial};
use crate::problem::Condition;
use crate::vector::distance;

/// Nodes with the largest residual around which a place is looked for.
const LARGEST: usize = 8;

/// All places.
pub fn trials(space: &Space<'_>) -> Vec<Trial> {
    let places = Places::new(space);
    let mut trials = Vec::new();
    let near_the_worst: BTreeSet<usize> = places.worst.iter().flat_map(|n| &places.triangles_at[*n]).copied().collect();
    let nodes: BTreeSet<usize> = near_the_worst.iter().flat_map(|t| space.nodes(*t)).collect();
    trials.extend(nodes.iter().filter_map(|node| places.moved(*node)));
    trials.extend(places.worst.iter().map(|node| places.equation(*node)));
    for t in &near_the_worst {
        trials.push(places.material(*t));
        trials.push(places.assembled(*t));
    }
    let vertices = space.problem().mesh.points.len();
    trials.extend(nodes.iter().filter(|n| **n < vertices).map(|node| places.around(*node)));
    trials.extend((0..space.problem().mesh.names.len()).map(|name| places.boundary(name)));
    trials
}

struct Places<'a> {
    space: &'a Space<'a>,
    triangles_at: Vec<Vec<usize>>,
    worst: Vec<usize>,
}

impl<'a> Places<'a> {
    fn new(space: &'a Space<'a>) -> Self {
        let mut triangles_at = vec![Vec::new(); space.count()];
        for t in 0..space.problem().mesh.triangles.len() {
            space.nodes(t).into_iter().for_each(|n| triangles_at[n].push(t));
        }
        let mut worst = space.solution.worst();
        worst.truncate(LARGEST);
        Places { space, triangles_at, worst }
    }

    fn own(&self, t: usize) -> Moduli {
        let problem = self.space.problem();
        Moduli::of_body(problem, &problem.scene.bodies[problem.mesh.body[t]])
    }

    /// What triangle `t` asks for with other constants.
    fn column(&self, t: usize, moduli: Moduli) -> Vec<f64> {
        let mut forces = vec![[0.0; 2]; self.space.count()];
        let value = |n: usize| self.space.solution.candidate.value(n);
        self.space.add_element(t, moduli, value, |node, f| (0..2).for_each(|c| forces[node][c] += f[c]));
        self.space.column(forces)
    }

    /// One wrong value, where no support says what it is.
    fn moved(&self, node: usize) -> Option<Trial> {
        let solution = self.space.solution;
        let hold = solution.hold(node);
        let value = solution.candidate.value(node);
        let enough = (SOLVER + solution.candidate.precision) * solution.reference;
        // What a support prescribes and the field meets is right.
        let met = distance(hold.impose(value), value) <= enough;
        let [first, second] = [[1.0, 0.0], [0.0, 1.0]].map(|unit| if met { hold.project(unit) } else { unit });
        if first == [0.0; 2] && second == [0.0; 2] {
            return None;
        }
        let column = |unit: [f64; 2]| {
            let value = |n: usize| if n == node { unit } else { [0.0; 2] };
            self.space.column(self.space.own_forces(Some(&self.triangles_at[node]), value))
        };
        let (x, left) = fit(&[&column(first), &column(second)], &self.space.residual, self.space.square);
        let x = [0, 1].map(|c| x[0] * first[c] + x[1] * second[c]);
        let size = x[0].hypot(x[1]);
        let off = [0, 1].map(|c| if x[c].abs() > 1e-6 * size { 0.0 - x[c] } else { 0.0 });
        let sentence = format!(
            "the displacement of {} is off by ({}, {})",
            self.space.solution.named(node),
            number(off[0]),
            number(off[1])
        );
        let finding = Finding::new("value", Some(off[0].hypot(off[1])), Some(0.0), sentence);
        Some(Trial { rank: 4, left, findings: vec![finding] })
    }

    /// Part of the squared residual that is left without the equations of the given nodes, and of those that contacts tie to them; all of
    /// it where these are a large part of the mesh.
    fn without(&self, nodes: impl IntoIterator<Item = usize>) -> f64 {
        let mut all: BTreeSet<usize> = nodes.into_iter().collect();
        for site in &self.space.solution.sites.list {
            let Some(second) = site.second else { continue };
            if all.contains(&site.first) || all.contains(&second) {
                all.extend([site.first, second]);
            }
        }
        if !is_simple(all.len(), self.space.count()) {
            return 1.0;
        }
        let inside: f64 = all.into_iter().map(|n| self.space.square_at(n)).sum();
        (1.0 - inside / self.space.square).max(0.0)
    }

    /// One equation that does not hold.
    fn equation(&self, node: usize) -> Trial {
        let [x, y] = self.space.solution.rest[node];
        let name = self.space.solution.named(node);
        let sentence =
            format!("the equations of {name} alone are not met: a force ({}, {}) acts there", number(x), number(y));
        Trial {
            rank: 5,
            left: self.without([node]),
            findings: vec![Finding::new("equation", Some(x.hypot(y)), Some(0.0), sentence)],
        }
    }

    /// One triangle of another material.
    fn material(&self, t: usize) -> Trial {
        let Moduli { lambda, mu, .. } = self.own(t);
        if mu == 0.0 || self.space.solution.rule.is_some() {
            let value = |n: usize| self.space.solution.candidate.value(n);
            let column = self.space.column(self.space.own_forces(Some(&[t]), value));
            let (x, left) = fit(&[&column], &self.space.residual, self.space.square);
            let sentence = factor(&format!("the stiffness of {}", self.named(t)), 1.0 + x[0]);
            let findings = vec![Finding::new("triangle/material", Some(1.0 + x[0]), None, sentence)];
            return Trial { rank: 4, left, findings };
        }
        let columns = [
            self.column(t, Moduli { lambda: 1.0, ..Moduli::NONE }),
            self.column(t, Moduli { mu: 1.0, shear: 1.0, ..Moduli::NONE }),
        ];
        // Two constants explain the forces at one free node whatever they are.
        let seen = (0..columns[0].len()).filter(|k| columns.iter().any(|column| column[*k] != 0.0)).count();
        if seen < 2 * columns.len() {
            return self.assembled(t);
        }
        let (x, left) = fit(&columns.each_ref().map(Vec::as_slice), &self.space.residual, self.space.square);
        let (of_lambda, of_mu) = (1.0 + x[0] / lambda, 1.0 + x[1] / mu);
        let name = self.named(t);
        let (value, sentence) = if near(of_lambda, of_mu) {
            (Some(of_mu), factor(&format!("the stiffness of {name}"), of_mu))
        } else {
            let kinematics = self.space.problem().scene.kinematics;
            let [young, poisson] = Moduli::engineering(kinematics, lambda + x[0], mu + x[1]);
            // Of no body: it is missing, or wrong in another way.
            if !(young > 0.0 && -1.0 < poisson && poisson < 0.5) {
                return self.assembled(t);
            }
            (None, format!("{name} has the material E = {}, ν = {}", number(young), number(poisson)))
        };
        Trial { rank: 4, left, findings: vec![Finding::new("triangle/material", value, None, sentence)] }
    }

    /// One triangle whose forces are wrong in whatever way.
    fn assembled(&self, t: usize) -> Trial {
        let sentence = format!("{} is assembled wrongly: all of the residual is at its nodes", self.named(t));
        Trial {
            rank: 8,
            left: self.without(self.space.nodes(t)),
            findings: vec![Finding::new("triangle/assembled", None, None, sentence)],
        }
    }

    /// All triangles at a vertex, as where its coordinates are wrong.
    fn around(&self, vertex: usize) -> Trial {
        let nodes: BTreeSet<usize> = self.triangles_at[vertex].iter().flat_map(|t| self.space.nodes(*t)).collect();
        let sentence = format!(
            "the triangles around {} are assembled wrongly, as if it were somewhere else: all of the residual is at their nodes",
            self.space.solution.named(vertex)
        );
        Trial {
            rank: 9,
            left: self.without(nodes),
            findings: vec![Finding::new("vertex/assembled", None, None, sentence)],
        }
    }

    /// Forces on a boundary that should not be there.
    fn boundary(&self, name: usize) -> Trial {
        let mesh = &self.space.problem().mesh;
        let name = &mesh.names[name];
        let edges = mesh.boundary(name);
        let vertices = mesh.points.len();
        let nodes: BTreeSet<usize> =
            edges.iter().flat_map(|e| mesh.edges[*e].vertices.into_iter().chain([vertices + e])).collect();
        let left = self.without(nodes.into_iter().filter(|n| *n < self.space.count()));
        let (key, sentence) = match edges.first().map(|e| self.space.problem().conditions[*e]) {
            Some(Condition::Roller { .. }) => {
                ("clamped", format!("{name} is held along the boundary too, where the scene lets it slide"))
            }
            Some(Condition::Traction(_)) => {
                ("forces", format!("the nodal forces on {name} are not the consistent ones of the scene's load"))
            }
            _ => ("forces", format!("forces act on {name} that the scene does not have")),
        };
        Trial { rank: 7, left, findings: vec![Finding::new(format!("boundary/{name}/{key}"), None, None, sentence)] }
    }

    fn named(&self, t: usize) -> String {
        let problem = self.space.problem();
        let numbering = self.space.solution.candidate.numbering.as_ref();
        let corners = problem.mesh.triangles[t].map(|v| self.space.solution.named(v)).join(", ");
        if let Some(cell) = self.space.cell(t) {
            let corners = cell.nodes.iter().take(4).map(|v| self.space.solution.named(*v)).collect::<Vec<_>>();
            return format!("the quadrilateral with the corners {}", corners.join(", "));
        }
        match numbering.and_then(|n| n.triangle(t)) {
            Some(triangle) => format!("{triangle} (corners: {corners})"),
            None => format!("the triangle with the corners {corners}"),
        }
    }
}
