//! A scene as the text of a file.

use std::fmt::Write;

use toml::Value;

use super::Draft;
use crate::elasticity::{Anisotropic, Elasticity, Initial, Matrix, Orthotropic};
use crate::load::{BodyForce, Rotation};
use crate::scene::keys::range::Ranged;
use crate::scene::keys::selection::written;
use crate::scene::{
    Affine, Body, Bond, Boundary, Component, Contact, ContactSides, Edges, Extent, FrictionBound, Gap, Holder,
    Kinematics, Load, MeshSource, Normals, Obstacle, Part, PointValue, Polygon, Quantity, Region, Shape, Support,
    SupportKind, Target, Term, Touching, Traction,
};

impl Draft {
    /// The scene file that says the same, in coordinates that count from `origin`.
    pub fn to_toml(&self) -> String {
        let mut text = String::new();
        // Writing to a string does not fail.
        let _ = self.write(&mut text);
        text
    }

    fn write(&self, text: &mut String) -> std::fmt::Result {
        writeln!(text, "title = {}", quoted(&self.title))?;
        let thickness = match self.kinematics {
            Kinematics::Axisymmetric => String::new(),
            _ => format!(", thickness = {}", number(self.thickness)),
        };
        writeln!(text, "model = {{ kinematics = {:?}{thickness} }}", self.kinematics.name())?;
        match &self.mesh {
            MeshSource::File(path) => writeln!(text, "mesh.file = {}", quoted(&path.to_string_lossy()))?,
            MeshSource::Parts(parts) => {
                let part = |Part { file, prefix, scale, translate }: &Part| {
                    let (file, prefix) = (quoted(&file.to_string_lossy()), quoted(prefix));
                    let (scale, translate) = (number(*scale), list(translate));
                    format!("{{ file = {file}, prefix = {prefix}, scale = {scale}, translate = {translate} }}")
                };
                writeln!(text, "mesh.parts = [{}]", parts.iter().map(part).collect::<Vec<_>>().join(", "))?;
            }
            MeshSource::Geometry { size: Some(size), .. } => writeln!(text, "geometry.size = {}", number(*size))?,
            MeshSource::Geometry { .. } => (),
        }
        if let MeshSource::Geometry { polygons, .. } = &self.mesh {
            let tables: Vec<String> = polygons.iter().map(polygon).collect();
            writeln!(text, "geometry.polygons = [{}]", tables.join(", "))?;
        }
        for (i, Body { name, elasticity, initial, body_force }) in self.bodies.iter().enumerate() {
            let cells = self.cells.iter().find(|cells| cells.body == i);
            let cells = cells.map(|cells| format!(", {}", written(&cells.group))).unwrap_or_default();
            let material = match (self.range_of(Ranged::Young(i)), elasticity) {
                (Some(young), Elasticity::Isotropic { poisson, .. }) => {
                    format!("young = {young}, poisson = {}", number(*poisson))
                }
                _ => material(elasticity),
            };
            let (name, force) = (quoted(name), force(body_force));
            let material = material + &initial_keys(initial);
            writeln!(text, "bodies.{name} = {{ {material}, {force}{cells} }}")?;
        }
        let lists = [
            ("boundaries", self.boundaries.iter().map(|b| self.boundary(b)).collect()),
            (
                "supports",
                self.supports
                    .iter()
                    .enumerate()
                    .map(|(i, s)| support(s, |c| self.range_of(Ranged::Spring(i, c))))
                    .collect::<Vec<_>>(),
            ),
            ("tractions", self.tractions.iter().map(traction).collect()),
            (
                "contacts",
                self.contacts.iter().enumerate().map(|(i, c)| contact(c, |of| self.range_of(of(i)))).collect(),
            ),
            (
                "bonds",
                self.bonds.iter().enumerate().map(|(i, b)| bond(b, |c| self.range_of(Ranged::Layer(i, c)))).collect(),
            ),
            ("quantities", self.quantities.iter().map(|q| self.quantity(q)).collect()),
        ];
        for (key, tables) in lists.iter().filter(|(_, tables)| !tables.is_empty()) {
            writeln!(text, "{key} = [")?;
            tables.iter().try_for_each(|table| writeln!(text, "    {{ {table} }},"))?;
            writeln!(text, "]")?;
        }
        Ok(())
    }

    /// The two ends of a number, where it has a range.
    fn range_of(&self, of: Ranged) -> Option<String> {
        self.ranges.iter().find(|range| range.of == of).map(|range| list(&[range.low, range.high]))
    }

    fn boundary(&self, Boundary { name, body, edges }: &Boundary) -> String {
        let body = body.and_then(|i| self.bodies.get(i)).map(|body| format!(", body = {}", quoted(&body.name)));
        let edges = match edges {
            Edges::Line(ends) => format!("line = {}", rows(ends)),
            Edges::Box(ends) => format!("box = {}", rows(ends)),
            Edges::Circle { centre, radius } => {
                format!("circle = {{ centre = {}, radius = {} }}", list(centre), number(*radius))
            }
            Edges::Normal { direction, angle } => format!("normal = {}, angle = {}", list(direction), number(*angle)),
            Edges::Group(group) => written(group),
        };
        format!("name = {}{}, {edges}", quoted(name), body.unwrap_or_default())
    }

    fn quantity(&self, quantity: &Quantity) -> String {
        // An index that belongs to nothing is a name that nothing has.
        let body = |i: usize| quoted(self.bodies.get(i).map_or("", |body| &body.name));
        let contact = |i: usize| quoted(&self.contacts.get(i).map_or_else(String::new, Contact::name));
        let support = |i: usize| quoted(self.supports.get(i).map_or("", |support| &support.on));
        let what = match &quantity.target {
            Target::Displacement { of, direction } => {
                let of = match of {
                    Extent::Boundary(name) => quoted(name),
                    Extent::Body(i) => body(*i),
                };
                format!("displacement = {of}, direction = {}", list(direction))
            }
            Target::ContactForce { contact: of, tangential, window } => {
                let component = if *tangential { ", component = \"tangential\"" } else { "" };
                let window = window.map_or_else(String::new, |window| format!(", window = {}", list(&window)));
                format!("force = {}{component}{window}", contact(*of))
            }
            Target::SupportForce { support: of, direction } => {
                format!("force = {}, direction = {}", support(*of), list(direction))
            }
            Target::Moment { of, about } => {
                let of = match of {
                    Holder::Contact(i) => contact(*i),
                    Holder::Support(i) => support(*i),
                };
                format!("moment = {of}, about = {}", list(about))
            }
            Target::Stress { body: of, region, component } => {
                let region = match region {
                    Region::Whole => String::new(),
                    Region::Polygon(points) => format!(", polygon = {}", rows(points)),
                };
                format!("stress = {}{region}, {}", body(*of), component_of(component, self.kinematics))
            }
            Target::StressIntensity { mode, tip } => {
                format!("stress_intensity = {:?}, tip = {}", mode.word(), list(tip))
            }
            Target::Point { body: of, at, value, smoothness } => {
                let (key, value) = match value {
                    PointValue::Displacement(direction) => ("displacement", format!("direction = {}", list(direction))),
                    PointValue::Stress(component) => ("stress", component_of(component, self.kinematics)),
                    PointValue::Invariant(invariant) => ("stress", format!("component = {:?}", invariant.word())),
                };
                format!("{key} = {}, point = {}, {value}, smoothness = {smoothness}", body(*of), list(at))
            }
        };
        format!("name = {}, {what}", quoted(&quantity.name))
    }
}

/// A key of a table as TOML writes it.
pub(crate) fn key(name: &str) -> String {
    let bare = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    if !name.is_empty() && name.chars().all(bare) { name.to_owned() } else { basic(name) }
}

/// A string on one line, with escapes; JSON's are TOML's.
fn basic(text: &str) -> String {
    serde_json::Value::from(text).to_string().replace('\u{7f}', "\\u007f")
}

/// A string as TOML writes it.
pub(crate) fn quoted(text: &str) -> String {
    Value::from(text).to_string()
}

fn number(number: f64) -> String {
    Value::from(number).to_string()
}

/// The keys of initial strains and stresses, each behind a comma.
fn initial_keys(initial: &Initial) -> String {
    let Initial { expansion, temperature, gradient, stress } = initial;
    let mut text = String::new();
    if *expansion != [0.0; 3] || *temperature != 0.0 || *gradient != [0.0; 2] {
        let (expansion, value, gradient) = (list(expansion), number(*temperature), list(gradient));
        text += &format!(", expansion = {expansion}, temperature = {{ value = {value}, gradient = {gradient} }}");
    }
    if *stress != [0.0; 4] {
        text += &format!(", initial_stress = {}", list(stress));
    }
    text
}

/// The keys of a material.
pub(crate) fn material(elasticity: &Elasticity) -> String {
    match elasticity {
        Elasticity::Isotropic { young, poisson } => {
            format!("young = {}, poisson = {}", number(*young), number(*poisson))
        }
        Elasticity::Orthotropic(Orthotropic { young, poisson, shear, angle }) => format!(
            "orthotropic = {{ young = {}, poisson = {}, shear = {}, angle = {} }}",
            list(young),
            list(poisson),
            number(*shear),
            number(*angle)
        ),
        Elasticity::Anisotropic(Anisotropic { kind, matrix, angle }) => {
            let rows = match matrix {
                Matrix::Three(rows) => rows.iter().map(|row| list(row)).collect::<Vec<_>>(),
                Matrix::Six(rows) => rows.iter().map(|row| list(row)).collect(),
            };
            format!("{} = [{}], angle = {}", kind.key(), rows.join(", "), number(*angle))
        }
    }
}

fn list(numbers: &[f64]) -> String {
    Value::from(numbers.to_vec()).to_string()
}

fn rows(rows: &[[f64; 2]]) -> String {
    let rows: Vec<Value> = rows.iter().map(|row| Value::from(row.to_vec())).collect();
    Value::from(rows).to_string()
}

fn polygon(polygon: &Polygon) -> String {
    let Polygon { body, points, edges, arcs } = polygon;
    let names: Vec<String> = edges.iter().map(|name| quoted(name)).collect();
    let arcs: Vec<String> =
        arcs.iter().map(|arc| format!("{{ edge = {}, through = {} }}", arc.edge, list(&arc.through))).collect();
    let (body, points, names, arcs) = (quoted(body), rows(points), names.join(", "), arcs.join(", "));
    format!("{{ body = {body}, points = {points}, edges = [{names}], arcs = [{arcs}] }}")
}

/// Normal and tangential, each a number or the ends that `range` has of it.
fn both(stiffness: &[f64; 2], range: impl Fn(usize) -> Option<String>) -> String {
    let [normal, tangential] = [0, 1].map(|c| range(c).unwrap_or_else(|| number(stiffness[c])));
    format!("[{normal}, {tangential}]")
}

fn support(Support { on, kind }: &Support, range: impl Fn(usize) -> Option<String>) -> String {
    let on = quoted(on);
    match kind {
        SupportKind::Clamped { displacement } => {
            format!("on = {on}, type = \"clamped\", displacement = {}", affine(displacement))
        }
        SupportKind::Roller { direction, displacement } => {
            let direction = direction.map(|d| format!(", direction = {}", list(&d))).unwrap_or_default();
            format!("on = {on}, type = \"roller\"{direction}, displacement = {}", number(*displacement))
        }
        SupportKind::Spring { stiffness } => {
            format!("on = {on}, type = \"spring\", stiffness = {}", both(stiffness, range))
        }
    }
}

fn affine(Affine { value, gradient }: &Affine) -> String {
    match *gradient == [[0.0; 2]; 2] {
        true => list(value),
        false => format!("{{ value = {}, gradient = {} }}", list(value), rows(gradient)),
    }
}

fn force(force: &BodyForce) -> String {
    let given = affine(&force.given());
    match force.rotation() {
        None => format!("body_force = {given}"),
        Some(Rotation { density, omega, about }) => {
            let (density, omega, about) = (number(density), number(omega), list(&about));
            format!("body_force = {given}, rotation = {{ density = {density}, omega = {omega}, about = {about} }}")
        }
    }
}

fn traction(Traction { on, load, terms }: &Traction) -> String {
    let on = quoted(on);
    let term = |term: &Term| {
        let [i, j] = term.powers;
        format!("{{ powers = [{i}, {j}], value = {} }}", list(&term.value))
    };
    let terms = match terms[..] {
        [] => String::new(),
        _ => format!(", terms = [{}]", terms.iter().map(term).collect::<Vec<_>>().join(", ")),
    };
    match load {
        Load::Affine(Affine { value, gradient }) => {
            format!("on = {on}, value = {}, gradient = {}{terms}", list(value), rows(gradient))
        }
        Load::Pressure(pressure) => format!("on = {on}, pressure = {}", number(*pressure)),
    }
}

fn contact(contact: &Contact, range: impl Fn(fn(usize) -> Ranged) -> Option<String>) -> String {
    let Contact { sides, gap, normals, direction, obstacle, stiffness, friction, coefficient } = contact;
    let sides = match sides {
        ContactSides::Between([a, b]) => format!("between = [{}, {}]", quoted(a), quoted(b)),
        ContactSides::Rigid(on) => format!("on = {}", quoted(on)),
    };
    let gap = match gap {
        Gap::Constant(g) => range(Ranged::Gap).unwrap_or_else(|| number(*g)),
        Gap::Table(table) => rows(table),
        Gap::Circle(Touching { radius, at }) => format!("{{ circle = {}, at = {} }}", number(*radius), number(*at)),
        Gap::Parabola(Touching { radius, at }) => format!("{{ parabola = {}, at = {} }}", number(*radius), number(*at)),
    };
    let normals = match normals {
        Normals::Smooth => "",
        Normals::Facets => ", normals = \"facets\"",
    };
    let direction = direction.map(|d| format!(", direction = {}", list(&d))).unwrap_or_default();
    let stiffness = stiffness
        .map(|k| format!(", stiffness = {}", range(Ranged::Contact).unwrap_or_else(|| number(k))))
        .unwrap_or_default();
    let coulomb = |mu: f64| format!(", friction = {{ coefficient = {} }}", number(mu));
    let coulomb = || coefficient.map_or_else(String::new, coulomb);
    let friction = friction.as_ref().map_or_else(coulomb, |bound| {
        let bound = match bound {
            FrictionBound::Constant(bound) => range(Ranged::Friction).unwrap_or_else(|| number(*bound)),
            FrictionBound::Table(table) => rows(table),
        };
        format!(", friction = {{ bound = {bound} }}")
    });
    if let Some(Obstacle { shape, moved }) = obstacle {
        let shape = match shape {
            Shape::Line(ends) => format!("line = {}", rows(ends)),
            Shape::Circle { centre, radius, inside } => {
                let side = if *inside { "inside" } else { "outside" };
                format!("circle = {{ centre = {}, radius = {}, side = \"{side}\" }}", list(centre), number(*radius))
            }
        };
        return format!("{sides}, obstacle = {{ {shape} }}, move = {}{stiffness}{friction}", list(moved));
    }
    format!("{sides}, gap = {gap}{normals}{direction}{stiffness}{friction}")
}

fn bond(Bond { sides: [a, b], stiffness, direction }: &Bond, range: impl Fn(usize) -> Option<String>) -> String {
    let stiffness = stiffness.map(|k| format!(", stiffness = {}", both(&k, range))).unwrap_or_default();
    let direction = direction.map(|d| format!(", direction = {}", list(&d))).unwrap_or_default();
    format!("between = [{}, {}]{stiffness}{direction}", quoted(a), quoted(b))
}

fn component_of(component: &Component, kinematics: Kinematics) -> String {
    match Component::words(kinematics).iter().find(|(_, known)| known == component) {
        Some((name, _)) => format!("component = {name:?}"),
        None => {
            let [xx, yy, xy] = component.factors();
            format!("direction = {}", list(&[xx.sqrt().copysign(xy), yy.sqrt()]))
        }
    }
}
