//! Scene files, put together piece by piece.

use std::fmt::Write;

/// The text of a scene with `[geometry]`: E = 1 and ν = 0.3 unless said otherwise, plane strain.
#[derive(Clone, Default)]
pub struct Toml {
    model: Option<String>,
    size: Option<f64>,
    mesh: Option<String>,
    polygons: String,
    bodies: Vec<(String, String, (f64, f64))>,
    /// Keys of bodies in place of `young` and `poisson`, or beside them.
    matter: Vec<(String, String)>,
    conditions: String,
}

impl Toml {
    /// `plane-strain` or `plane-stress`, and the thickness.
    pub fn model(mut self, kinematics: &str, thickness: f64) -> Self {
        self.model = Some(format!("kinematics = \"{kinematics}\"\nthickness = {thickness:?}"));
        self
    }

    /// Bodies of revolution.
    pub fn turned(mut self) -> Self {
        self.model = Some("kinematics = \"axisymmetric\"".to_string());
        self
    }

    /// The target edge length.
    pub fn size(mut self, size: f64) -> Self {
        self.size = Some(size);
        self
    }

    /// A mesh file in place of the polygons.
    pub fn mesh_file(mut self, file: &str) -> Self {
        self.mesh = Some(file.to_owned());
        self
    }

    /// A polygon of a body, with the names of its edges.
    pub fn polygon<const N: usize>(self, body: &str, points: &[[f64; 2]], edges: [&str; N]) -> Self {
        self.outline(body, points, &edges)
    }

    /// As [`Self::polygon`], for any number of edges.
    pub fn outline(mut self, body: &str, points: &[[f64; 2]], edges: &[&str]) -> Self {
        write!(self.polygons, "[[geometry.polygons]]\nbody = \"{body}\"\npoints = {points:?}\nedges = {edges:?}\n")
            .expect("a string takes any text");
        if !self.bodies.iter().any(|b| b.0 == body) {
            self.bodies.push((body.to_string(), "body_force = [0.0, 0.0]".to_string(), (1.0, 0.3)));
        }
        self
    }

    /// Arcs in place of edges of the polygon before: its edge and a point between its ends.
    pub fn arcs(mut self, arcs: &[(usize, [f64; 2])]) -> Self {
        let rows: Vec<String> =
            arcs.iter().map(|(edge, through)| format!("{{ edge = {edge}, through = {through:?} }}")).collect();
        writeln!(self.polygons, "arcs = [{}]", rows.join(", ")).expect("a string takes any text");
        self
    }

    /// The body force of a body.
    pub fn force(self, body: &str, force: [f64; 2]) -> Self {
        self.loaded(body, &format!("body_force = {force:?}"))
    }

    /// The keys of a body that load it, as written in the file.
    pub fn loaded(mut self, body: &str, keys: &str) -> Self {
        self.bodies.iter_mut().filter(|b| b.0 == body).for_each(|b| b.1 = keys.to_string());
        self
    }

    /// E and ν of a body.
    pub fn material(mut self, body: &str, young: f64, poisson: f64) -> Self {
        self.bodies.iter_mut().filter(|b| b.0 == body).for_each(|b| b.2 = (young, poisson));
        self
    }

    /// Any table, as written in the file.
    pub fn table(mut self, text: &str) -> Self {
        self.conditions.push_str(text);
        self.conditions.push('\n');
        self
    }

    /// This scene with each table of a condition, as `contacts`, replaced by the result of `change`.
    pub fn with_each(&self, condition: &str, mut change: impl FnMut(&str) -> String) -> Self {
        let text = format!("\n{}", self.conditions);
        let header = format!("[[{condition}]]");
        let tables = text.split("\n[[").skip(1).map(|table| format!("[[{}", table.trim_end()));
        let changed = tables.map(|table| if table.starts_with(&header) { change(&table) } else { table });
        let conditions = changed.map(|table| table + "\n").collect();
        Toml { conditions, ..self.clone() }
    }

    /// The largest coordinate of its polygons.
    pub fn reach(&self) -> f64 {
        let rows = self.polygons.lines().filter(|line| line.starts_with("points"));
        rows.flat_map(numbers).fold(0.0, |most, x| x.abs().max(most))
    }

    pub fn clamp(self, on: &str) -> Self {
        self.table(&format!("[[supports]]\non = \"{on}\"\ntype = \"clamped\""))
    }

    pub fn roller(self, on: &str) -> Self {
        self.table(&format!("[[supports]]\non = \"{on}\"\ntype = \"roller\""))
    }

    pub fn traction(self, on: &str, value: [f64; 2]) -> Self {
        self.table(&format!("[[tractions]]\non = \"{on}\"\nvalue = {value:?}"))
    }

    pub fn pressure(self, on: &str, pressure: f64) -> Self {
        self.table(&format!("[[tractions]]\non = \"{on}\"\npressure = {pressure:?}"))
    }

    pub fn contact(self, first: &str, second: &str) -> Self {
        self.table(&format!("[[contacts]]\nbetween = [\"{first}\", \"{second}\"]"))
    }

    pub fn rigid(self, on: &str) -> Self {
        self.table(&format!("[[contacts]]\non = \"{on}\""))
    }

    /// The keys of a body's material; those that stand beside `young` and `poisson` begin with them.
    pub fn matter(mut self, body: &str, keys: &str) -> Self {
        self.matter.push((body.to_owned(), keys.to_owned()));
        self
    }

    /// Names of the bodies, with Young's modulus and Poisson's ratio.
    pub fn bodies(&self) -> Vec<(String, (f64, f64))> {
        self.bodies.iter().map(|(name, _, constants)| (name.clone(), *constants)).collect()
    }

    /// The scene file.
    pub fn text(&self) -> String {
        let model = self.model.as_deref().unwrap_or("kinematics = \"plane-strain\"");
        let size = self.size.map_or(String::new(), |size| format!("size = {size:?}\n"));
        let mut text = match &self.mesh {
            Some(file) => format!("[model]\n{model}\n[mesh]\nfile = \"{file}\"\n"),
            None => format!("[model]\n{model}\n[geometry]\n{size}{}", self.polygons),
        };
        for (name, load, (young, poisson)) in &self.bodies {
            let isotropic = format!("young = {young:?}\npoisson = {poisson:?}");
            let keys = self.matter.iter().rfind(|(of, _)| of == name).map_or(&isotropic, |(_, keys)| keys);
            write!(text, "[bodies.{name}]\n{keys}\n{load}\n").expect("a string takes any text");
        }
        text.push_str(&self.conditions);
        text
    }
}

/// The numbers in a line of a scene file.
pub fn numbers(line: &str) -> impl Iterator<Item = f64> + '_ {
    line.split(['=', ',', '[', ']', ' ']).filter_map(|word| word.parse().ok())
}
