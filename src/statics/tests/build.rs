//! Scenes put together by hand.

use crate::mesh::{Edge, Triangulation};
use crate::problem::{Bow, Condition, ContactPair, Direction, Interface, Problem};
use crate::scene::{Body, Draft, Kinematics, MeshSource, Scene};
use std::collections::HashMap;

type Point = [f64; 2];

/// Blocks with conditions on straight pieces of their boundary.
#[derive(Default)]
pub struct Build {
    bodies: Vec<Body>,
    points: Vec<Point>,
    triangles: Vec<[usize; 3]>,
    body: Vec<usize>,
    /// (body, line) → what holds on the edges of the body that lie on the line.
    clamped: Vec<(usize, [Point; 2])>,
    rollers: Vec<(usize, [Point; 2])>,
    tractions: Vec<(usize, [Point; 2], [Point; 2])>,
    contacts: Vec<(usize, Option<usize>, [Point; 2])>,
}

impl Build {
    pub fn body(&mut self, name: &str) -> usize {
        if let Some(found) = self.bodies.iter().position(|body| body.name == name) {
            return found;
        }
        self.bodies.push(Body::isotropic(name, 1.0, 0.3));
        self.bodies.len() - 1
    }

    /// A quadrilateral with counter-clockwise `corners`, n × n cells of two triangles.
    pub fn quad(&mut self, name: &str, corners: [Point; 4], n: usize) -> &mut Self {
        let body = self.body(name);
        let base = self.points.len();
        let [a, b, c, d] = corners;
        for j in 0..=n {
            for i in 0..=n {
                let (s, t) = (i as f64 / n as f64, j as f64 / n as f64);
                let blend = |k: usize| (1.0 - t) * ((1.0 - s) * a[k] + s * b[k]) + t * ((1.0 - s) * d[k] + s * c[k]);
                self.points.push([blend(0), blend(1)]);
            }
        }
        let at = |i: usize, j: usize| base + j * (n + 1) + i;
        for j in 0..n {
            for i in 0..n {
                self.triangles.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
                self.triangles.push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
                self.body.extend([body, body]);
            }
        }
        self
    }

    /// An axis-parallel block.
    pub fn block(&mut self, name: &str, [x0, y0]: Point, [x1, y1]: Point, n: usize) -> &mut Self {
        self.quad(name, [[x0, y0], [x1, y0], [x1, y1], [x0, y1]], n)
    }

    /// A star of triangles around the mean of counter-clockwise `corners`.
    pub fn fan(&mut self, name: &str, corners: &[Point]) -> &mut Self {
        let body = self.body(name);
        let base = self.points.len();
        let n = corners.len();
        let mean = |k: usize| corners.iter().map(|p| p[k]).sum::<f64>() / n as f64;
        self.points.push([mean(0), mean(1)]);
        self.points.extend(corners);
        for i in 0..n {
            self.triangles.push([base, base + 1 + i, base + 1 + (i + 1) % n]);
            self.body.push(body);
        }
        self
    }

    pub fn gravity(&mut self, name: &str, force: Point) -> &mut Self {
        let body = self.body(name);
        self.bodies[body].body_force = force.into();
        self
    }

    pub fn clamp(&mut self, name: &str, line: [Point; 2]) -> &mut Self {
        let body = self.body(name);
        self.clamped.push((body, line));
        self
    }

    pub fn roller(&mut self, name: &str, line: [Point; 2]) -> &mut Self {
        let body = self.body(name);
        self.rollers.push((body, line));
        self
    }

    /// Traction, linear from `values[0]` at `line[0]` to `values[1]` at `line[1]`.
    pub fn load(&mut self, name: &str, line: [Point; 2], values: [Point; 2]) -> &mut Self {
        let body = self.body(name);
        self.tractions.push((body, line, values));
        self
    }

    /// Traction of one value along `line`.
    pub fn push(&mut self, name: &str, line: [Point; 2], value: Point) -> &mut Self {
        self.load(name, line, [value, value])
    }

    pub fn contact(&mut self, first: &str, second: &str, line: [Point; 2]) -> &mut Self {
        let pair = (self.body(first), Some(self.body(second)), line);
        self.contacts.push(pair);
        self
    }

    pub fn rigid(&mut self, first: &str, line: [Point; 2]) -> &mut Self {
        let pair = (self.body(first), None, line);
        self.contacts.push(pair);
        self
    }

    pub fn problem(&self) -> Problem {
        let mut index = HashMap::new();
        let mut edges: Vec<Edge> = Vec::new();
        let triangle_edges = (self.triangles.iter().enumerate())
            .map(|(t, v)| {
                [0, 1, 2].map(|i| {
                    let [a, b] = [v[(i + 1) % 3], v[(i + 2) % 3]];
                    let e = *index.entry((a.min(b), a.max(b))).or_insert(edges.len());
                    match edges.get_mut(e) {
                        Some(edge) => edge.triangles[1] = Some(t),
                        None => edges.push(Edge { vertices: [a, b], triangles: [Some(t), None], name: None }),
                    }
                    e
                })
            })
            .collect();
        let mesh = Triangulation {
            points: self.points.clone(),
            triangles: self.triangles.clone(),
            body: self.body.clone(),
            edges,
            triangle_edges,
            names: Vec::new(),
            cells: crate::mesh::FileCells::default(),
        };
        let boundary = |body: usize, line: [Point; 2]| -> Vec<usize> {
            let on = |e: &usize| {
                let edge = &mesh.edges[*e];
                let ends = edge.vertices.map(|v| fraction(mesh.points[v], line));
                edge.is_boundary()
                    && edge.triangles[0].is_some_and(|t| mesh.body[t] == body)
                    && ends.iter().all(Option::is_some)
            };
            let all: Vec<_> = (0..mesh.edges.len()).filter(on).collect();
            assert!(!all.is_empty(), "no edge of body {body} on {line:?}");
            all
        };
        let mut conditions: Vec<_> = (mesh.edges.iter())
            .map(|edge| if edge.is_boundary() { Condition::Traction([[0.0; 2]; 2]) } else { Condition::Interior })
            .collect();
        for (body, line) in &self.clamped {
            boundary(*body, *line).into_iter().for_each(|e| conditions[e] = Condition::Clamped([[0.0; 2]; 2]));
        }
        for (body, line) in &self.rollers {
            boundary(*body, *line).into_iter().for_each(|e| {
                conditions[e] = Condition::Roller { direction: mesh.edge_frame(e).1, displacement: 0.0 };
            });
        }
        for (body, line, [p, q]) in &self.tractions {
            for e in boundary(*body, *line) {
                let Condition::Traction(values) = &mut conditions[e] else { panic!("edge {e} is not free") };
                for (value, v) in values.iter_mut().zip(mesh.edges[e].vertices) {
                    let s = fraction(mesh.points[v], *line).unwrap();
                    *value = [0, 1].map(|i| value[i] + (1.0 - s) * p[i] + s * q[i]);
                }
            }
        }
        let mut interfaces = Vec::new();
        for (body, other, line) in &self.contacts {
            let mut pairs: Vec<_> = (boundary(*body, *line).into_iter())
                .map(|e| {
                    let [a, b] = mesh.edges[e].vertices;
                    let key = |v: usize| fraction(mesh.points[v], *line).unwrap();
                    let first = if key(a) < key(b) { [a, b] } else { [b, a] };
                    let (length, normal) = mesh.edge_frame(e);
                    let partner = other.map(|other| {
                        let close = |v: usize, w: usize| {
                            let (x, y) = (mesh.points[v], mesh.points[w]);
                            (x[0] - y[0]).hypot(x[1] - y[1]) < 1e-9 * length
                        };
                        let mut facing = boundary(other, *line).into_iter();
                        let found = facing.find(|f| {
                            let [c, d] = mesh.edges[*f].vertices;
                            close(a, d) && close(b, c)
                        });
                        let f = found.expect("contact sides coincide");
                        let [c, d] = mesh.edges[f].vertices;
                        (f, if first[0] == a { [d, c] } else { [c, d] })
                    });
                    let (edges, second) = ([Some(e), partner.map(|p| p.0)], partner.map(|p| p.1));
                    let direction = Direction::constant(normal);
                    ContactPair {
                        edges,
                        first,
                        second,
                        normal,
                        direction,
                        length,
                        arc: first.map(key),
                        gap: [0.0; 2],
                        bow: Bow::default(),
                        friction: None,
                        stiffness: None,
                    }
                })
                .collect();
            pairs.sort_by(|p, q| p.arc[0].total_cmp(&q.arc[0]));
            for (pair, it) in pairs.iter().enumerate() {
                for (side, e) in it.edges.iter().enumerate() {
                    if let Some(e) = e {
                        conditions[*e] = Condition::Contact { interface: interfaces.len(), pair, side };
                    }
                }
            }
            let second = other.map_or("rigid", |b| &self.bodies[b].name);
            interfaces.push(Interface { name: format!("{}|{second}", self.bodies[*body].name), pairs, centre: None });
        }
        let source = MeshSource::File("test.msh".into());
        let draft = Draft { bodies: self.bodies.clone(), ..Draft::new("test", Kinematics::PlaneStrain, source) };
        let scene = Scene::unchecked(draft);
        Problem {
            scene,
            mesh,
            conditions,
            interfaces,
            beds: Vec::new(),
            notes: Vec::new(),
            refinement: Default::default(),
            counted: Default::default(),
            uncut: None,
        }
    }
}

/// Where `p` lies along the segment `line`, if it does.
fn fraction(p: Point, [a, b]: [Point; 2]) -> Option<f64> {
    let d = [b[0] - a[0], b[1] - a[1]];
    let r = [p[0] - a[0], p[1] - a[1]];
    let square = d[0] * d[0] + d[1] * d[1];
    let s = (d[0] * r[0] + d[1] * r[1]) / square;
    let off = (d[0] * r[1] - d[1] * r[0]).abs() / square;
    (off < 1e-9 && (-1e-9..1.0 + 1e-9).contains(&s)).then_some(s)
}

/// The whole scene turned by `angle`, its lengths times `length`, then moved by `shift`; tractions times `force`.
pub fn transformed(mut problem: Problem, angle: f64, length: f64, force: f64, shift: Point) -> Problem {
    let (sin, cos) = angle.sin_cos();
    let turn = |[x, y]: Point| [cos * x - sin * y, sin * x + cos * y];
    for p in &mut problem.mesh.points {
        let [x, y] = turn(*p);
        *p = [length * x + shift[0], length * y + shift[1]];
    }
    for body in &mut problem.scene.draft.bodies {
        body.body_force = turn(body.body_force.given().value).map(|f| f * force / length).into();
    }
    for condition in &mut problem.conditions {
        match condition {
            Condition::Traction(values) => *values = values.map(|p| turn(p).map(|f| f * force)),
            Condition::Roller { direction, .. } => *direction = turn(*direction),
            _ => {}
        }
    }
    for pair in problem.interfaces.iter_mut().flat_map(|interface| &mut interface.pairs) {
        pair.normal = turn(pair.normal);
        pair.direction.ends = pair.direction.ends.map(turn);
        pair.length *= length;
        pair.arc = pair.arc.map(|s| s * length);
    }
    problem
}

/// A problem with vertices, triangles and edges numbered backwards.
pub fn renumbered(mut problem: Problem) -> Problem {
    let (nv, nt, ne) = (problem.mesh.points.len(), problem.mesh.triangles.len(), problem.mesh.edges.len());
    let (vertex, triangle, edge) = (|v: usize| nv - 1 - v, |t: usize| nt - 1 - t, |e: usize| ne - 1 - e);
    let mesh = &mut problem.mesh;
    mesh.points.reverse();
    mesh.triangles.reverse();
    mesh.body.reverse();
    mesh.triangle_edges.reverse();
    mesh.edges.reverse();
    problem.conditions.reverse();
    mesh.triangles.iter_mut().for_each(|t| *t = t.map(vertex));
    mesh.triangle_edges.iter_mut().for_each(|t| *t = t.map(edge));
    for e in &mut mesh.edges {
        e.vertices = e.vertices.map(vertex);
        e.triangles = e.triangles.map(|t| t.map(triangle));
    }
    for pair in problem.interfaces.iter_mut().flat_map(|interface| &mut interface.pairs) {
        pair.edges = pair.edges.map(|e| e.map(edge));
        pair.first = pair.first.map(vertex);
        pair.second = pair.second.map(|s| s.map(vertex));
    }
    problem
}
