//! The keywords of a deck that make nodes, elements, sets, surfaces, parts and instances.

use std::collections::HashMap;

use super::DAMAGED;
use super::assembly::{Instance, Position};
use super::element::{Family, family, made_for};
use super::elements::{in_space, of_any_length, rows};
use super::keyword::{Keyword, Line, Place};
use super::remarks::Remarks;
use super::scope::{Cell, Entry, Member, Of, Operation, Patch, Scope, Shapeless, member, members};
use super::side::{LABELS, Label};
use crate::mesh::MeshError;
use crate::scene::Kinematics;

#[derive(Default)]
pub(super) struct Reader {
    /// What stands outside all parts.
    pub assembly: Scope,
    /// Name of the assembly.
    pub name: String,
    pub instances: Vec<Instance>,
    pub remarks: Remarks,
    /// Kinematics that elements are made for, each with the name of one.
    pub made_for: Vec<(Kinematics, String)>,
    /// True if all cells of the deck are rigid.
    all_rigid: bool,
    /// By their names in upper case.
    parts: HashMap<String, Scope>,
    /// The part or instance that is read.
    open: Option<Open>,
}

struct Open {
    scope: Scope,
    what: What,
    place: Place,
}

enum What {
    Part(String),
    Instance { name: String, part: String, position: Position },
}

impl Reader {
    /// A reader of a deck all of whose cells are rigid, or not.
    pub fn new(all_rigid: bool) -> Reader {
        Reader { all_rigid, ..Reader::default() }
    }

    pub fn take(&mut self, keyword: &Keyword) -> Result<(), MeshError> {
        match keyword.name.as_str() {
            "NODE" => self.nodes(keyword),
            "ELEMENT" => self.elements(keyword),
            "NSET" => self.set(keyword, Of::Nodes),
            "ELSET" => self.set(keyword, Of::Elements),
            "SURFACE" => self.surface(keyword),
            "PART" => {
                self.closed()?;
                let what = What::Part(keyword.parameter("NAME").unwrap_or_default().to_ascii_uppercase());
                self.open = Some(Open { scope: Scope::default(), what, place: keyword.place.clone() });
                Ok(())
            }
            "ASSEMBLY" => {
                self.name = keyword.parameter("NAME").unwrap_or_default().to_owned();
                self.closed()
            }
            "INSTANCE" => self.instance(keyword),
            "END PART" | "END INSTANCE" => {
                self.close();
                Ok(())
            }
            "END ASSEMBLY" => self.closed(),
            "NGEN" | "NFILL" | "NCOPY" | "NMAP" | "ELGEN" | "ELCOPY" | "SYSTEM" => {
                let what = format!("*{} makes nodes or elements that the deck does not list", keyword.name);
                Err(keyword.fault(what, "write the deck with all of them listed"))
            }
            _ => Ok(()),
        }
    }

    /// Refuses a part or an instance that has no end.
    pub fn closed(&self) -> Result<(), MeshError> {
        let Some(open) = &self.open else { return Ok(()) };
        let what = match open.what {
            What::Part(_) => "*PART has no *END PART",
            What::Instance { .. } => "*INSTANCE has no *END INSTANCE",
        };
        Err(open.place.fault(what, DAMAGED))
    }

    fn scope(&mut self) -> &mut Scope {
        match &mut self.open {
            Some(open) => &mut open.scope,
            None => &mut self.assembly,
        }
    }

    /// Starts an instance with all of its part, to which it may add nodes, elements and sets of its own.
    fn instance(&mut self, keyword: &Keyword) -> Result<(), MeshError> {
        self.closed()?;
        let part = keyword.parameter("PART").unwrap_or_default().to_ascii_uppercase();
        let Some(scope) = self.parts.get(&part).cloned() else {
            return Err(keyword.fault(format!("there is no *PART '{part}' for this instance"), DAMAGED));
        };
        let name = keyword.required("NAME")?.to_owned();
        let what = What::Instance { name, part, position: Position::read(keyword)? };
        self.open = Some(Open { scope, what, place: keyword.place.clone() });
        Ok(())
    }

    fn close(&mut self) {
        match self.open.take() {
            Some(Open { scope, what: What::Part(name), .. }) => {
                self.parts.insert(name, scope);
            }
            Some(Open { mut scope, what: What::Instance { name, part, position }, place }) => {
                position.apply(&mut scope.mesh);
                self.instances.push(Instance { name, part, scope, place });
            }
            None => {}
        }
    }

    fn nodes(&mut self, keyword: &Keyword) -> Result<(), MeshError> {
        own_lines(keyword)?;
        let system = keyword.parameter("SYSTEM").unwrap_or("R").to_ascii_uppercase();
        if !["R", "C"].contains(&system.as_str()) {
            let what = format!("SYSTEM={system} of *NODE is neither R, rectangular, nor C, cylindrical");
            return Err(keyword.fault(what, "write the nodes in rectangular coordinates"));
        }
        let mesh = &mut self.scope().mesh;
        let mut tags = Vec::new();
        for line in &keyword.lines {
            let tag = line.whole(0)?;
            let coordinate = |i: usize| if i < line.fields.len() { line.number(i) } else { Ok(0.0) };
            let mut point = [coordinate(1)?, coordinate(2)?, coordinate(3)?];
            if system == "C" {
                // The angle is in degrees.
                let ([r, _, _], (sin, cos)) = (point, point[1].to_radians().sin_cos());
                (point[0], point[1]) = (r * cos, r * sin);
            }
            if mesh.nodes.insert(tag, point).is_some_and(|before| before != point) {
                return Err(line.fault(format!("node {tag} is there twice, at two places"), DAMAGED));
            }
            tags.push(tag);
        }
        self.scope().list(Of::Nodes, keyword.parameter("NSET"), &tags, &keyword.place);
        Ok(())
    }

    fn elements(&mut self, keyword: &Keyword) -> Result<(), MeshError> {
        own_lines(keyword)?;
        let name = keyword.required("TYPE")?;
        let family = family(name);
        let shape = match family {
            Family::Plane(kind, count) => Some((kind, count, false)),
            Family::Shell(kind, count) => Some((kind, count, true)),
            Family::Rigid(kind, count) if self.all_rigid => Some((kind, count, true)),
            Family::Rigid(..) => {
                self.remarks.rigid_cells(name);
                None
            }
            Family::Idle | Family::Shapeless => {
                self.remarks.left_out(name);
                None
            }
            Family::Space => return Err(in_space(keyword, name)),
            Family::Unknown => {
                let what = format!("elements {name} are not known");
                let remedy = "plane elements are CPEn, CPSn, CPEGn, CAXn, Sn, M3Dn with 3, 4, 6 or 8 nodes";
                return Err(keyword.fault(what, remedy));
            }
        };
        if let Some(kinematics) = made_for(name)
            && self.made_for.iter().all(|(other, _)| *other != kinematics)
        {
            self.made_for.push((kinematics, name.to_ascii_uppercase()));
        }
        let mesh = &mut self.scope().mesh;
        let tags: Vec<u64> = match shape {
            Some((kind, count, shell)) => {
                let rows = rows(keyword, name, kind, count)?;
                for (tag, nodes, place) in &rows {
                    let is_same = |cell: &Cell| cell.tag == *tag && cell.nodes == *nodes;
                    if !mesh.elements.insert(*tag) && !mesh.cells.iter().any(is_same) {
                        return Err(place.fault(format!("element {tag} is there twice, with other nodes"), DAMAGED));
                    }
                }
                let tags = rows.iter().map(|(tag, _, _)| *tag).collect();
                let cell = |(tag, nodes, place)| Cell { kind, shell, tag, nodes, place };
                mesh.cells.extend(rows.into_iter().map(cell));
                tags
            }
            None => {
                let rows = of_any_length(keyword);
                let tags = rows.iter().map(|(tag, _, _)| *tag).collect();
                if family == Family::Shapeless {
                    let enough = rows.into_iter().filter(|(_, nodes, _)| nodes.len() >= 3);
                    let own = |(_, nodes, place)| Shapeless { name: name.to_owned(), nodes, place };
                    mesh.shapeless.extend(enough.map(own));
                }
                tags
            }
        };
        mesh.elements.extend(&tags);
        self.scope().list(Of::Elements, keyword.parameter("ELSET"), &tags, &keyword.place);
        Ok(())
    }

    fn set(&mut self, keyword: &Keyword, of: Of) -> Result<(), MeshError> {
        let name = keyword.required(if of == Of::Nodes { "NSET" } else { "ELSET" })?;
        let (instance, place) = (keyword.parameter("INSTANCE").map(str::to_owned), keyword.place.clone());
        let generate = keyword.parameter("GENERATE").is_some();
        let set = self.scope().set(of, name);
        if let (Of::Nodes, Some(elements)) = (of, keyword.parameter("ELSET")) {
            let members = vec![Member::NodesOf(elements.to_owned())];
            set.push(Entry { members, instance: instance.clone(), place });
        }
        for line in &keyword.lines {
            let (members, instance) = (members(line, generate)?, instance.clone());
            set.push(Entry { members, instance, place: line.place.clone() });
        }
        Ok(())
    }

    fn surface(&mut self, keyword: &Keyword) -> Result<(), MeshError> {
        let name = keyword.required("NAME")?;
        let kind = keyword.parameter("TYPE").unwrap_or("ELEMENT").to_ascii_uppercase();
        let mut patches = Vec::new();
        match (kind.as_str(), keyword.parameter("COMBINE")) {
            ("SEGMENTS" | "CYLINDER" | "REVOLUTION" | "USER" | "CUTTING SURFACE" | "XFEM" | "EULERIAN MATERIAL", _) => {
                self.remarks.rigid(name);
                return Ok(());
            }
            (_, Some(combine)) => patches.push(combined(keyword, combine)?),
            ("NODE", None) => {
                let lines = keyword.lines.iter().filter(|line| !line.fields.is_empty());
                patches.extend(lines.map(|line| Patch::Nodes(first(line))));
            }
            ("ELEMENT", None) => {
                for line in &keyword.lines {
                    let text = line.fields.get(1).map_or("", String::as_str);
                    let Some(label) = Label::parse(text) else {
                        let what = format!("'{text}' is no side of an element");
                        return Err(line.fault(what, LABELS));
                    };
                    patches.push(Patch::Sides(first(line), label));
                }
            }
            (kind, None) => {
                let what = format!("TYPE={kind} of *SURFACE is not known");
                return Err(keyword.fault(what, "surfaces are of TYPE=ELEMENT or TYPE=NODE"));
            }
        }
        self.scope().surfaces.of(name).extend(patches);
        Ok(())
    }
}

/// The elements in the first field of a line of a surface; an empty one is all of them.
fn first(line: &Line) -> Entry {
    let member = match line.fields.first().map(String::as_str) {
        None | Some("") => Member::All,
        Some(field) => member(field),
    };
    Entry { members: vec![member], instance: None, place: line.place.clone() }
}

fn combined(keyword: &Keyword, combine: &str) -> Result<Patch, MeshError> {
    let operation = match combine.to_ascii_uppercase().as_str() {
        "UNION" => Operation::Union,
        "INTERSECTION" => Operation::Intersection,
        "DIFFERENCE" => Operation::Difference,
        _ => {
            let what = format!("COMBINE={combine} of *SURFACE is not known");
            return Err(keyword.fault(what, "it is UNION, INTERSECTION or DIFFERENCE"));
        }
    };
    let fields = keyword.lines.iter().flat_map(|line| &line.fields).filter(|field| !field.is_empty());
    Ok(Patch::Combined(operation, fields.cloned().collect(), keyword.place.clone()))
}

/// Refuses data that stand in a file of their own.
fn own_lines(keyword: &Keyword) -> Result<(), MeshError> {
    let Some(input) = keyword.parameter("INPUT") else { return Ok(()) };
    let what = format!("*{} takes its data from the file {input}, which is not read this way", keyword.name);
    let remedy = format!("leave INPUT= out, and write *INCLUDE, INPUT={input} into the next line");
    Err(keyword.fault(what, &remedy))
}
