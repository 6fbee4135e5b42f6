//! A part in a file, from this program to the process that makes it: lists of numbers, and nothing that this program has not
//! written itself.

use std::io::{self, Read, Write};

use super::numbers::{Reader, Writer, grouped};
use super::traffic::Traffic;
use super::{Found, Part};
use crate::bounds::upper::admissible::holds::{Hold, Holds};
use crate::bounds::upper::relaxation::groups::Group;
use crate::elasticity::{Elasticity, Initial, NUMBERS};
use crate::element::{SideValues, StressField};
use crate::load::{Affine, BodyForce, Rotation};
use crate::mesh::{Edge, FileCells, Triangulation};
use crate::problem::{Bow, Condition, ContactPair, Counted, Direction, Interface, Problem, Refinement};
use crate::scene::{Body, Draft, Kinematics, MeshSource, Scene};

impl Part {
    /// Writes it.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write(&self, out: impl Write) -> io::Result<()> {
        let mut out = Writer(out);
        write_scene(&mut out, &self.problem.scene)?;
        write_mesh(&mut out, &self.problem.mesh)?;
        write_conditions(&mut out, &self.problem.conditions)?;
        write_contacts(&mut out, &self.problem.interfaces)?;
        write_holds(&mut out, &self.holds.vertices)?;
        write_holds(&mut out, self.holds.edges.as_flattened())?;
        out.indices((0..self.stress.len()).map(|t| self.stress.degree(t)))?;
        out.numbers(self.stress.values().iter().flatten().copied())?;
        out.indices(self.moments.iter().map(<[_]>::len))?;
        out.vectors(self.moments.values())?;
        out.vectors(self.like.iter().flatten())?;
        out.lists(self.groups.iter().map(|group| &group.vertices[..]))?;
        out.lists(self.groups.iter().map(|group| &group.triangles[..]))?;
        out.lists(self.fronts.iter().map(Vec::as_slice))?;
        out.numbers([self.size])?;
        out.indices(self.own_triangles.iter().map(|own| usize::from(*own)))?;
        out.indices(self.own_pairs.iter().map(|own| usize::from(*own)))?;
        out.indices(self.own_nodes.iter().copied())?;
        self.after.iter().chain([&self.all]).try_for_each(|traffic| write_traffic(&mut out, traffic))
    }

    /// Reads one that was written.
    ///
    /// # Errors
    /// Those of `from`, and numbers that are none of a part.
    pub fn read(from: impl Read) -> io::Result<Self> {
        let mut from = Reader(from);
        let problem = Problem {
            scene: read_scene(&mut from)?,
            mesh: read_mesh(&mut from)?,
            conditions: read_conditions(&mut from)?,
            interfaces: read_contacts(&mut from)?,
            // Parts are made of scenes without springs.
            beds: Vec::new(),
            notes: Vec::new(),
            refinement: Refinement::default(),
            counted: Counted::default(),
            uncut: None,
        };
        let vertices = read_holds(&mut from)?;
        let edges = read_holds(&mut from)?.chunks_exact(2).map(|ends| [ends[0], ends[1]]).collect();
        let holds = Holds { vertices, edges };
        let mut stress = StressField::of_degrees(from.indices()?);
        let values = from.vectors()?;
        if values.len() != stress.values().len() {
            return Err(io::ErrorKind::InvalidData.into());
        }
        stress.values_mut().copy_from_slice(&values);
        let (counts, moments) = (from.indices()?, from.vectors()?);
        if counts.iter().sum::<usize>() != moments.len() {
            return Err(io::ErrorKind::InvalidData.into());
        }
        let moments = SideValues::new(counts, moments);
        let like = grouped(&from.vectors::<2>()?)?;
        let (vertices, triangles) = (from.lists()?, from.lists()?);
        let groups = vertices.into_iter().zip(triangles);
        let groups = groups.map(|(vertices, triangles)| Group { vertices, triangles }).collect();
        let fronts = from.lists()?;
        let size = one(from.numbers()?)?;
        let mut yes = || Ok::<_, io::Error>(from.indices()?.into_iter().map(|own| own != 0).collect());
        let (own_triangles, own_pairs) = (yes()?, yes()?);
        let own_nodes = from.indices()?;
        let after = (0..fronts.len()).map(|_| read_traffic(&mut from)).collect::<io::Result<_>>()?;
        let all = read_traffic(&mut from)?;
        Ok(Part {
            problem,
            stress,
            moments,
            holds,
            like,
            groups,
            fronts,
            size,
            own_triangles,
            own_pairs,
            own_nodes,
            after,
            all,
        })
    }
}

impl Found {
    /// Writes it.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write(&self, out: impl Write) -> io::Result<()> {
        let mut out = Writer(out);
        out.vectors(&self.values)?;
        out.vectors(&self.inside)?;
        [&self.lower, &self.upper, &self.triangles, &self.pairs]
            .into_iter()
            .try_for_each(|list| out.numbers(list.iter().copied()))
    }

    /// Reads one that was written.
    ///
    /// # Errors
    /// Those of `from`, and numbers that are none of a result.
    pub fn read(from: impl Read) -> io::Result<Self> {
        let mut from = Reader(from);
        Ok(Found {
            values: from.vectors()?,
            inside: from.vectors()?,
            lower: from.numbers()?,
            upper: from.numbers()?,
            triangles: from.numbers()?,
            pairs: from.numbers()?,
        })
    }
}

fn one<T: Copy>(list: Vec<T>) -> io::Result<T> {
    list.first().copied().ok_or_else(|| io::ErrorKind::InvalidData.into())
}

/// Writes the data of a scene that energies and contact need: materials and loads on bodies.
fn write_scene(out: &mut Writer<impl Write>, scene: &Scene) -> io::Result<()> {
    let kinematics = match scene.kinematics {
        Kinematics::PlaneStrain => 0,
        Kinematics::PlaneStress => 1,
        Kinematics::Axisymmetric => 2,
    };
    out.indices([kinematics])?;
    out.numbers([scene.thickness, scene.origin[0], scene.origin[1]])?;
    out.numbers(scene.bodies.iter().flat_map(|body| body.elasticity.to_numbers()))?;
    out.numbers(scene.bodies.iter().flat_map(|body| body.initial.to_numbers()))?;
    out.numbers(scene.bodies.iter().flat_map(|body| {
        let Affine { value: [fx, fy], gradient: [[xx, xy], [yx, yy]] } = body.body_force.given();
        let rotation = body.body_force.rotation().unwrap_or(Rotation { density: 0.0, omega: 0.0, about: [0.0; 2] });
        let Rotation { density, omega, about: [x, y] } = rotation;
        [fx, fy, xx, xy, yx, yy, density, omega, x, y]
    }))
}

fn read_scene(from: &mut Reader<impl Read>) -> io::Result<Scene> {
    let kinematics = match one(from.indices()?)? {
        0 => Kinematics::PlaneStrain,
        1 => Kinematics::PlaneStress,
        _ => Kinematics::Axisymmetric,
    };
    let [thickness, x, y] = one(from.vectors()?)?;
    let laws: Vec<[f64; NUMBERS]> = from.vectors()?;
    let initial: Vec<[f64; 10]> = from.vectors()?;
    let forces: Vec<[f64; 10]> = from.vectors()?;
    let body = |((law, initial), [fx, fy, xx, xy, yx, yy, density, omega, x, y]): (
        (&[f64; NUMBERS], &[f64; 10]),
        [f64; 10],
    )| {
        let given = BodyForce::affine(Affine { value: [fx, fy], gradient: [[xx, xy], [yx, yy]] });
        let turning = density * omega != 0.0;
        let rotation = Rotation { density, omega, about: [x, y] };
        let body_force = if turning { given.with_rotation(rotation) } else { given };
        let revolved = kinematics == Kinematics::Axisymmetric;
        let body_force = if revolved { body_force.about_line() } else { body_force };
        let elasticity = Elasticity::from_numbers(law).ok_or(io::ErrorKind::InvalidData)?;
        Ok(Body { name: String::new(), elasticity, initial: Initial::from_numbers(initial), body_force })
    };
    let bodies = laws.iter().zip(&initial).zip(forces).map(body).collect::<io::Result<_>>()?;
    let none = MeshSource::Geometry { size: None, polygons: Vec::new() };
    Ok(Scene { draft: Draft { thickness, origin: [x, y], bodies, ..Draft::new("", kinematics, none) } })
}

fn write_mesh(out: &mut Writer<impl Write>, mesh: &Triangulation) -> io::Result<()> {
    out.vectors(&mesh.points)?;
    out.indices(mesh.triangles.iter().flatten().copied())?;
    out.indices(mesh.body.iter().copied())?;
    out.indices(mesh.edges.iter().flat_map(|edge| edge.vertices))?;
    out.some_indices(mesh.edges.iter().flat_map(|edge| edge.triangles))?;
    out.indices(mesh.triangle_edges.iter().flatten().copied())
}

fn read_mesh(from: &mut Reader<impl Read>) -> io::Result<Triangulation> {
    let (points, triangles, body) = (from.vectors()?, from.tuples()?, from.indices()?);
    let (vertices, sides) = (from.tuples()?, grouped(&from.some_indices()?)?);
    let edges = vertices.into_iter().zip(sides);
    Ok(Triangulation {
        points,
        triangles,
        body,
        edges: edges.map(|(vertices, triangles)| Edge { vertices, triangles, name: None }).collect(),
        triangle_edges: from.tuples()?,
        names: Vec::new(),
        cells: FileCells::default(),
    })
}

fn write_conditions(out: &mut Writer<impl Write>, conditions: &[Condition]) -> io::Result<()> {
    let told = |condition: &Condition| match *condition {
        Condition::Interior => ([0; 4], [0.0; 4]),
        Condition::Axis => ([9, 0, 0, 0], [0.0; 4]),
        Condition::Traction([a, b]) => ([1, 0, 0, 0], [a[0], a[1], b[0], b[1]]),
        Condition::Clamped([a, b]) => ([2, 0, 0, 0], [a[0], a[1], b[0], b[1]]),
        Condition::Roller { direction: [x, y], displacement } => ([3, 0, 0, 0], [x, y, displacement, 0.0]),
        Condition::Contact { interface, pair, side } => ([4, interface, pair, side], [0.0; 4]),
        Condition::Elastic { bed, pair, side } => ([5, bed, pair, side], [0.0; 4]),
    };
    out.indices(conditions.iter().flat_map(|condition| told(condition).0))?;
    out.numbers(conditions.iter().flat_map(|condition| told(condition).1))
}

fn read_conditions(from: &mut Reader<impl Read>) -> io::Result<Vec<Condition>> {
    let (kinds, numbers) = (from.tuples()?, from.vectors()?);
    let of = |([kind, interface, pair, side], [a, b, c, d]): ([usize; 4], [f64; 4])| match kind {
        0 => Ok(Condition::Interior),
        9 => Ok(Condition::Axis),
        1 => Ok(Condition::Traction([[a, b], [c, d]])),
        2 => Ok(Condition::Clamped([[a, b], [c, d]])),
        3 => Ok(Condition::Roller { direction: [a, b], displacement: c }),
        4 => Ok(Condition::Contact { interface, pair, side }),
        5 => Ok(Condition::Elastic { bed: interface, pair, side }),
        _ => Err(io::ErrorKind::InvalidData.into()),
    };
    kinds.into_iter().zip(numbers).map(of).collect()
}

fn write_contacts(out: &mut Writer<impl Write>, interfaces: &[Interface]) -> io::Result<()> {
    let pairs = || interfaces.iter().flat_map(|interface| &interface.pairs);
    out.indices(interfaces.iter().map(|interface| interface.pairs.len()))?;
    let second = |pair: &ContactPair| [0, 1].map(|end| pair.second.map(|second| second[end]));
    out.some_indices(pairs().flat_map(|p| p.edges.into_iter().chain(p.first.map(Some)).chain(second(p))))?;
    let direction = |p: &ContactPair| p.direction.ends.into_iter().flatten().chain(p.direction.shares);
    let numbers = |p: &ContactPair| {
        p.normal.into_iter().chain(direction(p)).chain([p.length]).chain(p.arc).chain(p.gap).chain(p.bow.numbers())
    };
    out.numbers(pairs().flat_map(|p| numbers(p).collect::<Vec<_>>()))
}

fn read_contacts(from: &mut Reader<impl Read>) -> io::Result<Vec<Interface>> {
    let counts = from.indices()?;
    let (places, numbers) = (grouped(&from.some_indices()?)?, from.vectors()?);
    let of = |([e, f, a, b, c, d], numbers): ([Option<usize>; 6], [f64; 13 + Bow::NUMBERS])| {
        let [x, y, m, n, o, p, own, other, length, begin, end, g, h, bow @ ..] = numbers;
        Some(ContactPair {
            edges: [e, f],
            first: [a?, b?],
            second: c.zip(d).map(|(c, d)| [c, d]),
            normal: [x, y],
            direction: Direction { ends: [[m, n], [o, p]], shares: [own, other] },
            length,
            arc: [begin, end],
            gap: [g, h],
            bow: Bow::from_numbers(bow)?,
            // Ranks share no scene that has friction.
            friction: None,
            stiffness: None,
        })
    };
    let pairs: Option<Vec<ContactPair>> = places.into_iter().zip(numbers).map(of).collect();
    let mut pairs = pairs.ok_or(io::ErrorKind::InvalidData)?.into_iter();
    Ok(counts
        .into_iter()
        .map(|n| Interface { name: String::new(), pairs: pairs.by_ref().take(n).collect(), centre: None })
        .collect())
}

fn write_holds(out: &mut Writer<impl Write>, holds: &[Hold]) -> io::Result<()> {
    let told = |hold: &Hold| match *hold {
        Hold::Free => (0, [0.0; 3]),
        Hold::Line { normal: [x, y], value } => (1, [x, y, value]),
        Hold::Fixed([x, y]) => (2, [x, y, 0.0]),
    };
    out.indices(holds.iter().map(|hold| told(hold).0))?;
    out.numbers(holds.iter().flat_map(|hold| told(hold).1))
}

fn read_holds(from: &mut Reader<impl Read>) -> io::Result<Vec<Hold>> {
    let (kinds, numbers) = (from.indices()?, from.vectors()?);
    let of = |(kind, [x, y, value]): (usize, [f64; 3])| match kind {
        0 => Ok(Hold::Free),
        1 => Ok(Hold::Line { normal: [x, y], value }),
        2 => Ok(Hold::Fixed([x, y])),
        _ => Err(io::ErrorKind::InvalidData.into()),
    };
    kinds.into_iter().zip(numbers).map(of).collect()
}

fn write_traffic(out: &mut Writer<impl Write>, traffic: &Traffic) -> io::Result<()> {
    for lists in [&traffic.to, &traffic.from] {
        out.indices(lists.iter().map(|(rank, _)| *rank))?;
        out.lists(lists.iter().map(|(_, nodes)| &nodes[..]))?;
    }
    Ok(())
}

fn read_traffic(from: &mut Reader<impl Read>) -> io::Result<Traffic> {
    let mut lists = || Ok::<_, io::Error>(from.indices()?.into_iter().zip(from.lists()?).collect());
    Ok(Traffic { to: lists()?, from: lists()? })
}
