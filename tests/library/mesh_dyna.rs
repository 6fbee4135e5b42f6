//! Keyword files of LS-DYNA by hand, in the manner of its manual: the plate of `mesh_formats` goes in as it is, and what is no plane mesh is refused.

use crate::mesh_formats::{Folder, LIMIT, check, refused, rows, scene};
use hypercircle::mesh::inventory::Inventory;
use hypercircle::problem::Problem;

/// Numbers in columns of one width.
fn columns(width: usize, list: &[usize]) -> String {
    list.iter().map(|n| format!("{n:width$}")).collect::<String>() + "\n"
}

/// Nodes and shells in columns of `width` for a number; a triangle has its third node twice, or no fourth.
fn mesh(width: usize, marks: &str) -> String {
    let reals = width.max(16);
    let nodes = rows(|n, [x, y]| format!("{n:width$}{x:reals$.6}{y:reals$.6}{:reals$.1}\n", 0.0));
    let shells = [[1, 1, 1, 2, 5, 4], [2, 2, 2, 3, 6, 6], [3, 2, 2, 6, 5, 0]].map(|row| columns(width, &row)).concat();
    format!("*NODE{marks}\n$#   nid               x\n{nodes}*ELEMENT_SHELL{marks}\n$#   eid     pid\n{shells}")
}

const PARTS: &str = "*PART\n$# title\nleft side\n$#     pid     secid       mid\n         1         7         1\nright side\n         2         7         1\n\
                     *SECTION_SHELL\n         7        13       1.0         2\n       1.0       1.0\n*MAT_ELASTIC\n         1       1.0       1.0       0.3\n";
const SETS: &str = "*SET_NODE_LIST_TITLE\nwall\n         5       0.0\n         1         4         0\n*SET_SEGMENT_TITLE\nload\n        10       0.0\n         3         6         0         0\n";

fn deck(mesh: &str) -> String {
    format!("$ by hand\n*KEYWORD\n*TITLE\nplate\n{mesh}{PARTS}{SETS}*END\n")
}

fn notes(folder: &Folder, text: &str) -> String {
    let found = Inventory::read(&folder.write("plate.k", text), LIMIT).expect("a mesh");
    found.notes.into_iter().map(|note| note.text + "\n").collect()
}

#[test]
fn keyword_files_in_all_their_forms() {
    let folder = Folder::new();
    let names = (["left side", "right side"], ["wall", "load"]);
    for name in ["plate.k", "plate.key", "plate.dyn", "plate.K"] {
        check(&folder.write(name, deck(&mesh(8, ""))), &names.0, names.1);
    }
    check(&folder.write("i10.k", deck(&mesh(10, "")).replace("*KEYWORD", "*KEYWORD I10=Y")), &names.0, names.1);
    check(&folder.write("percent.k", deck(&mesh(10, " %"))), &names.0, names.1);
    check(&folder.write("joined.k", deck(&mesh(10, "%"))), &names.0, names.1);
    check(&folder.write("long.k", deck(&mesh(20, "+"))), &names.0, names.1);
    let plain = mesh(8, "");
    let commas = plain.lines().map(|line| match line.starts_with(['*', '$']) {
        true => format!("{line}\n"),
        false => line.split_whitespace().collect::<Vec<_>>().join(", ") + "\n",
    });
    check(&folder.write("commas.k", deck(&commas.collect::<String>())), &names.0, names.1);
    // Sets without a title have their numbers, in ranges too, and a card of thickness stands behind each shell.
    let numbered = deck(&mesh(8, ""))
        .replace("*SET_NODE_LIST_TITLE\nwall\n", "*SET_NODE_LIST_GENERATE\n")
        .replace("         1         4         0\n", "         1         1         4         4\n")
        .replace("*SET_SEGMENT_TITLE\nload\n", "*SET_SEGMENT\n");
    check(&folder.write("numbers.k", &numbered), &names.0, ["node_5", "segment_10"]);
    let thick = numbered.replace("*ELEMENT_SHELL", "*ELEMENT_SHELL_THICKNESS").lines().fold(
        (String::new(), false),
        |(text, inside), line| {
            let inside = if line.starts_with('*') { line.starts_with("*ELEMENT") } else { inside };
            let card = if inside && !line.starts_with(['*', '$']) { "             1.0             1.0\n" } else { "" };
            (format!("{text}{line}\n{card}"), inside)
        },
    );
    check(&folder.write("thick.k", thick.0), &names.0, ["node_5", "segment_10"]);
    let set = "*SET_SHELL_LIST_TITLE\nall\n         3\n         1         2         3\n*SET_SHELL_LIST_GENERATE_TITLE\nsame\n         4\n         1         9\n";
    for name in ["all", "same"] {
        check(&folder.write("set.k", deck(&mesh(8, "")).replace("*END", &format!("{set}*END"))), &[name], names.1);
    }
}

#[test]
fn decks_of_several_files_and_kinematics() {
    let folder = Folder::new();
    folder.write("meshes/mesh.k", mesh(8, ""));
    let whole = "*KEYWORD\n*INCLUDE_PATH_RELATIVE\nmeshes\n*INCLUDE\nmesh.k\n".to_string() + PARTS + SETS + "*END\n";
    let path = folder.write("plate.k", &whole);
    check(&path, &["left side", "right side"], ["wall", "load"]);
    assert!(!notes(&folder, &whole).contains("*END"));
    refused(&folder, "lost.k", whole.replace("mesh.k", "none.k"), &["line 5", "'none.k', which is not there"]);
    for (form, told) in [(12, "plane-stress"), (15, "axisymmetric")] {
        let path = folder
            .write("plate.k", deck(&mesh(8, "")).replace("        13       1.0", &format!("{form:10}       1.0")));
        let problem = Problem::load(scene(path, &["left side", "right side"], ["wall", "load"])).expect("a problem");
        let wanted = format!("ELFORM {form} of the mesh file are made for {told}");
        assert!(problem.notes.iter().any(|note| note.text.contains(&wanted)), "{:?}", problem.notes);
    }
}

/// The middles of sides are those of a triangle too, and 8 nodes of which one is missing are 4.
#[test]
fn second_order_shells() {
    let folder = Folder::new();
    let middles =
        [(7, 0.5, 0.0), (8, 1.0, 0.5), (9, 0.5, 1.0), (10, 0.0, 0.5), (11, 1.5, 0.0), (12, 2.0, 0.5), (13, 1.5, 0.5)]
            .map(|(n, x, y)| format!("{n:8}{x:16.6}{y:16.6}{:16.1}\n", 0.0))
            .concat();
    let rows =
        [[1, 1, 1, 2, 5, 4, 7, 8, 9, 10], [2, 1, 2, 3, 6, 6, 11, 12, 6, 13]].map(|row| columns(8, &row)).concat();
    let text = mesh(8, "").replace("*ELEMENT", &format!("{middles}*ELEMENT"));
    let start = text.find("$#   eid").expect("shells");
    let text = deck(&format!("{}{rows}{}", &text[..start], columns(8, &[3, 1, 2, 6, 5, 5, 13, 0, 0, 8])));
    let told = notes(&folder, &text);
    assert!(told.contains("mid-nodes of 2 second-order cells") && !told.contains("chord"), "{told}");
    let curved = text.replace("       8        1.000000        0.500000", "       8        1.100000        0.500000");
    assert!(notes(&folder, &curved).contains("1 curved side"), "{}", notes(&folder, &curved));
}

#[test]
fn what_is_left_out_of_a_deck_is_told() {
    let folder = Folder::new();
    let text = deck(&mesh(8, ""));
    let more = "*ELEMENT_MASS\n       1       1             1.0\n*SET_NODE_GENERAL\n         8\nALL\n*SET_NODE_LIST\n         9\n         1        99\n*END";
    let told = notes(&folder, &text.replace("*END", more));
    for part in ["*ELEMENT_MASS, *SET_NODE_GENERAL", "set 'node_9' has node 99, which the file does not have"] {
        assert!(told.contains(part), "{told}");
    }
    assert!(notes(&folder, text.trim_end_matches("*END\n")).contains("no *END"));
    let twins = notes(&folder, &text.replace("right side", "left side"));
    assert!(twins.contains("Several parts are called left side"), "{twins}");
    check(&folder.write("twins.k", text.replace("right side", "left side")), &["1", "2"], ["wall", "load"]);
}

#[test]
fn decks_that_are_no_plane_mesh_are_refused() {
    let folder = Folder::new();
    let good = deck(&mesh(8, ""));
    let after = |word: &str, more: &str| good.replace(word, &format!("{more}{word}"));
    let box_ = columns(8, &[9, 1, 1, 2, 5, 4, 3, 6, 5, 4]);
    for (name, text, fragments) in [
        (
            "letters.k",
            good.replace("       2       2       3", "       2       2      q3"),
            &["line 16", "'q3' stands where a whole number"][..],
        ),
        (
            "real.k",
            good.replace("        2.000000        1.000000", "        2.000000        1.x00000"),
            &["line 12", "'1.x00000' stands"],
        ),
        (
            "missing.k",
            good.replace("       2       2       3       6       6", "       2       2       3      66      66"),
            &["node 66"],
        ),
        (
            "shifted.k",
            good.replace("       2       2       2       3", "        2       2       2       3"),
            &["line 16", "no number or no part"],
        ),
        (
            "corner.k",
            good.replace("       2       2       3       6       6", "       2       2       3       0       0"),
            &["line 16", "no node at corner 3"],
        ),
        (
            "point.k",
            good.replace("       2       2       3       6       6", "       2       2       2       2       6"),
            &["no quadrilateral and no triangle"],
        ),
        (
            "tail.k",
            after("*PART", "*ELEMENT_SHELL_THICKNESS\n       9       1       1       2       5       4\n"),
            &["no card for THICKNESS", "cut off"],
        ),
        ("solid.k", after("*PART", &format!("*ELEMENT_SOLID\n{box_}")), &["cells in space: 1 × prism"]),
        (
            "particles.k",
            after("*PART", "*ELEMENT_SPH\n       1       1       1.0\n"),
            &["*ELEMENT_SPH", "*ELEMENT_SHELL"],
        ),
        ("moved.k", after("*PART", "*NODE_TRANSFORM\n         1         1\n"), &["*NODE_TRANSFORM is not read"]),
        ("turned.k", after("*PART", "*INCLUDE_TRANSFORM\nother.k\n"), &["*INCLUDE_TRANSFORM is not read"]),
        (
            "parameter.k",
            good.replace("        2.000000        1.000000", "          &width        1.000000"),
            &["'&width' stands"],
        ),
        ("secret.k", after("*PART", "*NODE\n-----BEGIN PGP MESSAGE-----\nabc\n"), &["encrypted"]),
        ("nothing.k", "*KEYWORD\n*END\n".to_string(), &["no node"]),
    ] {
        refused(&folder, name, &text, fragments);
    }
}
