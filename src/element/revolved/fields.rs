//! The space of the element on one triangle, before energies choose its modes.

use nalgebra::{DMatrix, DMatrixView};

use super::householder::range_and_rest;
use super::modes::{Ring, dot};
use crate::element::field::lattice;
use crate::element::geometry::gradients;
use crate::element::lattice_len;
use crate::element::polynomial::quadrature::triangle_rule;
use crate::element::polynomial::triangle;
use crate::element::split::polynomials::{Jet, values, with_derivatives};

/// Σ_rr of degree p and χ of degree p + 1, without a constant, on each subtriangle by itself.
pub(super) struct Raw {
    /// Number of fields of one subtriangle.
    pub fields: usize,
    /// Nodal values (rr, zz, rz) of all three subtriangles, one column a field.
    pub nodal: DMatrix<f64>,
}

impl Raw {
    pub fn new(ring: &Ring) -> Self {
        let p = ring.degree;
        let (n, of_sigma, of_chi) = (lattice_len(p), lattice_len(p), lattice_len(p + 1) - 1);
        let fields = of_sigma + of_chi;
        let mut nodal = DMatrix::zeros(9 * n, 3 * fields);
        let unit = ring.unit_of_chi();
        for sub in 0..3 {
            let g = gradients(ring.sub_corners(sub));
            for (node, l) in lattice(p).enumerate() {
                let jets: [Jet; 3] = [0, 1, 2].map(|i| [l[i], unit * g[i][0], unit * g[i][1]]);
                let row = 3 * (n * sub + node);
                for (i, value) in values(p, l).into_iter().enumerate() {
                    nodal[(row, fields * sub + i)] = value;
                }
                for (i, [_, along, up]) in with_derivatives(p + 1, jets).into_iter().skip(1).enumerate() {
                    let column = fields * sub + of_sigma + i;
                    nodal[(row + 1, column)] = -along;
                    nodal[(row + 2, column)] = up;
                }
            }
        }
        Raw { fields, nodal }
    }

    /// The coefficients of uniform pressure: Σ_rr = r and χ = −r²/2, r counted from the centroid in the square.
    fn pressure(&self, ring: &Ring) -> Vec<f64> {
        let p = ring.degree;
        let of_sigma = lattice_len(p);
        let mut out = vec![0.0; 3 * self.fields];
        for (sub, out) in out.chunks_exact_mut(self.fields).enumerate() {
            let (radii, corners) = (ring.sub_radii(sub), ring.sub_corners(sub));
            let centre = radii[2];
            for &(l, weight) in triangle_rule(2 * p + 2) {
                let (x, r) = (dot(corners.map(|q| q[0]), l), dot(radii, l));
                let chi = -(centre * x + 0.5 * x * x) / ring.unit_of_chi();
                for (out, value) in out.iter_mut().zip(values(p, l)) {
                    *out += weight * value * r;
                }
                for (out, value) in out[of_sigma..].iter_mut().zip(values(p + 1, l).into_iter().skip(1)) {
                    *out += weight * value * chi;
                }
            }
        }
        out
    }
}

/// The fields of the element, by their coefficients in the raw ones.
pub(super) struct Fields {
    /// In the order of the columns.
    pub columns: DMatrix<f64>,
    /// Number of those without traction.
    pub free: usize,
    /// The conditions that they meet.
    pub inside: Split,
}

impl Fields {
    pub fn new(ring: &Ring, raw: &Raw) -> Self {
        let dimension = ring.dimension();
        let inside = Split::new(Conditions::inside(ring), raw, dimension);
        let space = inside.space();
        // One resultant, that along the axis, is none.
        let met = ring.met() - 1;
        let tractions = Conditions::on_sides(ring).of(&raw.nodal);
        let ordered = space * range_and_rest((tractions * space).transpose(), met);
        let free = dimension - met;
        let pressure = DMatrix::from_vec(space.nrows(), 1, raw.pressure(ring)).normalize();
        let part = ordered.columns(0, met).transpose() * &pressure;
        let others = range_and_rest(part, 1);
        let mut columns = DMatrix::zeros(space.nrows(), dimension);
        columns.column_mut(0).copy_from(&pressure);
        columns.columns_mut(1, free).copy_from(&ordered.columns(met, free));
        columns.columns_mut(1 + free, met - 1).copy_from(&(ordered.columns(0, met) * others.columns(1, met - 1)));
        Fields { columns, free, inside }
    }
}

impl Ring {
    /// The number of fields of the element.
    fn dimension(&self) -> usize {
        let p = self.degree;
        let lost = match self.ends_on_axis() {
            0 => 0,
            1 => 4,
            _ => 3 * p + 5,
        };
        3 * (p + 1) * (p + 1) - lost
    }

    /// By which χ has Σ_rz and Σ_zz of their units: a length.
    fn unit_of_chi(&self) -> f64 {
        self.unit * self.flatness() * self.flatness().sqrt()
    }

    /// Height over width, the unit of Σ_rz where that of Σ_rr is one; its square is that of Σ_zz.
    fn flatness(&self) -> f64 {
        let range = |c: usize| {
            let [a, b, d] = self.corners.map(|corner| corner[c]);
            a.max(b).max(d) - a.min(b).min(d)
        };
        range(1) / range(0)
    }
}

/// Linear conditions on nodal values: what each has as a sum of a few of them, made free of units by the width and height of the triangle.
struct Conditions(Vec<Vec<(usize, f64)>>);

impl Conditions {
    /// Those of a field of the element: no jumps of Σ n at the nodes of the inner segments, and no Σ on the axis.
    fn inside(ring: &Ring) -> Self {
        let (p, n) = (ring.degree, lattice_len(ring.degree));
        let mut rows = Vec::new();
        for corner in 0..3 {
            // The segment is the second side of one subtriangle, and the third of the other.
            let (one, other) = ((corner + 1) % 3, (corner + 2) % 3);
            let [radial, axial] = traction_rows(ring, ring.corners[corner].map(|x| -x));
            for k in 0..=p {
                let a = 3 * (n * one + triangle::number([0, p - k, k]));
                let b = 3 * (n * other + triangle::number([p - k, 0, k]));
                rows.extend([&radial, &axial].map(|row| {
                    let at = |node: usize, sign: f64| row.map(|(component, weight)| (node + component, sign * weight));
                    at(a, 1.0).into_iter().chain(at(b, -1.0)).collect()
                }));
            }
        }
        for sub in 0..3 {
            for (node, l) in lattice(p).enumerate() {
                if dot(ring.sub_radii(sub), l) == 0.0 {
                    rows.extend((0..3).map(|c| vec![(3 * (n * sub + node) + c, 1.0)]));
                }
            }
        }
        Conditions(rows)
    }

    /// Σ n = 0 at the nodes of the sides off the axis.
    fn on_sides(ring: &Ring) -> Self {
        let (p, n) = (ring.degree, lattice_len(ring.degree));
        let mut rows = Vec::new();
        for side in 0..3 {
            let [a, b, _] = ring.sub_corners(side);
            let of_side = traction_rows(ring, [b[0] - a[0], b[1] - a[1]]);
            for k in (0..=p).filter(|k| !ring.vanishes(side, *k)) {
                let node = 3 * (n * side + triangle::number([p - k, k, 0]));
                rows.extend(of_side.map(|row| row.map(|(c, weight)| (node + c, weight)).to_vec()));
            }
        }
        Conditions(rows)
    }

    /// By how much the columns of `nodal` miss them.
    fn of(&self, nodal: &DMatrix<f64>) -> DMatrix<f64> {
        let missed = |i: usize, j: usize| self.0[i].iter().map(|(at, weight)| weight * nodal[(*at, j)]).sum();
        DMatrix::from_fn(self.0.len(), nodal.ncols(), missed)
    }
}

/// Radial and axial traction of Σ across a segment along (dr, dz), by component: over the height, and over the height times [`Ring::flatness`].
fn traction_rows(ring: &Ring, [dr, dz]: [f64; 2]) -> [[(usize, f64); 2]; 2] {
    let flatness = ring.flatness();
    let height = ring.unit * flatness.sqrt();
    let [across, along] = [dz / height, dr / height];
    [[(0, across), (2, -along)], [(2, across / flatness), (1, -along / flatness)]]
}

/// The raw fields, split by conditions on them.
pub(super) struct Split {
    conditions: Conditions,
    /// By how much the raw fields miss them.
    missed: DMatrix<f64>,
    /// An orthogonal matrix: first the fields that miss them, then those that meet them.
    all: DMatrix<f64>,
    rank: usize,
}

impl Split {
    /// By conditions that fields of this dimension meet.
    fn new(conditions: Conditions, raw: &Raw, dimension: usize) -> Self {
        let missed = conditions.of(&raw.nodal);
        let rank = raw.nodal.ncols() - dimension;
        Split { all: range_and_rest(missed.transpose(), rank), conditions, missed, rank }
    }

    /// Splits by the conditions of fields without traction.
    pub fn unloaded(ring: &Ring, raw: &Raw) -> Self {
        let Conditions(mut rows) = Conditions::inside(ring);
        rows.extend(Conditions::on_sides(ring).0);
        Self::new(Conditions(rows), raw, ring.dimension() - (ring.met() - 1))
    }

    /// The fields that meet the conditions.
    fn space(&self) -> DMatrixView<'_, f64> {
        self.all.columns(self.rank, self.all.ncols() - self.rank)
    }

    /// The repair of fields that should meet the conditions.
    pub fn repair(self, raw: &Raw) -> Repair {
        let range = self.all.columns(0, self.rank);
        let (q, r) = (self.missed * range).qr().unpack();
        let least = r.solve_upper_triangular(&q.transpose());
        let least = least.unwrap_or_else(|| DMatrix::zeros(self.rank, self.conditions.0.len()));
        Repair { change: &raw.nodal * (range * least), conditions: self.conditions }
    }
}

/// Makes nodal values meet conditions to the rounding of the values themselves.
///
/// Σ_zz = −∂_r χ asks for a χ as large as the triangle is long, and Σ_rz = ∂_z χ divides its rounding by the height: in flat triangles jumps of
/// the combined fields are larger than rounding of their stresses by some p² times that ratio. The smallest change of the raw fields takes
/// them away, so that balance along the axis is kept.
pub(super) struct Repair {
    conditions: Conditions,
    /// Nodal values of the change, for the jumps that are to be taken away.
    change: DMatrix<f64>,
}

impl Repair {
    /// Changes the columns of `nodal`.
    pub fn apply(&self, nodal: &mut DMatrix<f64>) {
        // The second time takes away what the first leaves of large jumps.
        for _ in 0..2 {
            let missed = self.conditions.of(nodal);
            *nodal -= &self.change * missed;
        }
    }
}
