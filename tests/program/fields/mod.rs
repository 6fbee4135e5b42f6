//! Displacement files for tests: legacy VTK in ASCII, written without any library.

use std::collections::HashMap;
use std::fmt::Write;

use hypercircle::problem::Problem;

/// Nodes of a triangle.
#[derive(Clone, Copy, PartialEq)]
pub enum Cells {
    Linear,
    Quadratic,
}

/// A displacement on triangles.
#[derive(Clone)]
pub struct FieldFile {
    pub points: Vec<[f64; 2]>,
    pub cells: Vec<Vec<usize>>,
    pub values: Vec<[f64; 2]>,
}

impl FieldFile {
    /// The mesh of a problem with the displacement `u(body, point)`; middles of edges follow the vertices.
    pub fn new(problem: &Problem, cells: Cells, u: impl Fn(usize, [f64; 2]) -> [f64; 2]) -> Self {
        let mesh = &problem.mesh;
        let vertices = mesh.points.len();
        let mut points = mesh.points.clone();
        let mut body = vec![0; points.len()];
        for (corners, &b) in mesh.triangles.iter().zip(&mesh.body) {
            corners.iter().for_each(|&v| body[v] = b);
        }
        if cells == Cells::Quadratic {
            for edge in &mesh.edges {
                let [a, b] = edge.vertices.map(|v| mesh.points[v]);
                points.push([0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]);
                body.push(mesh.body[edge.triangles[0].expect("an edge has a triangle")]);
            }
        }
        let nodes = |t: usize| match cells {
            Cells::Linear => mesh.triangles[t].to_vec(),
            // Middles of (0, 1), (1, 2), (2, 0); edge i of a triangle is opposite corner i.
            Cells::Quadratic => {
                let [e0, e1, e2] = mesh.triangle_edges[t].map(|e| vertices + e);
                [&mesh.triangles[t][..], &[e2, e0, e1]].concat()
            }
        };
        let values = points.iter().zip(&body).map(|(&p, &b)| u(b, p)).collect();
        FieldFile { cells: (0..mesh.triangles.len()).map(nodes).collect(), points, values }
    }

    pub fn is_quadratic(&self) -> bool {
        self.cells[0].len() == 6
    }

    pub fn largest(&self) -> f64 {
        self.values.iter().flatten().fold(0.0, |m: f64, u| m.max(u.abs()))
    }

    /// Value in the middle of an edge.
    pub fn at(&mut self, problem: &Problem, edge: usize) -> &mut [f64; 2] {
        &mut self.values[problem.mesh.points.len() + edge]
    }

    /// Points and triangles in the opposite order, every other triangle clockwise and started elsewhere.
    pub fn reversed(mut self) -> Self {
        let last = self.points.len() - 1;
        self.points.reverse();
        self.values.reverse();
        self.cells.reverse();
        for (number, nodes) in self.cells.iter_mut().enumerate() {
            nodes.iter_mut().for_each(|n| *n = last - *n);
            if number % 2 == 0 {
                let order: &[usize] = if nodes.len() == 6 { &[2, 1, 0, 4, 3, 5] } else { &[2, 1, 0] };
                *nodes = order.iter().map(|&i| nodes[i]).collect();
            }
        }
        self
    }

    /// One point where several are equal, as programs without contact write it.
    pub fn merged(mut self) -> Self {
        let mut first = HashMap::new();
        let place: Vec<usize> =
            (0..self.points.len()).map(|i| *first.entry(self.points[i].map(f64::to_bits)).or_insert(i)).collect();
        assert!(place.iter().enumerate().any(|(i, p)| i != *p), "nothing to merge");
        self.cells.iter_mut().flatten().for_each(|n| *n = place[*n]);
        self
    }

    /// A point of its own for every corner of every triangle, as programs with discontinuous output write it.
    pub fn split(&self) -> Self {
        let order: Vec<usize> = self.cells.iter().flatten().copied().collect();
        let mut next = 0..;
        let mut renumber = |nodes: &Vec<usize>| next.by_ref().take(nodes.len()).collect();
        FieldFile {
            points: order.iter().map(|&n| self.points[n]).collect(),
            cells: self.cells.iter().map(&mut renumber).collect(),
            values: order.iter().map(|&n| self.values[n]).collect(),
        }
    }

    /// A split field that is not continuous.
    pub fn torn(mut self) -> Self {
        let nodes = self.cells[0].clone();
        nodes.iter().for_each(|&n| self.values[n][0] += 0.125);
        self
    }

    /// One row for each value.
    pub fn rows(&self) -> String {
        self.values.iter().fold(String::new(), |mut text, [x, y]| {
            let _ = writeln!(text, "{x:?} {y:?} 0.0");
            text
        })
    }

    /// The file.
    pub fn vtk(&self) -> String {
        let mut text = String::from("# vtk DataFile Version 3.0\nfield\nASCII\nDATASET UNSTRUCTURED_GRID\n");
        let _ = writeln!(text, "POINTS {} double", self.points.len());
        for [x, y] in &self.points {
            let _ = writeln!(text, "{x:?} {y:?} 0.0");
        }
        let numbers: usize = self.cells.iter().map(|c| c.len() + 1).sum();
        let _ = writeln!(text, "CELLS {} {numbers}", self.cells.len());
        for nodes in &self.cells {
            let list: Vec<String> = nodes.iter().map(usize::to_string).collect();
            let _ = writeln!(text, "{} {}", nodes.len(), list.join(" "));
        }
        let _ = writeln!(text, "CELL_TYPES {}", self.cells.len());
        for nodes in &self.cells {
            let _ = writeln!(text, "{}", if nodes.len() == 6 { 22 } else { 5 });
        }
        let _ = writeln!(text, "POINT_DATA {}\nVECTORS displacement double", self.points.len());
        text + &self.rows()
    }

    /// The file as DOLFINx writes it: VTU of version 2.2 with Lagrange triangles.
    pub fn vtu(&self) -> String {
        let row = |text: &[String]| text.join(" ");
        let points: Vec<String> = self.points.iter().map(|[x, y]| format!("{x:?} {y:?} 0")).collect();
        let values: Vec<String> = self.values.iter().map(|[x, y]| format!("{x:?} {y:?} 0")).collect();
        let nodes: Vec<String> = self.cells.iter().flatten().map(usize::to_string).collect();
        let offsets: Vec<String> = (1..=self.cells.len()).map(|k| (k * self.cells[0].len()).to_string()).collect();
        let array = |kind: &str, name: &str, width: usize, text: &[String]| {
            let width = if width > 1 { format!(" NumberOfComponents=\"{width}\"") } else { String::new() };
            format!("<DataArray type=\"{kind}\" Name=\"{name}\" format=\"ascii\"{width}>{}</DataArray>\n", row(text))
        };
        format!(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"2.2\">\n<UnstructuredGrid>\n\
             <Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n<Points>{}</Points>\n<Cells>{}{}{}</Cells>\n\
             <PointData>{}</PointData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n",
            points.len(),
            self.cells.len(),
            array("Float64", "Points", 3, &points),
            array("Int32", "connectivity", 1, &nodes),
            array("Int32", "offsets", 1, &offsets),
            array("Int8", "types", 1, &vec!["69".to_string(); self.cells.len()]),
            array("Float64", "u", 3, &values),
        )
    }
}
