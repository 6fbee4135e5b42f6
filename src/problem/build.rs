//! From scene and mesh to a [`Problem`].

use std::collections::HashMap;
use std::sync::Arc;
use std::time::Duration;

use super::contact::coulomb::inherit_bounds;
use super::contact::curves::{self, beside_long_edges, curved, turned_by_the_mesh};
use super::contact::friction::resist;
use super::contact::normals::{Coarser, inherit, keep_gap, replace, smooth};
use super::contact::pair_up;
use super::contact::softened;
use super::scales::ROUND_OFF;
use super::{Bed, Condition, Counted, Note, Problem, ProblemError, Refinement, polynomial};
use crate::element::Section;
use crate::mesh::MeshError;
use crate::mesh::error::at;
use crate::mesh::files::meshio::PATIENCE;
use crate::mesh::refinement::bisect::{RefinementEdges, bisect};
use crate::mesh::sides::concentric::Concentric;
use crate::mesh::topology::labels::contact_names;
use crate::mesh::{self, Curved, Loaded, Triangulation};
use crate::scene::{Contact, ContactSides, Draft, Kinematics, MeshSource, Normals, Scene, SupportKind, Traction};

/// Bisections of the triangles at the edges of circles until these are even.
const MOST_TO_BE_EVEN: usize = 60;

/// The condition that a boundary name stands for.
#[derive(Clone, Copy)]
enum Role<'a> {
    Support(SupportKind),
    Load(&'a Traction),
    Contact,
}

impl Problem {
    /// Reads or makes the mesh of `scene`, checks it, makes contact sides match, and puts the conditions on it.
    ///
    /// # Errors
    /// Everything that can be wrong with a mesh: [`ProblemError`].
    pub fn load(scene: Scene) -> Result<Problem, ProblemError> {
        Problem::load_within(scene, PATIENCE)
    }

    /// As [`Problem::load`], with a separate time limit for the program that helps to read the mesh file.
    ///
    /// # Errors
    /// As [`Problem::load`].
    pub fn load_within(scene: Scene, limit: Duration) -> Result<Problem, ProblemError> {
        let Loaded { scene, mesh, notes, uncut } = mesh::load(scene, limit)?;
        Ok(Problem { uncut: uncut.map(Arc::new), ..Problem::new(scene, mesh, notes)? })
    }

    /// The problem to refine to a tolerance, by a `load` that the caller has: on the coarsest mesh that represents `scene`,
    /// whose `geometry.size` is not used then; with that size where the direction of a contact comes from the normals of the
    /// mesh, which on a coarser one would be another field, and with it another problem. A note says which.
    ///
    /// # Errors
    /// Those of `load`.
    pub fn to_refine<E>(scene: &Scene, load: impl Fn(Scene) -> Result<Problem, E>) -> Result<Problem, E> {
        let mut problem = load(scene.coarsest())?;
        let MeshSource::Geometry { size: Some(size), .. } = scene.mesh else { return Ok(problem) };
        let text = if let Some(contact) = turned_by_the_mesh(&problem) {
            let contact = problem.scene.contacts[contact].name();
            problem = load(scene.clone())?;
            format!(
                "geometry.size = {size} was kept: contact {contact} turns along edges that stand for no arc, and on a coarser \
                 mesh its direction would be another."
            )
        } else {
            format!(
                "geometry.size = {size} was not used: refinement to a tolerance starts from the coarsest mesh that \
                 represents the scene."
            )
        };
        problem.notes.push(Note { weakens_guarantee: false, text });
        Ok(problem)
    }

    /// The problem on its mesh before contact cut it, without its contacts; `None` where contact changed nothing.
    ///
    /// # Errors
    /// Bonds whose sides did not match before.
    pub fn before_contact(&self) -> Result<Option<Problem>, ProblemError> {
        let Some(uncut) = &self.uncut else { return Ok(None) };
        let mesh = mesh::bonded(uncut.mesh.clone(), &self.scene)?;
        let draft = Draft { contacts: Vec::new(), ..(*self.scene).clone() };
        Problem::new(Scene::unchecked(draft), mesh, Vec::new()).map(Some)
    }

    /// Puts the conditions of `scene` on a mesh whose contact sides match bit for bit. `notes` says how the mesh was
    /// made; remarks about the data are added to it.
    ///
    /// # Errors
    /// Contact sides that do not match; a boundary with two conditions.
    pub fn new(scene: Scene, mesh: Triangulation, notes: Vec<Note>) -> Result<Problem, ProblemError> {
        Problem::with_directions(scene, mesh, notes, None)
    }

    /// [`Problem::new`], with the directions of contact of a `coarser` mesh where there is one.
    fn with_directions(
        scene: Scene,
        mut mesh: Triangulation,
        mut notes: Vec<Note>,
        coarser: Option<&Coarser>,
    ) -> Result<Problem, ProblemError> {
        let section = section(&scene);
        put_on_axis(&mut mesh, section);
        on_axis(&scene, &mesh, section)?;
        let roles = roles(&scene);
        let mut conditions: Vec<Condition> = (0..mesh.edges.len())
            .map(|e| {
                let edge = &mesh.edges[e];
                let role = edge.name.and_then(|n| roles.get(mesh.names[n].as_str()));
                match role {
                    _ if !edge.is_boundary() => Condition::Interior,
                    _ if edge.vertices.iter().all(|v| section.on_axis(mesh.points[*v])) => Condition::Axis,
                    Some(Role::Support(SupportKind::Clamped { displacement })) => {
                        Condition::Clamped(edge.vertices.map(|v| displacement.at(mesh.points[v])))
                    }
                    Some(Role::Support(SupportKind::Roller { direction, displacement })) => Condition::Roller {
                        direction: direction.unwrap_or_else(|| mesh.edge_frame(e).1),
                        displacement: *displacement,
                    },
                    Some(Role::Load(load)) => Condition::Traction(polynomial::ends(&scene, &mesh, e, load)),
                    // Edges of contacts and springs are overwritten when they are paired.
                    Some(Role::Contact | Role::Support(SupportKind::Spring { .. })) | None => {
                        Condition::Traction([[0.0; 2]; 2])
                    }
                }
            })
            .collect();
        let mut interfaces = Vec::with_capacity(scene.contacts.len());
        let mut remarks = Vec::new();
        for (interface, contact) in scene.contacts.iter().enumerate() {
            let centre = match coarser {
                None => rays(contact, &mesh),
                Some(coarser) => coarser.interfaces.get(interface).and_then(|coarse| coarse.centre),
            };
            let mut matched = pair_up(contact, &scene, &mesh, centre, &mut remarks)?;
            if let Some(coarser) = coarser.filter(|coarser| coarser.refinement == Refinement::KeepsEdges) {
                keep_gap(&mut matched.pairs, coarser, interface);
                if contact.obstacle.is_some() {
                    inherit(&mut matched.pairs, &mesh.points, coarser, interface);
                }
            }
            if contact.normals == Normals::Smooth && contact.direction.is_none() && contact.obstacle.is_none() {
                match coarser {
                    None if centre.is_some() => {}
                    None => smooth(&mut matched.pairs),
                    Some(coarser) => inherit(&mut matched.pairs, &mesh.points, coarser, interface),
                }
                // Parts of an edge lie as far from the curve as the whole.
                if coarser.is_none_or(|coarser| !coarser.curved.is_empty()) {
                    replace(&mut notes, &matched);
                }
            }
            resist(contact, (&mesh, section), &mut matched, &mut remarks);
            if let (Some(_), Some(coarser)) = (contact.coefficient, coarser) {
                inherit_bounds(&mut matched.pairs, (&mesh, section), coarser, interface);
            }
            for (pair, matched) in matched.pairs.iter().enumerate() {
                for (side, edge) in matched.edges.iter().enumerate() {
                    if let Some(edge) = edge {
                        conditions[*edge] = Condition::Contact { interface, pair, side };
                    }
                }
            }
            softened::refuse(contact, &matched, &mesh)?;
            interfaces.push(matched);
        }
        let beds = beds(&scene, &mesh)?;
        for (bed, of) in beds.iter().enumerate() {
            for (pair, edges) in of.pairs.iter().enumerate() {
                edges.sides().for_each(|(side, e)| conditions[e] = Condition::Elastic { bed, pair, side });
            }
        }
        for remark in remarks {
            if !notes.contains(&remark) {
                notes.push(remark);
            }
        }
        let refinement = coarser.map_or_else(Refinement::default, |coarser| coarser.refinement);
        let mut problem = Problem {
            scene,
            mesh,
            conditions,
            interfaces,
            beds,
            notes,
            refinement,
            counted: Counted::Nearest,
            uncut: None,
        };
        let remarks = polynomial::remarks(&problem);
        problem.notes.retain(|note| !polynomial::is_remark(note));
        problem.notes.extend(remarks);
        curves::remark(&mut problem);
        Ok(problem)
    }

    /// This problem after `n` uniform refinements, each of which cuts every triangle into four.
    ///
    /// # Errors
    /// None that [`Problem::new`] did not have, unless the mesh outgrows the index range.
    pub fn refine_uniform(&self, n: usize) -> Result<Problem, ProblemError> {
        let mut problem = self.clone();
        for _ in 0..n {
            let curved = curved(&problem);
            let mesh = problem.mesh.quartered(&curved);
            problem = problem.divided(mesh, &curved)?;
        }
        Ok(problem)
    }

    /// The problem on a mesh whose edges are those of this one, divided once at most, those in `curved` on their circles.
    fn divided(&self, mesh: Triangulation, curved: &Curved) -> Result<Problem, ProblemError> {
        let coarser = Coarser {
            interfaces: &self.interfaces,
            vertices: self.mesh.points.len(),
            curved,
            refinement: self.refinement,
        };
        Problem::with_directions(self.scene.clone(), mesh, self.notes.clone(), Some(&coarser))
    }

    /// True if gaps and prescribed displacements vanish: the admissible set K is then a cone, and a(u, u) + ∫ τ̄ |u_t' − u_t''| = L(u),
    /// the integral over contacts with friction.
    pub fn is_cone(&self) -> bool {
        let elastic = self.bed_pairs().filter_map(|(pair, _)| pair.contact);
        let no_gap = self.pairs().all(|p| p.gap == [0.0; 2] && p.bow.is_none())
            && elastic.into_iter().all(|contact| contact.gap().iter().all(|g| *g == 0.0));
        no_gap && !self.conditions.iter().any(Condition::is_moved)
    }

    /// True if −2𝓛(u) is the work of the loads: nothing is prescribed, no gap closes, and neither friction nor initial strains take part.
    pub fn only_loads_work(&self) -> bool {
        self.is_cone() && !self.has_friction() && self.scene.bodies.iter().all(|body| body.initial.is_none())
    }

    /// True if the direction of contact turns along any edge.
    pub fn contact_turns(&self) -> bool {
        self.pairs().any(|pair| !pair.direction.is_constant())
    }

    /// True if what contact asks of a linear displacement between vertices is more than it asks there: its direction turns along edges, or
    /// gaps are curved.
    pub fn jumps_bend(&self) -> bool {
        self.contact_turns() || self.pairs().any(|pair| !pair.bow.is_none())
    }

    /// True if the direction of contact varies along any contact, on one edge or from edge to edge.
    pub fn contact_bends(&self) -> bool {
        const STRAIGHT: f64 = 1e-9;
        self.interfaces.iter().any(|interface| {
            let directions = interface.pairs.iter().flat_map(|pair| [pair.direction.at(0.0), pair.direction.at(1.0)]);
            let mut from = directions.clone();
            from.next().is_some_and(|[x, y]| directions.clone().any(|[a, b]| (x * b - y * a).abs() > STRAIGHT))
        })
    }

    /// True if refinement puts new vertices on the curves that edges stand for.
    pub fn follows_curves(&self) -> bool {
        !curved(self).is_empty()
    }

    /// The edges of the two sides of all contacts between bodies, and of all layers, facing each other.
    pub fn facing_edges(&self) -> Vec<[usize; 2]> {
        let contacts = self.pairs().filter_map(|pair| Some([pair.edges[0]?, pair.edges[1]?]));
        let layers = self.bed_pairs().filter_map(|(pair, _)| Some([pair.edge, pair.opposite?]));
        contacts.chain(layers).collect()
    }

    /// Bisects the triangles `marked` of this problem, and those whose bisection this requires, see [`bisect`]. Also returns the
    /// refinement edges of the new triangles, and for each new triangle the old one it comes from.
    ///
    /// # Errors
    /// None that [`Problem::new`] did not have.
    pub fn bisect(
        &self,
        refinement: &RefinementEdges,
        marked: &[usize],
    ) -> Result<(Problem, RefinementEdges, Vec<usize>), ProblemError> {
        let (mut problem, mut refinement, mut parent) = self.bisected(refinement, marked)?;
        if self.refinement == Refinement::FollowsCurvesEvenly {
            for _ in 0..MOST_TO_BE_EVEN {
                let long = beside_long_edges(&problem);
                if long.is_empty() {
                    break;
                }
                let (finer, edges, within) = problem.bisected(&refinement, &long)?;
                parent = within.into_iter().map(|t| parent[t]).collect();
                (problem, refinement) = (finer, edges);
            }
        }
        Ok((problem, refinement, parent))
    }

    fn bisected(
        &self,
        refinement: &RefinementEdges,
        marked: &[usize],
    ) -> Result<(Problem, RefinementEdges, Vec<usize>), ProblemError> {
        let curved = curved(self);
        let finer = bisect(&self.mesh, refinement, marked, &self.facing_edges(), &curved);
        let problem = self.divided(finer.mesh, &curved)?;
        Ok((problem, finer.refinement, finer.parent))
    }
}

/// Puts points on the axis of revolution that rounding keeps from it: the cosine of a right angle is 6e-17.
fn put_on_axis(mesh: &mut Triangulation, section: Section) {
    let Section::Revolved { axis } = section else { return };
    let radius = mesh.points.iter().fold(0.0_f64, |m, p| m.max(section.weight(*p).abs()));
    let near = mesh.points.iter_mut().filter(|p| section.weight(**p).abs() <= ROUND_OFF * radius);
    near.for_each(|p| p[0] = axis);
}

/// Refuses points beyond the axis of revolution, and conditions on it that cannot be.
fn on_axis(scene: &Scene, mesh: &Triangulation, section: Section) -> Result<(), ProblemError> {
    if !section.is_revolved() {
        return Ok(());
    }
    if let Some(point) = mesh.points.iter().find(|p| section.weight(**p) < 0.0) {
        let what = format!("the point {} lies beyond the axis of revolution", at(scene, *point));
        let remedy = "points of an axisymmetric scene are (r, z) with r ≥ 0";
        return Err(MeshError::cells(scene, what, remedy).into());
    }
    only_what_turns(scene, section)?;
    let roles = roles(scene);
    for edge in mesh.edges.iter().filter(|edge| edge.vertices.iter().all(|v| section.on_axis(mesh.points[*v]))) {
        let Some((name, role)) = edge.name.and_then(|n| Some((&mesh.names[n], roles.get(mesh.names[n].as_str())?)))
        else {
            continue;
        };
        let idle = matches!(role, Role::Support(SupportKind::Roller { direction: None, displacement }) if *displacement == 0.0);
        if !idle {
            let what = "lies on the axis of revolution, where nothing can be prescribed";
            return Err(
                MeshError::boundary(scene, name, what, "leave it out: nothing needs to be said on the axis").into()
            );
        }
    }
    Ok(())
}

/// Refuses forces and contacts that bodies of revolution do not have here.
fn only_what_turns(scene: &Scene, section: Section) -> Result<(), ProblemError> {
    let refused = |what: String, remedy: &str| Err(MeshError::cells(scene, what, remedy).into());
    for body in &scene.bodies {
        if !section.carries(&body.body_force) {
            let what =
                format!("the body force of '{}' of revolution varies along z, or its axial part varies", body.name);
            return refused(what, "give F_r as value + gradient · r, and a constant F_z");
        }
    }
    Ok(())
}

/// The section that the plane figure of a scene stands for.
pub(super) fn section(scene: &Scene) -> Section {
    match scene.kinematics {
        Kinematics::Axisymmetric => Section::Revolved { axis: 0.0 - scene.origin[0] },
        Kinematics::PlaneStrain | Kinematics::PlaneStress => Section::Slice,
    }
}

/// The centre of the circles that the sides of a contact lie on, where they are matched along its rays.
fn rays(contact: &Contact, mesh: &Triangulation) -> Option<[f64; 2]> {
    let ContactSides::Between([first, second]) = &contact.sides else { return None };
    let smooth = contact.normals == Normals::Smooth && contact.direction.is_none();
    smooth.then(|| Concentric::of(mesh, [first, second]))?.map(|circles| circles.centre)
}

/// The springs of all supports, then the layers of all bonds.
fn beds(scene: &Scene, mesh: &Triangulation) -> Result<Vec<Bed>, ProblemError> {
    let mut all: Vec<Bed> = scene.supports.iter().filter_map(|support| Bed::of_support(support, mesh)).collect();
    for bond in &scene.bonds {
        all.extend(Bed::of_bond(bond, scene, mesh)?);
    }
    let section = section(scene);
    Ok(all.into_iter().map(|bed| bed.of_section(section, mesh)).collect())
}

/// The role of every boundary that the scene mentions.
fn roles(scene: &Scene) -> HashMap<&str, Role<'_>> {
    let supports = scene.supports.iter().map(|s| (s.on.as_str(), Role::Support(s.kind)));
    let loads = scene.tractions.iter().map(|t| (t.on.as_str(), Role::Load(t)));
    let contacts = contact_names(scene).into_iter().map(|name| (name, Role::Contact));
    // A boundary of a valid scene has one condition.
    supports.chain(loads).chain(contacts).collect()
}
