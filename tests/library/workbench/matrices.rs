//! Stiffness matrices that are wrong on purpose: each is named by a property that fails and by the mistake that explains it.

use hypercircle::scene::Kinematics;
use hypercircle::workbench::formulas::{Family, Variant};
use hypercircle::workbench::{DisplacementElement, Material, Options, Order, Report};
use nalgebra::DMatrix;

const MATERIAL: Material = Material { kinematics: Kinematics::PlaneStrain, young: 210.0, poisson: 0.3, thickness: 0.5 };

/// Nodes without symmetry.
fn nodes(family: Family) -> Vec<[f64; 2]> {
    let corners = [[0.1, -0.1], [1.2, 0.1], [0.9, 1.1], [-0.1, 0.8]];
    let middle = |i: usize, j: usize| [0, 1].map(|c| 0.5 * (corners[i][c] + corners[j][c]));
    match family {
        Family::P1 => corners[..3].to_vec(),
        Family::P2 => [&corners[..3], &[middle(0, 1), middle(1, 2), middle(2, 0)]].concat(),
        Family::Q4 => corners.to_vec(),
        Family::Q8 => {
            let middles = [(0, 1), (1, 2), (2, 3), (3, 0)].map(|(i, j)| middle(i, j));
            [&corners[..], &middles[..]].concat()
        }
        Family::Q9 => {
            let centre = [0, 1].map(|c| 0.25 * corners.iter().map(|x| x[c]).sum::<f64>());
            [nodes(Family::Q8), vec![centre]].concat()
        }
    }
}

fn right(family: Family) -> DMatrix<f64> {
    family.stiffness(&nodes(family), &MATERIAL.hooke(), MATERIAL.thickness, Variant::Right).expect("regular")
}

fn examined(family: Family, k: &DMatrix<f64>, material: Option<Material>) -> Report {
    let element = DisplacementElement::of_matrix("mine", k, nodes(family), Order::Interleaved, material);
    Report::of_displacement(&element.expect("a matrix"), &Options::default())
}

fn failing(report: &Report) -> Vec<&str> {
    report.findings.iter().filter(|f| f.is_missing()).map(|f| f.name.as_str()).collect()
}

/// The property must be among those that fail, and the diagnosis must have this cause.
#[track_caller]
fn named(family: Family, k: &DMatrix<f64>, property: &str, cause: &str) -> String {
    let report = examined(family, k, Some(MATERIAL));
    let missing = failing(&report);
    assert!(!report.passed && missing.contains(&property), "{cause}: {missing:?}");
    let diagnosis = report.diagnosis.expect("a diagnosis");
    assert_eq!(diagnosis.cause, cause, "{family:?}: {}", diagnosis.sentence);
    assert!(diagnosis.explained > 0.999_999, "{}", diagnosis.sentence);
    diagnosis.sentence
}

#[test]
fn right_matrices_pass_with_and_without_a_material() {
    for family in Family::ALL {
        for material in [Some(MATERIAL), None] {
            let report = examined(family, &right(family), material);
            assert!(report.passed && report.diagnosis.is_none(), "{}", report.verdict);
            // What one matrix cannot tell has not passed.
            for name in ["patch-solved", "rotation", "incompressible", "convergence"] {
                let finding = report.finding(name).expect("there");
                assert_eq!((finding.passed, finding.claim), (None, false), "{}", finding.in_words());
            }
            let seen = report.finding("patch-energy").expect("there");
            assert_eq!(seen.passed.is_some(), material.is_some());
            assert!(
                material.is_some() || seen.sentence.contains("E t = 105 and ν = 0.3 in plane strain"),
                "{}",
                seen.sentence
            );
        }
    }
}

/// On a distorted quadrilateral the integrand is no polynomial: three by three points give another matrix, which is no mistake.
#[test]
fn more_quadrature_points_are_no_mistake() {
    let k = Family::Q4.stiffness(&nodes(Family::Q4), &MATERIAL.hooke(), MATERIAL.thickness, Variant::Points(3));
    let k = k.expect("regular");
    assert!((&k - right(Family::Q4)).amax() > 1e-6 * k.amax());
    let report = examined(Family::Q4, &k, Some(MATERIAL));
    let reference = report.finding("reference").expect("there");
    assert!(reference.passed == Some(true) && reference.sentence.contains("3 × 3 points"), "{}", reference.sentence);
    // Nor do they hide one.
    let hooke = MATERIAL.in_other_kinematics().hooke();
    let k = Family::Q4.stiffness(&nodes(Family::Q4), &hooke, MATERIAL.thickness, Variant::Points(3));
    named(Family::Q4, &k.expect("regular"), "patch-energy", "plane-state");
}

#[test]
fn a_wrong_sign_is_named() {
    for family in Family::ALL {
        named(family, &-right(family), "definiteness", "sign");
    }
}

#[test]
fn one_point_quadrature_is_named() {
    for family in [Family::P2, Family::Q4, Family::Q8, Family::Q9] {
        let k = family.stiffness(&nodes(family), &MATERIAL.hooke(), MATERIAL.thickness, Variant::OnePoint);
        named(family, &k.expect("regular"), "rank", "one-point-quadrature");
    }
}

/// Two by two points are enough for Q8, which has one motion without energy that no neighbour shares, and too few for Q9.
#[test]
fn reduced_quadrature_of_the_biquadratic_element_is_named() {
    let reduced = |family: Family| {
        let k = family.stiffness(&nodes(family), &MATERIAL.hooke(), MATERIAL.thickness, Variant::Points(2));
        k.expect("regular")
    };
    named(Family::Q9, &reduced(Family::Q9), "rank", "reduced-quadrature");
    let report = examined(Family::Q8, &reduced(Family::Q8), Some(MATERIAL));
    assert_eq!(report.finding("reference").expect("there").passed, Some(true));
}

#[test]
fn shear_that_counts_twice_is_named_with_its_factor() {
    for family in Family::ALL {
        let mut hooke = MATERIAL.hooke();
        hooke[(2, 2)] *= 2.0;
        let k = family.stiffness(&nodes(family), &hooke, MATERIAL.thickness, Variant::Right).expect("regular");
        let sentence = named(family, &k, "patch-energy", "shear");
        assert!(sentence.contains("shear counts 2 times"), "{sentence}");
    }
}

#[test]
fn plane_stress_for_plane_strain_is_named() {
    for family in Family::ALL {
        let hooke = MATERIAL.in_other_kinematics().hooke();
        let k = family.stiffness(&nodes(family), &hooke, MATERIAL.thickness, Variant::Right).expect("regular");
        let sentence = named(family, &k, "patch-energy", "plane-state");
        assert!(sentence.contains("plane stress and not of plane strain"), "{sentence}");
    }
}

#[test]
fn another_material_is_named_with_its_constants() {
    let other = Material { young: 70.0, poisson: 0.2, ..MATERIAL };
    for family in Family::ALL {
        let k = family.stiffness(&nodes(family), &other.hooke(), other.thickness, Variant::Right).expect("regular");
        let sentence = named(family, &k, "patch-energy", "material");
        assert!(sentence.contains("E t = 35 and ν = 0.2 in plane strain"), "{sentence}");
        let sentence = named(family, &(right(family) * 1000.0), "patch-energy", "factor");
        assert!(sentence.contains("1000 times"), "{sentence}");
    }
}

#[test]
fn an_unsymmetric_matrix_is_named_with_its_entries() {
    for family in Family::ALL {
        let mut k = right(family);
        k[(0, 3)] += 0.1 * k.amax();
        let sentence = named(family, &k, "symmetry", "unsymmetric");
        assert!(sentence.contains("(0, 3)") && sentence.contains("1 of"), "{sentence}");
    }
}

#[test]
fn another_order_of_nodes_is_named() {
    for family in Family::ALL {
        let n = family.nodes().len();
        let mut order: Vec<usize> = (0..n).collect();
        order.swap(1, 2);
        let at = right(family);
        let place = |i: usize| 2 * order[i / 2] + i % 2;
        let k = DMatrix::from_fn(2 * n, 2 * n, |i, j| at[(place(i), place(j))]);
        let sentence = named(family, &k, "patch-forces", "node-order");
        assert!(sentence.contains("nodes 0, 2, 1"), "{sentence}");
    }
}

#[test]
fn another_order_of_unknowns_is_named() {
    for family in Family::ALL {
        let (n, at) = (family.nodes().len(), right(family));
        let place = |i: usize| if i < n { 2 * i } else { 2 * (i - n) + 1 };
        let k = DMatrix::from_fn(2 * n, 2 * n, |i, j| at[(place(i), place(j))]);
        named(family, &k, "patch-forces", "component-order");
        let blocked = DisplacementElement::of_matrix("mine", &k, nodes(family), Order::Blocked, Some(MATERIAL));
        assert!(Report::of_displacement(&blocked.expect("a matrix"), &Options::default()).passed);
    }
}

#[test]
fn a_transposed_jacobian_is_named() {
    for family in Family::ALL {
        let k = family.stiffness(&nodes(family), &MATERIAL.hooke(), MATERIAL.thickness, Variant::Transposed);
        named(family, &k.expect("regular"), "patch-energy", "transposed-jacobian");
    }
}

/// A formula shows what one matrix on a regular shape does not: a Jacobian that is forgotten, an element tied to its axes.
#[test]
fn mistakes_that_only_a_formula_shows_fail_there() {
    let forgotten = |nodes: &[[f64; 2]], m: &Material| {
        let k = Family::Q4.stiffness(nodes, &m.hooke(), m.thickness, Variant::Right)?;
        let area = 0.5
            * ((nodes[2][0] - nodes[0][0]) * (nodes[3][1] - nodes[1][1])
                - (nodes[3][0] - nodes[1][0]) * (nodes[2][1] - nodes[0][1]));
        Ok(k / area)
    };
    let tied = |nodes: &[[f64; 2]], m: &Material| {
        let mut hooke = m.hooke();
        hooke[(0, 0)] *= 1.5;
        Family::P1.stiffness(nodes, &hooke, m.thickness, Variant::Right)
    };
    let formula = DisplacementElement::of_formula("forgotten", Family::Q4.nodes(), MATERIAL, forgotten).expect("made");
    let report = Report::of_displacement(&formula, &Options::default());
    let missing = failing(&report);
    assert!(!missing.contains(&"patch-energy"), "the area of the square is one");
    assert!(["patch-distorted", "scaling"].iter().all(|name| missing.contains(name)), "{missing:?}");
    let formula = DisplacementElement::of_formula("tied", Family::P1.nodes(), MATERIAL, tied).expect("made");
    let report = Report::of_displacement(&formula, &Options::default());
    assert!(failing(&report).contains(&"rotation"), "{:?}", failing(&report));
    // It is stiffer than the material: no energy below the bound, and no convergence to the right one.
    assert!(failing(&report).contains(&"convergence") && !failing(&report).contains(&"bound"));
}

#[test]
fn a_formula_that_fails_is_a_finding_and_no_panic() {
    let fails =
        |nodes: &[[f64; 2]], m: &Material| match nodes[0] == [0.0, 0.0] && nodes[1] == [1.0, 0.0] && m.poisson == 0.3 {
            true => Family::P1.stiffness(nodes, &m.hooke(), m.thickness, Variant::Right),
            false => Err("no such shape".to_string()),
        };
    let formula = DisplacementElement::of_formula("fails", Family::P1.nodes(), Material::USUAL, fails).expect("made");
    let report = Report::of_displacement(&formula, &Options::default());
    assert!(!report.passed && report.finding("rotation").is_some_and(|f| f.sentence.contains("no such shape")));
}

#[test]
fn what_is_no_element_is_refused() {
    let (k, nodes) = (right(Family::P1), nodes(Family::P1));
    let made = |k: &DMatrix<f64>, nodes: Vec<[f64; 2]>| {
        DisplacementElement::of_matrix("x", k, nodes, Order::Interleaved, None).err().expect("refused")
    };
    assert!(made(&k, nodes[..2].to_vec()).contains("2 nodes"));
    assert!(made(&k, vec![[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]]).contains("one line"));
    assert!(made(&k, vec![nodes[0], nodes[0], nodes[1]]).contains("same place"));
    assert!(made(&k, vec![[f64::NAN, 0.0], nodes[1], nodes[2]]).contains("node 0"));
    assert!(made(&DMatrix::identity(4, 4), nodes.clone()).contains("6 × 6"));
    assert!(made(&DMatrix::zeros(6, 6), nodes.clone()).contains("zero"));
    assert!(made(&(k * f64::INFINITY), nodes).contains("entry (0, 0)"));
}
