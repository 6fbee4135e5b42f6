//! Rectangular bodies on grids, put together in memory.

use crate::mesh::sides::glue;
use crate::mesh::sides::glue::Glued;
use crate::mesh::{RawMesh, Triangulation};
use crate::problem::Problem;
use crate::scene::{
    Affine, Body, Contact, ContactSides, Draft, FrictionBound, Gap, Kinematics, Load, MeshSource, Polygon, Scene,
    Support, SupportKind, Traction,
};

/// A scene with its mesh, before it is checked.
#[derive(Debug, Clone)]
pub struct Sketch {
    /// Bodies and conditions.
    pub scene: Draft,
    /// Triangles and named segments.
    pub raw: RawMesh,
}

impl Sketch {
    /// Nothing yet, in plane strain.
    pub fn new() -> Self {
        let mesh = MeshSource::File("regime.msh".into());
        let scene = Draft::new("regime", Kinematics::PlaneStrain, mesh);
        Sketch { scene, raw: RawMesh::default() }
    }

    /// A rectangle of cells between the lines `xs` and `ys`, each cut along one diagonal, alternating; its sides are
    /// called `<name>_bottom`, `_right`, `_top`, `_left`.
    pub fn block(mut self, name: &str, [young, poisson]: [f64; 2], xs: &[f64], ys: &[f64]) -> Self {
        self.scene.bodies.push(Body::isotropic(name, young, poisson));
        let base = self.raw.points.len();
        let (columns, rows) = (xs.len() - 1, ys.len() - 1);
        for y in ys {
            self.raw.points.extend(xs.iter().map(|x| [*x, *y]));
        }
        let at = |i: usize, j: usize| base + j * (columns + 1) + i;
        for j in 0..rows {
            for i in 0..columns {
                let (a, b, c, d) = (at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
                let cut = if (i + j) % 2 == 0 { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] };
                self.raw.triangles.extend(cut.map(|t| (t, name.to_string())));
            }
        }
        for i in 0..columns {
            self.raw.segments.push(([at(i, 0), at(i + 1, 0)], format!("{name}_bottom")));
            self.raw.segments.push(([at(i, rows), at(i + 1, rows)], format!("{name}_top")));
        }
        for j in 0..rows {
            self.raw.segments.push(([at(0, j), at(0, j + 1)], format!("{name}_left")));
            self.raw.segments.push(([at(columns, j), at(columns, j + 1)], format!("{name}_right")));
        }
        self
    }

    /// Cuts every cell along the same diagonal: on such a mesh linear displacements have the fewest ways to keep the area
    /// of every triangle.
    pub fn one_way(mut self) -> Self {
        for pair in self.raw.triangles.chunks_exact_mut(2) {
            let [(first, _), (second, _)] = pair else { continue };
            if first[0] != second[0] {
                let ([a, b, d], c) = (*first, second[1]);
                (*first, *second) = ([a, b, c], [a, c, d]);
            }
        }
        self
    }

    /// Turns it into the section of a body of revolution about the line on which the first coordinate is zero.
    pub fn revolved(mut self) -> Self {
        self.scene.kinematics = Kinematics::Axisymmetric;
        self.scene.thickness = self.scene.kinematics.measure();
        self
    }

    /// u = 0 on `on`.
    pub fn clamp(mut self, on: &str) -> Self {
        self.scene.supports.push(Support { on: on.into(), kind: SupportKind::CLAMPED });
        self
    }

    /// u_n = 0, no shear, on `on`.
    pub fn roller(mut self, on: &str) -> Self {
        self.scene.supports.push(Support { on: on.into(), kind: SupportKind::ROLLER });
        self
    }

    /// Springs of this stiffness along the normal on `on`.
    pub fn springs(mut self, on: &str, stiffness: f64) -> Self {
        let kind = SupportKind::Spring { stiffness: [stiffness, 0.0] };
        self.scene.supports.push(Support { on: on.into(), kind });
        self
    }

    /// P = (a + b y, 0) on `on`.
    pub fn push(mut self, on: &str, a: f64, b: f64) -> Self {
        let load = Load::Affine(Affine { value: [a, 0.0], gradient: [[0.0, b], [0.0, 0.0]] });
        self.scene.tractions.push(Traction { on: on.into(), load, terms: Vec::new() });
        self
    }

    /// Pressure on `on`.
    pub fn pressure(mut self, on: &str, pressure: f64) -> Self {
        self.scene.tractions.push(Traction { on: on.into(), load: Load::Pressure(pressure), terms: Vec::new() });
        self
    }

    /// Contact of two sides.
    pub fn contact(mut self, first: &str, second: &str, gap: Gap) -> Self {
        let sides = ContactSides::Between([first.into(), second.into()]);
        self.scene.contacts.push(Contact::new(sides, gap));
        self
    }

    /// The last contact with this friction bound.
    pub fn rubbing(mut self, bound: f64) -> Self {
        if let Some(contact) = self.scene.contacts.last_mut() {
            contact.friction = Some(FrictionBound::Constant(bound));
        }
        self
    }

    /// Contact of a side with a rigid obstacle.
    pub fn rigid(mut self, on: &str) -> Self {
        self.scene.contacts.push(Contact::new(ContactSides::Rigid(on.into()), Gap::Constant(0.0)));
        self
    }

    /// Moves every vertex.
    pub fn moved(mut self, to: impl Fn([f64; 2]) -> [f64; 2]) -> Self {
        self.raw.points.iter_mut().for_each(|p| *p = to(*p));
        self
    }

    /// Gives segments called `name` whose midpoint passes `test` another name.
    pub fn renamed(mut self, name: &str, to: &str, test: impl Fn([f64; 2]) -> bool) -> Self {
        for ([a, b], current) in &mut self.raw.segments {
            let [p, q] = [self.raw.points[*a], self.raw.points[*b]];
            if current == name && test([0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1])]) {
                *current = to.to_string();
            }
        }
        self
    }

    /// Lets bodies share the vertices that have equal places and pass `test`.
    pub fn bonded(mut self, test: impl Fn([f64; 2]) -> bool) -> Self {
        let points = &self.raw.points;
        let twin: Vec<usize> = (0..points.len())
            .map(|v| if test(points[v]) { points.iter().position(|p| *p == points[v]).unwrap_or(v) } else { v })
            .collect();
        self.raw.triangles.iter_mut().for_each(|(corners, _)| *corners = corners.map(|v| twin[v]));
        self.raw.segments.iter_mut().for_each(|(ends, _)| *ends = ends.map(|v| twin[v]));
        self
    }

    /// Renumbers vertices, triangles, corners and segments of the mesh at random; seed 0 changes nothing.
    pub fn shuffled(mut self, seed: u64) -> Self {
        if seed == 0 {
            return self;
        }
        let mut random = Random(seed);
        let order = random.permutation(self.raw.points.len());
        let mut points = self.raw.points.clone();
        for (old, new) in order.iter().enumerate() {
            points[*new] = self.raw.points[old];
        }
        self.raw.points = points;
        for (corners, _) in &mut self.raw.triangles {
            *corners = corners.map(|v| order[v]);
            corners.rotate_left(random.below(3));
        }
        for (ends, _) in &mut self.raw.segments {
            *ends = ends.map(|v| order[v]);
        }
        let triangles = random.permutation(self.raw.triangles.len());
        self.raw.triangles = triangles.into_iter().map(|t| self.raw.triangles[t].clone()).collect();
        self
    }

    /// Checks everything.
    ///
    /// # Errors
    /// A description of the defects of scene or mesh.
    pub fn problem(self) -> Result<Problem, String> {
        // Its triangles are no file's and no polygons'.
        let scene = Scene::unchecked(self.scene);
        let (mesh, mut notes) = Triangulation::new(self.raw, &scene).map_err(|e| e.to_string())?;
        let Glued { mesh, notes: more, .. } = glue::glue(mesh, &scene).map_err(|e| e.to_string())?;
        notes.extend(more);
        Problem::new(scene, mesh, notes).map_err(|e| e.to_string())
    }

    /// Meshes polygons instead of the grids, with edges of length `size`.
    ///
    /// # Errors
    /// As [`Sketch::problem`].
    pub fn polygons(mut self, polygons: Vec<Polygon>, size: f64) -> Result<Problem, String> {
        self.scene.mesh = MeshSource::Geometry { size: Some(size), polygons };
        Problem::load(Scene::new(self.scene).map_err(|e| e.to_string())?).map_err(|e| e.to_string())
    }

    /// A body without triangles of its own, for [`Sketch::polygons`].
    pub fn body(mut self, name: &str, young: f64, poisson: f64) -> Self {
        self.scene.bodies.push(Body::isotropic(name, young, poisson));
        self
    }
}

/// A polygon with named edges.
pub fn polygon(body: &str, points: &[[f64; 2]], edges: &[&str]) -> Polygon {
    Polygon {
        body: body.into(),
        points: points.to_vec(),
        edges: edges.iter().map(ToString::to_string).collect(),
        arcs: Vec::new(),
    }
}

/// `n` equal steps from `from` to `to`.
pub fn steps(from: f64, to: f64, n: usize) -> Vec<f64> {
    (0..=n).map(|i| from + (to - from) * (i as f64 / n as f64)).collect()
}

/// Two unit blocks: the left one on a roller, pushed by (a + b y, 0), the right one clamped at its far side.
#[derive(Debug, Clone)]
pub struct Lift {
    /// Squares per side of a block.
    pub n: usize,
    /// E and ν of the left and the right block.
    pub materials: [[f64; 2]; 2],
    /// a and b.
    pub load: [f64; 2],
    /// Initial gap.
    pub gap: Gap,
}

impl Lift {
    /// The load that lifts the left block off: resultant ½.
    pub const LOAD: [f64; 2] = [4.0, -7.0];

    /// With `n` squares a side.
    pub fn new(n: usize) -> Self {
        Lift { n, materials: [[1.0, 0.3]; 2], load: Self::LOAD, gap: Gap::Constant(0.0) }
    }

    /// On given lines x of the left block (mirrored for the right one) and y of both.
    pub fn on(&self, left: &[f64], ys: [&[f64]; 2]) -> Sketch {
        let right: Vec<f64> = left.iter().rev().map(|x| 2.0 - x).collect();
        Sketch::new()
            .block("left", self.materials[0], left, ys[0])
            .block("right", self.materials[1], &right, ys[1])
            .clamp("right_right")
            .roller("left_bottom")
            .push("left_left", self.load[0], self.load[1])
            .contact("left_right", "right_left", self.gap.clone())
    }

    /// On squares.
    pub fn model(&self) -> Sketch {
        let lines = steps(0.0, 1.0, self.n);
        self.on(&lines, [&lines, &lines])
    }
}

/// Numbers that are the same on every machine (Steele, Lea and Flood's SplitMix64).
#[derive(Debug, Clone)]
pub struct Random(pub u64);

impl Random {
    /// The next 64 bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A whole number below `n`.
    pub fn below(&mut self, n: usize) -> usize {
        (self.bits() % n.max(1) as u64) as usize
    }

    /// A number in [−1, 1).
    pub fn signed(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    /// All of 0 … n − 1 in random order.
    pub fn permutation(&mut self, n: usize) -> Vec<usize> {
        let mut order: Vec<usize> = (0..n).collect();
        for i in (1..n).rev() {
            order.swap(i, self.below(i + 1));
        }
        order
    }
}
