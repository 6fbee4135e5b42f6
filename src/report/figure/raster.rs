//! A map of many triangles as cells of a grid.

use super::outline::View;
use crate::mesh::Triangulation;

/// A grid over a picture; a cell holds the largest value among the triangles that cover its middle or have their centroid
/// in it, so that no peak is lost, and NaN where there is none.
pub(crate) struct Raster {
    pub columns: usize,
    pub rows: usize,
    /// Page length of a cell.
    pub cell: f64,
    /// Row by row.
    pub values: Vec<f64>,
    /// The triangle that each is of.
    pub triangles: Vec<usize>,
}

/// Fills a grid of cells of page length `cell` over a picture of the given size.
pub(crate) fn raster(mesh: &Triangulation, values: &[f64], view: &View, width: f64, height: f64, cell: f64) -> Raster {
    let columns = (width / cell).ceil().max(1.0) as usize;
    let rows = (height / cell).ceil().max(1.0) as usize;
    let mut grid =
        Raster { columns, rows, cell, values: vec![f64::NAN; columns * rows], triangles: vec![0; columns * rows] };
    for (t, &value) in values.iter().enumerate().take(mesh.triangles.len()) {
        let corners = mesh.corners(t).map(|p| view.at(p).map(|x| x / cell));
        grid.cover(corners, value, t);
    }
    grid
}

impl Raster {
    /// Raises the cells of one triangle, given in units of cells, to `value`.
    fn cover(&mut self, [a, b, c]: [[f64; 2]; 3], value: f64, t: usize) {
        if !value.is_finite() {
            return;
        }
        let span = |k: usize, limit: usize| {
            let low = a[k].min(b[k]).min(c[k]).floor().max(0.0) as usize;
            let high = a[k].max(b[k]).max(c[k]).ceil().max(0.0) as usize;
            low..high.min(limit)
        };
        let side = |p: [f64; 2], q: [f64; 2], x: f64, y: f64| (q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0]);
        for row in span(1, self.rows) {
            for column in span(0, self.columns) {
                let (x, y) = (column as f64 + 0.5, row as f64 + 0.5);
                let sides = [side(a, b, x, y), side(b, c, x, y), side(c, a, x, y)];
                if sides.iter().all(|s| *s >= 0.0) || sides.iter().all(|s| *s <= 0.0) {
                    self.raise(column, row, value, t);
                }
            }
        }
        let centre = [0, 1].map(|k| (a[k] + b[k] + c[k]) / 3.0);
        if centre.iter().all(|x| *x >= 0.0) {
            self.raise(centre[0] as usize, centre[1] as usize, value, t);
        }
    }

    fn raise(&mut self, column: usize, row: usize, value: f64, t: usize) {
        if column < self.columns && row < self.rows {
            let cell = row * self.columns + column;
            if self.values[cell].is_nan() || self.values[cell] < value {
                (self.values[cell], self.triangles[cell]) = (value, t);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::sample::{Sample, Verdict};

    #[test]
    fn the_bodies_are_covered_and_no_peak_is_lost() {
        let mesh = Sample::new(16, Verdict::Agree).problem.mesh;
        let mut values = vec![1.0; mesh.triangles.len()];
        values[77] = 9.0;
        let (view, height) = View::fit(mesh.points.iter().copied(), 100.0, 100.0, 10.0);
        // Cells of 25 page units are far larger than a triangle of 2.5.
        for cell in [1.0, 25.0] {
            let grid = raster(&mesh, &values, &view, 100.0, height, cell);
            assert!(grid.values.contains(&9.0));
            let covered = grid.values.iter().filter(|v| v.is_finite()).count() as f64 * cell * cell;
            assert!(cell > 1.0 || (covered - 3200.0).abs() < 200.0, "{covered}");
        }
    }
}
