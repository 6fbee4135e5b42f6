//! Quantities of a scene: valid and invalid entries of the file, and the vertices that they add to the mesh.

use std::path::{Path, PathBuf};

use crate::support::toml::Toml;
use hypercircle::problem::Problem;
use hypercircle::scene::{Component, Extent, Holder, Invariant, PointValue, Quantity, Region, Scene, Target};

fn root(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

fn text_of(path: &str) -> String {
    std::fs::read_to_string(root(path)).expect("part of the repository")
}

#[track_caller]
fn parsed(text: &str) -> Scene {
    Scene::parse(text, "scene.toml".as_ref()).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// Two blocks between a traction and a wall.
fn blocks(quantities: &str) -> String {
    format!("{}\n{quantities}\n", text_of("tests/malformed/valid/base.toml"))
}

#[test]
fn quantities_are_what_the_file_says() {
    let scene = Scene::read(&root("tests/malformed/valid/quantities.toml")).expect("a scene");
    let edge = |name: &str, direction| Target::Displacement { of: Extent::Boundary(name.into()), direction };
    let along = Component::along;
    let region = |points: &[[f64; 2]]| Region::Polygon(points.to_vec());
    let at = |body, at, value, smoothness| Target::Point { body, at, value, smoothness };
    let expected = [
        ("tip", edge("left_load", [1.0, 0.0])),
        ("free edge", edge("left_top", [0.6, -0.8])),
        ("drift", Target::Displacement { of: Extent::Body(0), direction: [0.0, -1.0] }),
        ("seat", Target::ContactForce { contact: 0, tangential: false, window: Some([0.1, 0.2, 0.3, 0.4]) }),
        (
            "from the beginning",
            Target::ContactForce { contact: 0, tangential: false, window: Some([0.0, 0.0, 0.25, 7.0]) },
        ),
        ("whole", Target::ContactForce { contact: 0, tangential: false, window: None }),
        ("rail", Target::SupportForce { support: 1, direction: [0.0, 1.0] }),
        ("tilt", Target::Moment { of: Holder::Support(0), about: [2.0, 0.5] }),
        ("turn", Target::Moment { of: Holder::Contact(0), about: [1.0, 0.0] }),
        ("all", Target::Stress { body: 1, region: Region::Whole, component: Component::XY }),
        (
            "core",
            Target::Stress {
                body: 0,
                region: region(&[[0.25, 0.25], [0.75, 0.25], [0.75, 0.5], [0.25, 0.5]]),
                component: Component::XX,
            },
        ),
        (
            "corner",
            Target::Stress {
                body: 0,
                region: region(&[[0.5, 0.0], [0.0, 0.5], [0.0, 0.0]]),
                component: along([1.0_f64 / 2.0_f64.sqrt(); 2]),
            },
        ),
        ("inner displacement", at(0, [0.25, 0.5], PointValue::Displacement([0.0, 1.0]), 4)),
        ("inner stress", at(1, [1.5, 0.5], PointValue::Stress(Component::YY), 3)),
        ("inner equivalent", at(0, [0.5, 0.5], PointValue::Invariant(Invariant::VonMises), 2)),
    ];
    let expected: Vec<_> = expected.map(|(name, target)| Quantity { name: name.into(), target }).into();
    assert_eq!(scene.quantities, expected);
    assert_eq!(scene.contact_breaks(0), [0.1, 0.2, 0.3, 0.4, 0.0, 0.0, 0.25, 7.0]);
    let used: Vec<_> = scene.boundary_names_used().into_iter().map(|(name, by)| format!("{name}: {by}")).collect();
    assert_eq!(used[5..], ["left_load: [[quantities]] number 1", "left_top: [[quantities]] number 2"]);
    assert!(parsed(&blocks("")).quantities.is_empty());
}

/// A quantity without its name, and what its refusal has to say.
const MALFORMED: &[(&str, &[&str])] = &[
    (
        "",
        &["does not say what is wanted", "give one of `displacement`, `force`, `moment`, `stress`, `stress_intensity`"],
    ),
    (
        "force = \"wall\"\nmoment = \"wall\"\nabout = [0, 0]",
        &["2 things at once: `force`, `moment`", "a table [[quantities]] with a name of its own"],
    ),
    ("displacement = \"left_laod\"", &["no boundary or body", "did you mean \"left_load\"?", "\"right\""]),
    ("displacement = \"\"", &["`displacement` in [[quantities]] number 1 is an empty string"]),
    ("displacement = \"left\"", &["no `direction`", "direction = [1.0, 0.0]"]),
    ("displacement = \"left\"\ndirection = [0, 0]", &["`direction`", "[0, 0]", "a direction has a length"]),
    ("displacement = \"left\"\ndirection = [nan, 1]", &["`direction`", "finite"]),
    ("displacement = \"left\"\ndirection = [1, 0, 0]", &["`direction`", "3 components, not 2"]),
    ("displacement = \"left\"\nwindow = [0, 1, 2, 3]", &["`window`", "does not go with `displacement`", "`force`"]),
    ("displacement = \"left\"\ncomponent = \"xx\"", &["`component`", "does not go with `displacement`", "`stress`"]),
    ("displacement = \"left\"\nbox = [[0, 0], [1, 1]]", &["`box`", "`displacement`", "a region"]),
    ("displacement = \"left\"\npoint = [0, 0]", &["no `direction`", "direction = [1.0, 0.0]"]),
    ("displacement = \"left_load\"\npoint = [0, 0]\ndirection = [1, 0]", &["\"left_load\"", "no body", "\"left\""]),
    ("displacement = \"left\"\npoint = [0]\ndirection = [1, 0]", &["`point`", "1 component, not 2"]),
    ("displacement = \"left\"\ndirection = [1, 0]\nsmoothness = 2", &["`smoothness`", "a value at a `point`"]),
    ("stress = \"left\"\npoint = [0, 0]\ncomponent = \"xx\"\nsmoothness = 2.5", &["2.5", "whole number from 0 to 6"]),
    ("stress = \"left\"\npoint = [0, 0]\ncomponent = \"xx\"\nbox = [[0, 0], [1, 1]]", &["both `point` and `box`"]),
    ("stress = \"left\"\npoint = [0, 0]\ncomponent = \"mises\"", &["\"mises\"", "\"von-mises\""]),
    ("stress = \"left\"\ncomponent = \"von-mises\"", &["`von-mises`", "a mean over a region", "point = [x, y]"]),
    ("force = \"left_face\"\npoint = [0, 0]", &["`point`", "does not go with `force`"]),
    ("stress_intensity = \"KI\"", &["no `tip`", "tip = [x, y]"]),
    ("stress_intensity = \"K1\"\ntip = [0, 0]", &["\"K1\"", "\"KI\""]),
    ("stress_intensity = \"KI\"\ntip = [0, 0]\ndirection = [1, 0]", &["`direction`", "`stress_intensity`"]),
    ("stress = \"left\"\ncomponent = \"xx\"\ntip = [0, 0]", &["`tip`", "only a `stress_intensity`"]),
    ("stress = \"left\"\nat = [0, 0]", &["unknown key `at`", "`point = [x, y]`"]),
    ("force = \"left\"", &["no contact or support", "\"left_face|right_face\"", "\"wall\""]),
    ("force = \"left_load\"\ndirection = [1, 0]", &["no contact or support", "\"left_load\""]),
    ("force = \"wall\"", &["no `direction`", "the force of the support"]),
    ("force = \"wall\"\ndirection = [1, 0]\nwindow = [0, 1, 2, 3]", &["`window`", "force of a support", "split"]),
    ("force = \"left_face\"\ndirection = [1, 0]", &["`direction`", "force of a contact", "delete `direction`"]),
    ("force = \"left_face\"\nwindow = [0.1, 0.2, 0.3]", &["`window`", "3 numbers, not 4", "[s0, s1, s2, s3]"]),
    ("force = \"left_face\"\nwindow = [0.1, inf, 0.3, 0.4]", &["`window`", "finite"]),
    ("force = \"left_face\"\nwindow = [0.1, 0.3, 0.2, 0.4]", &["`window`", "0.3, 0.2", "do not descend"]),
    ("force = \"left_face\"\nwindow = [0, 0, 0, 0]", &["`window`", "do not descend", "s2 < s3"]),
    (
        "force = \"left_face\"\nwindow = [0.1, 0.1000000000001, 0.2, 0.3]",
        &["s0 = s1", "no bounded functional", "a trapezoid"],
    ),
    ("force = \"left_face\"\nwindow = [0.1, 0.2, 0.3, 0.3]", &["s2 = s3", "no bounded functional", "beyond it"]),
    ("force = \"left_face\"\nwindow = [-4, -3, -2, -1]", &["begins at s = 0", "measure s along"]),
    ("moment = \"wall\"", &["no `about`", "about = [x, y]"]),
    ("moment = \"wall\"\nabout = [0, 0]\ndirection = [1, 0]", &["`direction`", "does not go with `moment`"]),
    ("moment = \"nothing\"\nabout = [0, 0]", &["`moment`", "no contact or support"]),
    ("stress = \"wall\"\ncomponent = \"xx\"", &["`stress`", "\"wall\"", "no body", "\"left\", \"right\""]),
    ("stress = \"left\"", &["neither `component` nor `direction`"]),
    ("stress = \"left\"\ncomponent = \"xx\"\ndirection = [1, 0]", &["both `component` and `direction`"]),
    ("stress = \"left\"\ncomponent = \"zz\"", &["`component`", "\"zz\"", "\"xx\", \"yy\", \"xy\""]),
    ("stress = \"left\"\ncomponent = \"xx\"\nabout = [0, 0]", &["`about`", "does not go with `stress`", "`moment`"]),
    (
        "stress = \"left\"\ncomponent = \"xx\"\nbox = [[0, 0], [1, 1]]\npolygon = [[0, 0], [1, 0], [0, 1]]",
        &["both `box` and `polygon`"],
    ),
    ("stress = \"left\"\ncomponent = \"xx\"\nbox = [[0, 0]]", &["`box`", "1 corner, not 2"]),
    ("stress = \"left\"\ncomponent = \"xx\"\nbox = [[0, 1], [1, 0]]", &["`box`", "y0 < y1", "upper right corner"]),
    ("stress = \"left\"\ncomponent = \"xx\"\nbox = [[0, 0, 0], [1, 1]]", &["`box[0]`", "3 components, not 2"]),
    ("stress = \"left\"\ncomponent = \"xx\"\npolygon = [[0, 0], [1, 0]]", &["has 2 corners", "at least 3"]),
    (
        "stress = \"left\"\ncomponent = \"xx\"\npolygon = [[0, 0], [1, 1], [1, 0], [0, 1]]",
        &["the polygon of [[quantities]] number 1", "edges 1 and 3 meet", "in order"],
    ),
    ("stress = \"left\"\ncomponent = \"xx\"\npolygon = [[0, 0], [1, 1], [2, 2]]", &["no area"]),
];

#[test]
fn a_malformed_quantity_is_refused_in_the_right_words() {
    let refuse = |text: &str, fragments: &[&str]| {
        let message = Scene::parse(text, "scene.toml".as_ref()).expect_err(text).to_string();
        for fragment in fragments {
            assert!(message.contains(fragment), "`{fragment}` is not in: {message}");
        }
    };
    for (quantity, fragments) in MALFORMED {
        refuse(&blocks(&format!("[[quantities]]\nname = \"q\"\n{quantity}")), fragments);
    }
    let named = |name: &str| format!("[[quantities]]\nname = {name}\nforce = \"left_face\"\n");
    refuse(&blocks("[[quantities]]\nforce = \"left_face\""), &["[[quantities]] number 1 has no `name`", "the report"]);
    refuse(&blocks(&named("\" \"")), &["`name` in [[quantities]] number 1 is an empty string"]);
    refuse(&blocks(&named("\"a=b\"")), &["contains the sign =", "--tolerance-of"]);
    refuse(&blocks(&named("\"a\\tb\"")), &["cannot be shown", "another name"]);
    refuse(
        &blocks(&(named("\"q\"") + &named("\"p\"") + &named("\"q\""))),
        &["scene.toml:49:", "\"q\": [[quantities]] number 1 (line 43) and [[quantities]] number 3", "another name"],
    );
    let two = blocks("[[quantities]]\nname = \"q\"\ndisplacement = \"left\"\ndirection = [1, 0]");
    refuse(&two.replace("left_top", "left"), &["the name of a body and of a boundary", "another name"]);
    let two = blocks("[[quantities]]\nname = \"q\"\nforce = \"left_face|right_face\"\ndirection = [1, 0]");
    refuse(
        &two.replace("\"wall\"", "\"left_face|right_face\""),
        &["the name of [[contacts]] number 1 and of [[supports]] number 1"],
    );
}

/// The places among `wanted` that are no vertices of the first contact, up to a thousandth of a millionth.
fn missing(problem: &Problem, wanted: &[f64]) -> Vec<f64> {
    let arcs: Vec<f64> = problem.interfaces[0].pairs.iter().flat_map(|pair| pair.arc).collect();
    wanted.iter().copied().filter(|s| !arcs.iter().any(|arc| (arc - s).abs() < 1e-9)).collect()
}

fn said(problem: &Problem) -> Vec<&str> {
    problem.notes.iter().map(|note| note.text.as_str()).collect()
}

/// The problem of the text with and without its quantities.
fn both(text: &str, quantities: &str, path: &Path) -> [Problem; 2] {
    [text.to_owned(), format!("{text}\n{quantities}")].map(|text| {
        let scene = Scene::parse(&text, path).unwrap_or_else(|error| panic!("{error}\n{text}"));
        Problem::load(scene).unwrap_or_else(|error| panic!("{error}\n{text}"))
    })
}

#[test]
fn windows_have_vertices_where_they_bend() {
    // The sum of 0.1 and 0.2 is not 0.3: no two vertices a rounding error apart.
    let windows = "[[quantities]]\nname = \"a\"\nforce = \"left_face|right_face\"\nwindow = [0.13, 0.2, 0.3, 0.77]\n\
                   [[quantities]]\nname = \"b\"\nforce = \"right_face\"\nwindow = [0.0, 0.0, 0.30000000000000004, 9.0]\n";
    let [_, problem] = both(&blocks(""), windows, Path::new("scene.toml"));
    let bends = [0.13, 0.2, 0.3, 0.77];
    assert!(missing(&problem, &bends).is_empty());
    assert!(problem.interfaces[0].pairs.iter().all(|pair| pair.length > 0.01 && pair.second.is_some()));
    assert!(missing(&problem.refine_uniform(1).expect("refines"), &bends).is_empty());
    assert!(said(&problem).is_empty(), "{:?}", said(&problem));
}

#[test]
fn windows_on_a_mesh_from_a_file_say_so_and_say_nothing_about_the_gap() {
    let cases = [
        ("from_gmsh", "foot|seat", [0.11, 0.52, 0.87, 1.43]),
        // Between the rows of a table of gaps, every 0.05.
        ("hertz_rigid", "foot|rigid", [0.012, 0.38, 0.62, 0.79]),
    ];
    for (case, contact, window) in cases {
        let path = root(&format!("cases/{case}.toml"));
        let quantity = format!("[[quantities]]\nname = \"a\"\nforce = \"{contact}\"\nwindow = {window:?}");
        let [without, with] = both(&text_of(&format!("cases/{case}.toml")), &quantity, &path);
        assert_eq!(missing(&without, &window), window, "the mesh has them already");
        assert!(missing(&with, &window).is_empty());
        let new: Vec<&str> = said(&with).into_iter().filter(|text| !said(&without).contains(text)).collect();
        assert_eq!(new, [format!("contact {contact}: 4 vertices inserted where windows of quantities bend")]);
        let gap = &with.scene.contacts[0].gap;
        for pair in &with.interfaces[0].pairs {
            for (s, g) in pair.arc.into_iter().zip(pair.gap) {
                assert!((g - gap.at(s)).abs() < 1e-12);
            }
        }
    }
}

#[test]
fn a_mean_displacement_uses_the_boundary_it_names() {
    let blocks = |name: &str, file: PathBuf| {
        let text = format!(
            "model.kinematics = \"plane-strain\"\nmesh.file = {file:?}\n\
             bodies.left = {{ young = 1.0, poisson = 0.3 }}\nbodies.right = {{ young = 1.0, poisson = 0.3 }}\n\
             supports = [{{ on = \"wall\", type = \"clamped\" }}]\ntractions = [{{ on = \"load\", pressure = 1.0 }}]\n\
             contacts = [{{ between = [\"left_face\", \"right face\"] }}]\n\
             quantities = [{{ name = \"q\", displacement = \"{name}\", direction = [1, 0] }}]\n"
        );
        Problem::load(parsed(&text)).map_err(|error| error.to_string())
    };
    let mesh = root("tests/meshes/two_blocks_22.msh");
    let unused = |name| {
        let problem = blocks(name, mesh.clone()).expect("a problem");
        said(&problem).iter().any(|text| text.contains("does not mention the physical curve 'left_bottom'"))
    };
    assert!(unused("left") && unused("load") && !unused("left_bottom"));
    let message = blocks("left_botom", mesh.clone()).expect_err("there is none");
    for fragment in
        ["boundary 'left_botom' does not exist", "did you mean 'left_bottom'?", "the bodies are left, right"]
    {
        assert!(message.contains(fragment), "{message}");
    }
    let folder = tempfile::tempdir().expect("a folder");
    let renamed = folder.path().join("renamed.msh");
    std::fs::write(&renamed, text_of("tests/meshes/two_blocks_22.msh").replace("\"left_bottom\"", "\"left\""))
        .expect("writes");
    let message = blocks("left", renamed).expect_err("a body and a boundary");
    assert!(message.contains("boundary 'left' has the name of a body") && message.contains("'q'"), "{message}");
}

#[test]
fn regions_and_points_far_away_stay_where_they_are() {
    let [x, y] = [1e8, -2e8];
    let quantities = format!(
        "[[quantities]]\nname = \"m\"\nmoment = \"s0\"\nabout = [{:?}, {y:?}]\n\
         [[quantities]]\nname = \"s\"\nstress = \"b\"\ncomponent = \"yy\"\nbox = [[{x:?}, {y:?}], [{:?}, {:?}]]",
        x + 0.25,
        x + 0.5,
        y + 1.0
    );
    let corners = [[x, y], [x + 1.0, y], [x + 1.0, y + 1.0], [x, y + 1.0]];
    let text = Toml::default().polygon("b", &corners, ["s0", "", "", ""]).clamp("s0").table(&quantities).text();
    let scene = Problem::load(parsed(&text)).expect("a problem").scene;
    assert_eq!(scene.origin, [x + 0.5, y + 0.5]);
    assert_eq!(scene.quantities[0].target, Target::Moment { of: Holder::Support(0), about: [-0.25, -0.5] });
    let Target::Stress { region: Region::Polygon(points), .. } = &scene.quantities[1].target else { panic!("a box") };
    assert_eq!(*points, [[-0.5, -0.5], [0.0, -0.5], [0.0, 0.5], [-0.5, 0.5]]);
}
