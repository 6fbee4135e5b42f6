//! Problems for tests, built by hand: rectangles of squares cut along alternating diagonals.

#![allow(dead_code)]

pub mod blocks;

use std::collections::HashMap;

use hypercircle::mesh::{Edge, Triangulation};
use hypercircle::problem::{Bow, Condition, ContactPair, Direction, Interface, Problem};
use hypercircle::scene::{Body, Draft, Kinematics, MeshSource, Scene};

/// The condition on a named side.
#[derive(Clone, Copy)]
pub enum Role {
    Clamped([f64; 2]),
    Roller,
    /// P(x, y).
    Load(fn([f64; 2]) -> [f64; 2]),
}

type Gap = fn(f64) -> f64;

/// A problem in the making. The sides of body `b` are called `b.bottom`, `b.right`, `b.top`, `b.left`.
pub struct Setup {
    bodies: Vec<Body>,
    points: Vec<[f64; 2]>,
    triangles: Vec<([usize; 3], usize)>,
    sides: HashMap<[usize; 2], String>,
    roles: HashMap<String, Role>,
    contacts: Vec<(String, Option<String>, Gap)>,
    pub kinematics: Kinematics,
}

impl Default for Setup {
    fn default() -> Self {
        Setup {
            bodies: Vec::new(),
            points: Vec::new(),
            triangles: Vec::new(),
            sides: HashMap::new(),
            roles: HashMap::new(),
            contacts: Vec::new(),
            kinematics: Kinematics::PlaneStrain,
        }
    }
}

impl Setup {
    /// Adds a rectangle of n × n cells.
    pub fn rectangle(self, name: &str, lower: [f64; 2], upper: [f64; 2], n: usize) -> Self {
        self.material(name, lower, upper, [n, n], 1.0, 0.3, [0.0; 2])
    }

    /// Adds a rectangle of `cells` cells with its material and body force.
    #[allow(clippy::too_many_arguments)]
    pub fn material(
        mut self,
        name: &str,
        lower: [f64; 2],
        upper: [f64; 2],
        cells: [usize; 2],
        young: f64,
        poisson: f64,
        body_force: [f64; 2],
    ) -> Self {
        let body = self.bodies.len();
        self.bodies.push(Body { body_force: body_force.into(), ..Body::isotropic(name, young, poisson) });
        let first = self.points.len();
        let [nx, ny] = cells;
        let lerp = |c: usize, i: usize, n: usize| lower[c] + (upper[c] - lower[c]) * i as f64 / n as f64;
        for j in 0..=ny {
            self.points.extend((0..=nx).map(|i| [lerp(0, i, nx), lerp(1, j, ny)]));
        }
        let v = |i: usize, j: usize| first + j * (nx + 1) + i;
        for j in 0..ny {
            for i in 0..nx {
                let [a, b, c, d] = [v(i, j), v(i + 1, j), v(i + 1, j + 1), v(i, j + 1)];
                let two = if (i + j) % 2 == 0 { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] };
                self.triangles.extend(two.map(|t| (t, body)));
            }
        }
        let mut side = |a: usize, b: usize, which: &str| {
            self.sides.insert([a.min(b), a.max(b)], format!("{name}.{which}"));
        };
        for i in 0..nx {
            side(v(i, 0), v(i + 1, 0), "bottom");
            side(v(i, ny), v(i + 1, ny), "top");
        }
        for j in 0..ny {
            side(v(0, j), v(0, j + 1), "left");
            side(v(nx, j), v(nx, j + 1), "right");
        }
        self
    }

    /// Sets the condition on a side.
    pub fn on(mut self, side: &str, role: Role) -> Self {
        self.roles.insert(side.into(), role);
        self
    }

    /// Adds a contact with gap g(s), s from the end of the first side that comes first in (x, y) order.
    pub fn contact(mut self, first: &str, second: Option<&str>, gap: Gap) -> Self {
        self.contacts.push((first.into(), second.map(Into::into), gap));
        self
    }

    /// Moves every point; the map must keep triangles counter-clockwise.
    pub fn map(mut self, f: impl Fn([f64; 2]) -> [f64; 2]) -> Self {
        self.points.iter_mut().for_each(|p| *p = f(*p));
        self
    }

    /// Sets the gap of all contacts.
    pub fn gap(mut self, gap: Gap) -> Self {
        self.contacts.iter_mut().for_each(|c| c.2 = gap);
        self
    }

    /// Cuts out the triangles whose centroid lies where `hole` says.
    pub fn without(mut self, hole: impl Fn([f64; 2]) -> bool) -> Self {
        let points = &self.points;
        self.triangles.retain(|(v, _)| {
            let centroid = [0, 1].map(|c| v.iter().map(|&i| points[i][c]).sum::<f64>() / 3.0);
            !hole(centroid)
        });
        self
    }

    pub fn build(self) -> Problem {
        let Setup { bodies, points, triangles, sides, roles, contacts, kinematics } = self;
        let mut edges: Vec<Edge> = Vec::new();
        let mut seen: HashMap<[usize; 2], usize> = HashMap::new();
        let mut triangle_edges = Vec::new();
        for (t, (v, _)) in triangles.iter().enumerate() {
            triangle_edges.push([0, 1, 2].map(|i| {
                let (a, b) = (v[(i + 1) % 3], v[(i + 2) % 3]);
                match seen.get(&[a.min(b), a.max(b)]) {
                    Some(&e) => {
                        edges[e].triangles[1] = Some(t);
                        e
                    }
                    None => {
                        edges.push(Edge { vertices: [a, b], triangles: [Some(t), None], name: None });
                        seen.insert([a.min(b), a.max(b)], edges.len() - 1);
                        edges.len() - 1
                    }
                }
            }));
        }
        let name = |e: usize| {
            let [a, b] = edges[e].vertices;
            sides.get(&[a.min(b), a.max(b)]).map_or("", String::as_str)
        };
        let mut conditions: Vec<Condition> = (0..edges.len())
            .map(|e| match roles.get(name(e)) {
                _ if !edges[e].is_boundary() => Condition::Interior,
                None => Condition::Traction([[0.0; 2]; 2]),
                Some(Role::Clamped(u)) => Condition::Clamped([*u; 2]),
                Some(Role::Roller) => {
                    Condition::Roller { direction: outward(&points, edges[e].vertices), displacement: 0.0 }
                }
                Some(Role::Load(p)) => Condition::Traction(edges[e].vertices.map(|v| p(points[v]))),
            })
            .collect();
        let close = |a: usize, b: usize| {
            let (p, q) = (points[a], points[b]);
            (p[0] - q[0]).abs() + (p[1] - q[1]).abs() < 1e-9
        };
        let before = |a: usize, b: usize| points[a].partial_cmp(&points[b]).unwrap().is_lt();
        let mut interfaces = Vec::new();
        for (interface, (first, second, gap)) in contacts.iter().enumerate() {
            let mut own: Vec<(usize, [usize; 2])> = (0..edges.len())
                .filter(|&e| name(e) == first)
                .map(|e| {
                    let [a, b] = edges[e].vertices;
                    (e, if before(a, b) { [a, b] } else { [b, a] })
                })
                .collect();
            own.sort_by(|a, b| points[a.1[0]].partial_cmp(&points[b.1[0]]).unwrap());
            let mut arc = 0.0;
            let mut pairs = Vec::new();
            for (pair, (e, ends)) in own.into_iter().enumerate() {
                let [a, b] = edges[e].vertices.map(|v| points[v]);
                let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
                let length = dx.hypot(dy);
                let matched = second.as_ref().map(|second| {
                    (0..edges.len())
                        .filter(|&o| name(o) == second)
                        .find_map(|o| {
                            let [c, d] = edges[o].vertices;
                            match (close(c, ends[0]) && close(d, ends[1]), close(d, ends[0]) && close(c, ends[1])) {
                                (true, _) => Some((o, [c, d])),
                                (_, true) => Some((o, [d, c])),
                                _ => None,
                            }
                        })
                        .expect("contact sides coincide")
                });
                conditions[e] = Condition::Contact { interface, pair, side: 0 };
                if let Some((o, _)) = matched {
                    conditions[o] = Condition::Contact { interface, pair, side: 1 };
                }
                pairs.push(ContactPair {
                    edges: [Some(e), matched.map(|m| m.0)],
                    first: ends,
                    second: matched.map(|m| m.1),
                    normal: [dy / length, -dx / length],
                    direction: Direction::constant([dy / length, -dx / length]),
                    length,
                    arc: [arc, arc + length],
                    gap: [gap(arc), gap(arc + length)],
                    bow: Bow::default(),
                    friction: None,
                    stiffness: None,
                });
                arc += length;
            }
            let name = format!("{first}|{}", second.as_deref().unwrap_or("rigid"));
            interfaces.push(Interface { name, pairs, centre: None });
        }
        let draft = Draft { bodies, ..Draft::new("test", kinematics, MeshSource::File("made".into())) };
        let scene = Scene::new(draft).expect("a valid scene");
        let (triangles, body) = triangles.into_iter().unzip();
        let mesh = Triangulation {
            points,
            triangles,
            body,
            edges,
            triangle_edges,
            names: Vec::new(),
            cells: Default::default(),
        };
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

/// Two unit blocks; the right one clamped, the left one on a roller, pressed and tilted by `load`.
pub fn two_blocks(n: usize, load: fn([f64; 2]) -> [f64; 2]) -> Setup {
    Setup::default()
        .rectangle("left", [0.0, 0.0], [1.0, 1.0], n)
        .rectangle("right", [1.0, 0.0], [2.0, 1.0], n)
        .on("left.left", Role::Load(load))
        .on("left.bottom", Role::Roller)
        .on("right.right", Role::Clamped([0.0; 2]))
        .contact("left.right", Some("right.left"), |_| 0.0)
}

/// Two blocks with traction (4 − 7y, 0): the upper part of the contact opens.
pub fn lift_off(n: usize) -> Problem {
    two_blocks(n, |[_, y]| [4.0 - 7.0 * y, 0.0]).build()
}

/// Two blocks with traction (1.5 − 1.8y, 0): the contact stays closed.
pub fn pressed(n: usize) -> Problem {
    two_blocks(n, |[_, y]| [1.5 - 1.8 * y, 0.0]).build()
}

/// The unit vector to the right of the way from `a` to `b`, which is out of the triangle on its left.
fn outward(points: &[[f64; 2]], [a, b]: [usize; 2]) -> [f64; 2] {
    let [dx, dy] = [0, 1].map(|c| points[b][c] - points[a][c]);
    let length = dx.hypot(dy);
    [dy / length, -dx / length]
}
