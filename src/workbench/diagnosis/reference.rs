//! References that a matrix is compared with: textbook elements on the same nodes, of the same material.

use nalgebra::{DMatrix, Matrix3};

use crate::workbench::displacement::{self, DisplacementElement};
use crate::workbench::formulas::{self, Correction, Family, Point, Split, Variant};

/// The matrix of the isoparametric element of the same nodes and material, numbered as the element is.
pub struct Reference {
    pub(super) family: Family,
    pub(super) rule: Variant,
    pub(super) matrix: DMatrix<f64>,
    /// Node i of the family is node `order[i]` of the element.
    pub(super) order: Vec<usize>,
    pub(super) nodes: Vec<[f64; 2]>,
    /// Hooke's law times thickness.
    pub(super) hooke: Matrix3<f64>,
}

/// Elements that are as right as the isoparametric one: other points of quadrature, and elements with more behind them.
fn also_right(family: Family) -> &'static [Variant] {
    use Variant::{Dilatation, Hybrid, Incompatible, Points};
    match family {
        Family::P1 | Family::P2 => &[],
        Family::Q8 => &[Points(2), Points(4), Points(5)],
        Family::Q9 => &[Points(4), Points(5)],
        Family::Q4 => &[
            Points(3),
            Points(4),
            Points(5),
            Incompatible(Correction::Taylor, 2),
            Incompatible(Correction::Taylor, 3),
            Incompatible(Correction::Mean, 2),
            Incompatible(Correction::Mean, 3),
            Hybrid,
            Dilatation(Split::Thirds),
            Dilatation(Split::Halves),
            Dilatation(Split::Lame),
        ],
    }
}

impl Reference {
    /// The reference for an element. Where its material is not known it is the one that constant strains show. Of the elements that are
    /// right on these nodes the first that gives K is taken, or the isoparametric one.
    ///
    /// # Errors
    /// Why there is none.
    pub fn of(e: &DisplacementElement) -> Result<Self, String> {
        let mut all = Self::all(e)?;
        let same = all.iter().position(|r| r.off(&e.matrix) <= e.precision).unwrap_or(0);
        Ok(all.swap_remove(same))
    }

    /// The references for an element, the isoparametric one first; never none.
    pub(super) fn all(e: &DisplacementElement) -> Result<Vec<Self>, String> {
        let none = || format!("no element of the textbooks has {} nodes that lie like these", e.nodes.len());
        let (family, order) = Family::of(&e.outline, &e.nodes).ok_or_else(none)?;
        let hooke = match e.material {
            Some(m) => m.hooke() * m.thickness,
            None => displacement::hooke_seen(&e.matrix, &e.nodes, &e.outline),
        };
        let nodes: Vec<[f64; 2]> = order.iter().map(|&n| e.nodes[n]).collect();
        let of = |rule: &Variant| -> Result<Self, String> {
            let (order, nodes) = (order.clone(), nodes.clone());
            let mut reference = Reference { family, rule: *rule, matrix: DMatrix::zeros(0, 0), order, nodes, hooke };
            reference.matrix = reference.variant(&hooke, Variant::Right)?;
            Ok(reference)
        };
        let isoparametric = of(&Variant::Right)?;
        // Without a material the others may not exist.
        let others = also_right(family).iter().filter_map(|rule| of(rule).ok());
        Ok(std::iter::once(isoparametric).chain(others).collect())
    }

    /// K.
    pub fn matrix(&self) -> &DMatrix<f64> {
        &self.matrix
    }

    /// Its name, with the features that are not standard.
    pub fn words(&self) -> String {
        let family = self.family.words();
        match self.rule {
            Variant::Points(n) => format!("{family} with {n} × {n} points"),
            Variant::Incompatible(Correction::Taylor, _) => {
                format!("{family} with incompatible modes and Taylor's correction")
            }
            Variant::Incompatible(..) => format!("{family} with incompatible modes whose mean is subtracted"),
            Variant::Hybrid => format!("{family} of Pian and Sumihara"),
            Variant::Dilatation(Split::Lame) => {
                format!("{family} with one point for the part λ of its energy (selective integration)")
            }
            Variant::Dilatation(_) => format!("{family} with B-bar (mean dilatation)"),
            _ => family.into(),
        }
    }

    /// True if it is K = ∫ Bᵀ D B of conforming shape functions by enough points, so that its energies lie above the exact one.
    pub fn is_conforming(&self) -> bool {
        match self.rule {
            Variant::Points(n) => self.family == Family::Q4 || n > 2,
            Variant::Incompatible(..) | Variant::Hybrid | Variant::Dilatation(_) => false,
            _ => true,
        }
    }

    /// True if it is the sum of Bᵀ D B over its points.
    pub(super) fn is_isoparametric(&self) -> bool {
        matches!(self.rule, Variant::Right | Variant::Points(_))
    }

    /// How far a matrix is from it, relative to the largest entry.
    pub fn off(&self, k: &DMatrix<f64>) -> f64 {
        (k - &self.matrix).amax() / self.matrix.amax().max(f64::MIN_POSITIVE)
    }

    pub(super) fn variant(&self, hooke: &Matrix3<f64>, variant: Variant) -> Result<DMatrix<f64>, String> {
        self.on(&self.nodes, hooke, variant)
    }

    /// A variant of its matrix on other nodes, given in the order of the family.
    pub(super) fn on(
        &self,
        nodes: &[[f64; 2]],
        hooke: &Matrix3<f64>,
        variant: Variant,
    ) -> Result<DMatrix<f64>, String> {
        let variant = if variant == Variant::Right { self.rule } else { variant };
        Ok(self.placed(&self.family.stiffness(nodes, hooke, 1.0, variant)?))
    }

    /// The quadrature points of the reference; none where it is no sum over points.
    pub(super) fn points(&self) -> Vec<Point> {
        let points = self.is_isoparametric().then(|| self.family.points(&self.nodes, self.rule).ok());
        points.flatten().unwrap_or_default()
    }

    /// A matrix of the family, numbered as the element is.
    pub(super) fn placed(&self, own: &DMatrix<f64>) -> DMatrix<f64> {
        formulas::placed(own, &self.order)
    }

    /// Rows (x, y) in the order of the element, brought into that of the family.
    pub(super) fn in_order<T: Copy>(&self, rows: &[T]) -> Vec<T> {
        self.order.iter().map(|&n| rows[n]).collect()
    }
}
