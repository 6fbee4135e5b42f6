//! Forces on the Bernstein polynomials of a displacement of any degree: [`NodalForces`] by coefficients in place of nodes.

use super::NodalForces;
use super::functions::Functions;
use crate::element::PlainDisplacement;
use crate::element::displacement::plain;
use crate::element::geometry::gradients;
use crate::element::polynomial::triangle;
use crate::problem::Problem;

/// One polynomial and its partner in the gradient of another: ∇B_α = k Σ_i B_{α − e_i} ∇l_i.
struct Term {
    alpha: usize,
    side: usize,
    lowered: triangle::Index,
}

impl NodalForces {
    /// Forces of a displacement by its coefficients, numbered as its values are; exact, as all integrands are polynomials.
    pub fn of_coefficients(problem: &Problem, field: &PlainDisplacement) -> Self {
        let mesh = &problem.mesh;
        let (k, count) = (field.degree(), field.values().len());
        let mut forces = NodalForces::zeros(count);
        let terms: Vec<Term> = triangle::indices(k)
            .enumerate()
            .flat_map(|(alpha, index)| {
                let lowered = move |side| Some(Term { alpha, side, lowered: triangle::lowered(index, side)? });
                (0..3).filter_map(lowered)
            })
            .collect();
        let betas: Vec<triangle::Index> = triangle::indices(k - 1).collect();
        let products: Vec<Vec<f64>> =
            terms.iter().map(|term| betas.iter().map(|b| triangle::product(*b, term.lowered)).collect()).collect();
        let materials = problem.materials();
        let mut stiffest = vec![0.0; count];
        for t in 0..mesh.triangles.len() {
            let material = &materials[mesh.body[t]];
            let modulus = material.stiffest();
            let area = problem.scene.thickness * mesh.area(t);
            let g = gradients(mesh.corners(t)).map(|d| d.map(|x| k as f64 * x));
            let long = g.map(|d| d[0].hypot(d[1]));
            let nodes = plain::nodes(mesh, k, t);
            let values = field.values();
            let mut stresses = Vec::with_capacity(betas.len());
            let mut spreads = Vec::with_capacity(betas.len());
            for beta in &betas {
                let u = [0, 1, 2].map(|i| values[nodes[triangle::number(triangle::raised(*beta, i))]]);
                let mut e = [0.0; 3];
                for i in 1..3 {
                    // Differences of neighbours: a rigid translation leaves no trace.
                    let (x, y) = (u[i][0] - u[0][0], u[i][1] - u[0][1]);
                    e[0] += g[i][0] * x;
                    e[1] += g[i][1] * y;
                    e[2] += 0.5 * (g[i][1] * x + g[i][0] * y);
                }
                stresses.push(material.stress(e));
                spreads.push((0..3).map(|i| long[i] * u[i][0].hypot(u[i][1])).sum::<f64>());
            }
            for (term, products) in terms.iter().zip(&products) {
                let node = nodes[term.alpha];
                let d = g[term.side];
                for ((product, s), spread) in products.iter().zip(&stresses).zip(&spreads) {
                    let weight = area * product;
                    forces.left[node][0] += weight * (d[0] * s[0] + d[1] * s[2]);
                    forces.left[node][1] += weight * (d[0] * s[2] + d[1] * s[1]);
                    forces.size[node] += weight * modulus * long[term.side] * spread;
                }
            }
            for own in terms.chunk_by(|a, b| a.alpha == b.alpha) {
                let node = nodes[own[0].alpha];
                let pairs = own.iter().flat_map(|a| own.iter().map(move |b| (a, b)));
                let square: f64 = pairs
                    .map(|(a, b)| {
                        let [d, e] = [g[a.side], g[b.side]];
                        (d[0] * e[0] + d[1] * e[1]) * triangle::product(a.lowered, b.lowered)
                    })
                    .sum();
                let part = area * modulus * square;
                forces.stiffness[node] += part;
                if part > stiffest[node] {
                    (stiffest[node], forces.triangle[node]) = (part, t);
                }
            }
            if !material.initial().is_none() {
                let held: [[f64; 3]; 3] = mesh.corners(t).map(|corner| material.held_back(corner));
                for term in &terms {
                    let s = triangle::indices(1).zip(held).fold([0.0; 3], |sum, (corner, s)| {
                        let part = triangle::product(term.lowered, corner);
                        [0, 1, 2].map(|c| sum[c] + part * s[c])
                    });
                    forces.add_initial(area, s, &[nodes[term.alpha]], &[g[term.side]]);
                }
            }
            let force = problem.force_on(t).of_area(area);
            for (node, alpha) in nodes.into_iter().zip(triangle::indices(k)) {
                let (load, f) = (&mut forces.load[node], force.against(alpha));
                *load = [0, 1].map(|c| load[c] + f[c]);
            }
        }
        forces.add_springs(problem, k, Functions::Coefficients, |node| field.values()[node]);
        forces.add_tractions(problem, k, Functions::Coefficients);
        forces.take_loads();
        forces
    }
}
