//! The energy of a continuous displacement as a function of its nodes, with what holds them.

use super::beds::{BedEnergy, energies, reload};
use super::energies::{TriangleEnergies, TriangleEnergy};
use super::pull::Pull;
use crate::bounds::upper::admissible::holds::{Hold, Holds};
use crate::bounds::upper::admissible::nodes::Nodes;
use crate::bounds::upper::admissible::rows::Row;
use crate::bounds::upper::admissible::sliding::Sliding;
use crate::bounds::upper::relaxation::groups::Group;
use crate::bounds::upper::relaxation::share::Share;
use crate::problem::{ContactPair, Problem};

/// Energy and conditions that stay the same while patches move.
#[derive(Debug)]
pub struct Model {
    /// ½uᵀKu − fᵀu of every triangle, `None` where its inside has no unique minimum.
    pub energies: TriangleEnergies,
    /// The directions in which each node may move.
    pub free: Vec<Directions>,
    /// Bernstein coefficients of the jumps: at most zero.
    pub rows: Vec<Row>,
    /// Which of them have a part at each vertex or on the edges of its contact pairs.
    pub rows_at: Vec<Vec<usize>>,
    /// The energy of springs and elastic layers.
    pub beds: Vec<BedEnergy>,
    /// Which of them have a part at each vertex.
    pub beds_at: Vec<Vec<usize>>,
    /// The nodes on the boundaries of the triangles, one after the other, and where each triangle begins.
    of_triangles: (Vec<usize>, Vec<usize>),
    /// The ends of the edge of each node beyond the vertices.
    ends: Vec<[usize; 2]>,
    vertices: usize,
    /// The numbers of rows and springs that are not those of friction.
    without_friction: [usize; 2],
    /// As [`crate::element::Section::translations`].
    pub translations: [f64; 2],
}

impl Model {
    /// Prepares the energy of all triangles and the conditions on all nodes.
    ///
    /// `groups` are the rows of every pair, `pull` what the energy has beside that of the strains.
    pub fn new(problem: &Problem, holds: &Holds, nodes: &Nodes, groups: &[Vec<Row>], pull: Pull<'_>) -> Self {
        let like = |t| problem.mesh.corners(t);
        Self::shaped(problem, holds, nodes, groups, pull, like)
    }

    /// As [`Self::new`], but the first triangle of a shape has the stiffness of one with the corners `like`.
    pub fn shaped(
        problem: &Problem,
        holds: &Holds,
        nodes: &Nodes,
        groups: &[Vec<Row>],
        pull: Pull<'_>,
        like: impl Fn(usize) -> [[f64; 2]; 3] + Sync,
    ) -> Self {
        let mesh = &problem.mesh;
        let (mut of_triangles, mut start) = (Vec::new(), vec![0]);
        for t in 0..mesh.triangles.len() {
            of_triangles.extend(nodes.of_triangle(mesh, t));
            start.push(of_triangles.len());
        }
        let rows_at = rows_at(problem, groups);
        let mut beds = energies(problem, nodes);
        reload(&mut beds, pull.springs);
        let without_friction = [groups.iter().map(Vec::len).sum(), beds.len()];
        Model {
            without_friction,
            energies: TriangleEnergies::new(problem, nodes, pull, like),
            free: directions(holds, nodes),
            rows: groups.iter().flatten().cloned().collect(),
            rows_at,
            beds,
            beds_at: beds_at(problem),
            of_triangles: (of_triangles, start),
            ends: (0..nodes.edges())
                .flat_map(|e| std::iter::repeat_n(mesh.edges[e].vertices, nodes.inside(e).len()))
                .collect(),
            vertices: mesh.points.len(),
            translations: problem.section().translations(),
        }
    }

    /// Replaces the load and the bounds on the jumps, and leaves out friction.
    pub fn with(&mut self, problem: &Problem, nodes: &Nodes, groups: &[Vec<Row>], pull: Pull<'_>) {
        self.energies.reload(problem, nodes, pull);
        let [rows, beds] = self.without_friction;
        self.beds.truncate(beds);
        self.rows_at.iter_mut().for_each(|at| at.retain(|row| *row < rows));
        self.beds_at.iter_mut().for_each(|at| at.retain(|bed| *bed < beds));
        reload(&mut self.beds, pull.springs);
        self.rows = groups.iter().flatten().cloned().collect();
    }

    /// Adds the friction of contacts that slide and stick as `sliding` has them.
    pub fn rub(&mut self, problem: &Problem, nodes: &Nodes, sliding: &Sliding) {
        let pairs: Vec<&ContactPair> = problem.pairs().collect();
        let ends = |number: usize| pairs[number].first.iter().chain(pairs[number].second.iter().flatten()).copied();
        for (number, rows) in sliding.rows(problem, nodes) {
            let numbers = self.rows.len()..self.rows.len() + rows.len();
            ends(number).for_each(|v| self.rows_at[v].extend(numbers.clone()));
            self.rows.extend(rows);
        }
        for (number, energy) in sliding.energies(problem, nodes) {
            ends(number).for_each(|v| self.beds_at[v].push(self.beds.len()));
            self.beds.push(energy);
        }
    }

    /// Takes every elastic contact for the springs that it is at `values`, and gives the energy that these store beside the one that is
    /// counted.
    pub fn touch(&mut self, values: &[[f64; 2]]) -> f64 {
        self.beds.iter_mut().map(|bed| bed.touch(values)).sum()
    }

    /// True if nodes held by `holds` may move in the same directions.
    pub fn is_free_as(&self, holds: &Holds, nodes: &Nodes) -> bool {
        self.free == directions(holds, nodes)
    }

    /// 𝓛 of the values per unit thickness less that of zero values, without the triangles that have no unique minimum
    /// inside. With zero values the body force still moves the inside of the triangles.
    pub fn energy(&self, values: &[[f64; 2]], share: &dyn Share) -> f64 {
        let (mut u, mut room) = (Vec::new(), Vec::new());
        let of = |(t, element): (usize, TriangleEnergy<'_>)| {
            self.about_corner(t, values, &mut u);
            element.energy(&u, self.nodes(t).iter().flat_map(|&node| values[node]), &mut room)
        };
        let springs: f64 = self.beds.iter().map(|bed| bed.energy(values)).sum();
        springs + share.total(self.energies.iter().filter(|(t, _)| share.has_triangle(*t)).map(of).sum())
    }

    /// 𝓛 of zero values per unit thickness, as [`Self::energy`] leaves it out.
    pub fn energy_at_rest(&self) -> f64 {
        self.energies.iter().map(|(_, element)| element.at_rest()).sum()
    }

    /// Values on the boundary of triangle `t` about its first corner: translations carry no energy and should cost no
    /// digits.
    pub fn about_corner(&self, t: usize, values: &[[f64; 2]], out: &mut Vec<f64>) {
        let nodes = self.nodes(t);
        let base = values[nodes[0]];
        out.clear();
        let [p, q] = self.translations;
        out.extend(nodes.iter().flat_map(|&node| [values[node][0] - p * base[0], values[node][1] - q * base[1]]));
    }

    /// The nodes on the boundary of triangle `t`, as [`Nodes::of_triangle`] gives them.
    pub fn nodes(&self, t: usize) -> &[usize] {
        let (nodes, start) = &self.of_triangles;
        &nodes[start[t]..start[t + 1]]
    }

    /// True if a node moves with the vertices of a group.
    pub fn moves(&self, node: usize, group: &Group) -> bool {
        match node.checked_sub(self.vertices) {
            None => group.vertices.contains(&node),
            Some(inside) => self.ends[inside].iter().any(|v| group.vertices.contains(v)),
        }
    }
}

/// The directions in which each node may move.
fn directions(holds: &Holds, nodes: &Nodes) -> Vec<Directions> {
    let of = |hold: Hold| match hold {
        Hold::Free => Directions { count: 2, unit: [[1.0, 0.0], [0.0, 1.0]] },
        Hold::Line { normal: [x, y], .. } => Directions { count: 1, unit: [[-y, x]; 2] },
        Hold::Fixed(_) => Directions { count: 0, unit: [[0.0; 2]; 2] },
    };
    holds.of_nodes(nodes).map(of).collect()
}

/// Up to two unit vectors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Directions {
    /// How many.
    pub count: usize,
    /// The unit vectors; any numbers beyond the count.
    pub unit: [[f64; 2]; 2],
}

impl Directions {
    /// The part of a step that goes along them.
    pub fn along(&self, step: [f64; 2]) -> [f64; 2] {
        match self.count {
            0 => [0.0; 2],
            1 => {
                let [x, y] = self.unit[0];
                let by = step[0] * x + step[1] * y;
                [by * x, by * y]
            }
            _ => step,
        }
    }
}

/// The springs at each vertex, by the number of their pair.
fn beds_at(problem: &Problem) -> Vec<Vec<usize>> {
    let mut at = vec![Vec::new(); problem.mesh.points.len()];
    for (number, (pair, _)) in problem.bed_pairs().enumerate() {
        for v in pair.sides().flat_map(|(_, e)| problem.mesh.edges[e].vertices) {
            if at[v].last() != Some(&number) {
                at[v].push(number);
            }
        }
    }
    at
}

/// The rows of contact at each vertex: all of each pair that ends there.
fn rows_at(problem: &Problem, groups: &[Vec<Row>]) -> Vec<Vec<usize>> {
    let mut at = vec![Vec::new(); problem.mesh.points.len()];
    let mut next = 0;
    for (pair, rows) in problem.pairs().zip(groups) {
        let rows = next..next + rows.len();
        next = rows.end;
        for &v in pair.first.iter().chain(pair.second.iter().flatten()) {
            at[v].extend(rows.clone());
        }
    }
    at
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounds::potential;
    use crate::bounds::upper::admissible::holds::holds;
    use crate::bounds::upper::admissible::nodes::NodalValues;
    use crate::bounds::upper::admissible::rows::rows;
    use crate::bounds::upper::energy::interior::fill;
    use crate::bounds::upper::relaxation::share::Whole;
    use crate::scene::Scene;

    /// A block on an obstacle with a gap, pressed and heavy.
    const SCENE: &str = r#"
        [model]
        kinematics = "plane-strain"
        [geometry]
        size = 0.5
        [[geometry.polygons]]
        body = "a"
        points = [[0, 0], [1, 0], [1, 1], [0, 1]]
        edges = ["foot", "", "top", "axis"]
        [bodies.a]
        young = 1.0
        poisson = 0.3
        body_force = [0.2, -1.0]
        [[supports]]
        on = "axis"
        type = "roller"
        [[tractions]]
        on = "top"
        pressure = 0.1
        [[contacts]]
        on = "foot"
        gap = { circle = 3, at = 0 }
    "#;

    fn problem() -> Problem {
        Problem::load(Scene::parse(SCENE, "block.toml".as_ref()).expect("a scene")).expect("a problem")
    }

    fn nodes(problem: &Problem, degree: impl Fn(usize) -> usize) -> Nodes {
        Nodes::new(problem.mesh.points.len(), (0..problem.mesh.edges.len()).map(degree))
    }

    fn model(problem: &Problem, nodes: &Nodes) -> Model {
        let rows = rows(problem, nodes);
        let holds = holds(problem).expect("supports agree");
        Model::new(problem, &holds, nodes, &rows, Pull::SCENE)
    }

    fn energy(problem: &Problem, field: &NodalValues) -> f64 {
        model(problem, &field.nodes).energy(&field.values, &Whole)
    }

    /// Stiffness matrices against strains by quadrature, on edges of equal and of different degrees.
    #[test]
    fn the_energy_is_that_of_the_displacement_filled_in() {
        let problem = problem();
        let degrees: [&dyn Fn(usize) -> usize; 4] = [&|_| 2, &|_| 5, &|e| 2 + e % 3, &|e| 1 + (3 * e) % 5];
        for degree in degrees {
            let mut field = NodalValues::zeros(nodes(&problem, degree));
            field.values.iter_mut().enumerate().for_each(|(n, v)| *v = [(n as f64).sin(), (3.0 * n as f64).cos()]);
            let model = model(&problem, &field.nodes);
            let filled = |field: &NodalValues| potential(&problem, &fill(&problem, field, &model));
            let (found, at_rest) = (filled(&field), filled(&NodalValues::zeros(field.nodes.clone())));
            let expected = (found.total() - at_rest.total()) / problem.scene.thickness;
            let of_model = model.energy(&field.values, &Whole);
            assert!((of_model - expected).abs() < 1e-11 * found.magnitude, "{of_model} is not {expected}");
        }
    }

    #[test]
    fn spaces_of_higher_degree_contain_those_of_lower() {
        let problem = problem();
        let mut field = NodalValues::zeros(nodes(&problem, |_| 2));
        field.values.iter_mut().enumerate().for_each(|(n, v)| *v = [(n as f64).sin(), (3.0 * n as f64).cos()]);
        let mut last = energy(&problem, &field);
        let degrees: [&dyn Fn(usize) -> usize; 3] = [&|e| 2 + e % 3, &|_| 4, &|_| 6];
        for degree in degrees {
            let raised = field.clone().on(&problem.mesh, &nodes(&problem, degree));
            let next = energy(&problem, &raised);
            assert!(next <= last + 1e-12 * last.abs(), "{next} after {last}");
            last = next;
        }
    }
}
