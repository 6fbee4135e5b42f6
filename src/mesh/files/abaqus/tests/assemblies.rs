//! Parts, instances and the names of an assembly.

use super::{CELLS, NODES, heights, plate, points, read, read_with_notes, refused, sides};

const BOTTOM: [[f64; 2]; 3] = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]];

/// A part with the sets `sets`, and an assembly of `rest`.
fn deck(sets: &str, rest: &str) -> String {
    let part = plate("CPS4R", sets);
    format!("*PART, NAME=Block\n{part}*END PART\n*ASSEMBLY, NAME=All\n{rest}*END ASSEMBLY\n")
}

/// Two instances of the part, the second on the first.
const TWO: &str = "*INSTANCE, NAME=Block-1, PART=Block\n*END INSTANCE\n*INSTANCE, NAME=Block-2, PART=Block\n0., 1., 0.\n*END INSTANCE\n";
const ONE: &str = "*INSTANCE, NAME=Block-1, PART=Block\n*END INSTANCE\n";

#[test]
fn a_reference_point_leaves_the_sets_of_the_assembly_as_they_are() {
    let point = "*NODE\n1, 0.5, 7.\n*NSET, NSET=RP\n1\n";
    let sets = "*NSET, NSET=Bottom, INSTANCE=Block-1\n1, 2, 3\n*ELSET, ELSET=_Top_S3, INSTANCE=Block-1\n1, 2\n\
                *SURFACE, TYPE=ELEMENT, NAME=Top\n_Top_S3, S3\n";
    for instances in [ONE, TWO] {
        for rest in [format!("{instances}{point}{sets}"), format!("{point}{instances}{sets}")] {
            let raw = read(&deck("", &rest));
            assert_eq!(points(&raw, "Bottom"), BOTTOM);
            assert_eq!(points(&raw, "RP"), [[0.5, 7.0]]);
            assert_eq!(sides(&raw, "Top"), [[[1.0, 1.0], [0.0, 1.0]], [[2.0, 1.0], [1.0, 1.0]]]);
            assert_eq!(heights(&raw, "_Top_S3").len(), 4);
        }
    }
}

#[test]
fn the_name_of_a_set_is_the_assemblys_where_a_part_has_it_too() {
    let rest = format!(
        "{ONE}*NSET, NSET=SET-1, INSTANCE=Block-1, GENERATE\n1, 3, 1\n*ELSET, ELSET=Other, INSTANCE=Block-1\n1\n"
    );
    let part = "*NSET, NSET=Set-1\n1, 2, 3, 4, 5, 6\n*ELSET, ELSET=Set-1\n1, 2\n*ELSET, ELSET=Other\n2\n\
                *SURFACE, NAME=Other\nSet-1, S1\n";
    let (raw, notes) = read_with_notes(&deck(part, &rest));
    assert_eq!(points(&raw, "SET-1"), BOTTOM);
    assert_eq!(points(&raw, "Block-1.Set-1").len(), 6);
    assert_eq!(sides(&raw, "Block-1.Other").len(), 2);
    // The assembly has no set of elements of that name.
    assert_eq!(heights(&raw, "Set-1").len(), 4);
    assert_eq!((heights(&raw, "Other").len(), heights(&raw, "Block-1.Other").len()), (2, 2));
    assert!(notes.is_empty(), "{notes:?}");
}

#[test]
fn sets_of_several_parts_under_one_name_are_remarked_upon() {
    let part = plate("CPE4", "*ELSET, ELSET=Plate\n1, 2\n");
    let parts = format!("*PART, NAME=A\n{part}*END PART\n*PART, NAME=B\n{part}*END PART\n");
    let instances = "*INSTANCE, NAME=a, PART=A\n*END INSTANCE\n*INSTANCE, NAME=b, PART=B\n0, 1\n*END INSTANCE\n";
    let (raw, notes) = read_with_notes(&format!("{parts}{instances}"));
    assert_eq!((heights(&raw, "Plate").len(), heights(&raw, "b").len()), (8, 4));
    assert!(notes.len() == 1 && notes[0].contains("several parts") && notes[0].contains("Plate"), "{notes:?}");
}

#[test]
fn instances_may_have_meshes_of_their_own() {
    let parts = "*PART, NAME=Low\n*END PART\n*PART, NAME=High\n*END PART\n*ASSEMBLY, NAME=A\n";
    let own = plate("CPS4R", "*NSET, NSET=Base\n1, 2, 3\n");
    let wide = own.replace("3, 2, 0\n", "3, 3, 0\n").replace("6, 2, 1\n", "6, 3, 1\n");
    let sets = "*NSET, NSET=Top, INSTANCE=High-1\n4, 5, 6\n*SURFACE, NAME=Under\nHigh-1.E, S1\n";
    let raw = read(&format!(
        "{parts}*INSTANCE, NAME=Low-1, PART=Low\n{own}*END INSTANCE\n*INSTANCE, NAME=High-1, PART=High\n0., 1., 0.\n{wide}*END INSTANCE\n{sets}"
    ));
    assert_eq!(raw.points.len(), 12);
    assert_eq!((heights(&raw, "Low-1").len(), heights(&raw, "High-1").len()), (4, 4));
    assert!(heights(&raw, "Low-1").iter().all(|y| *y < 1.0) && heights(&raw, "High-1").iter().all(|y| *y > 1.0));
    assert_eq!(points(&raw, "Top"), [[0.0, 2.0], [1.0, 2.0], [3.0, 2.0]]);
    assert_eq!(sides(&raw, "Under"), [[[0.0, 1.0], [1.0, 1.0]], [[1.0, 1.0], [3.0, 1.0]]]);
    refused(&format!("{parts}*INSTANCE, NAME=Low-1, PART=Low\n{own}*END ASSEMBLY\n"), &["line 6", "no *END INSTANCE"]);
    refused(&format!("*PART, NAME=Low\n{own}"), &["line 1", "no *END PART"]);
}

#[test]
fn numbers_of_elements_are_kept_apart_where_only_they_clash() {
    let other = "*NODE\n11, 0, 0\n12, 1, 0\n13, 0, 1\n*ELEMENT, TYPE=CPS3\n1, 11, 12, 13\n";
    let parts = format!("*PART, NAME=A\n{}*END PART\n*PART, NAME=B\n{other}*END PART\n", plate("CPS4", ""));
    let instances = "*INSTANCE, NAME=a, PART=A\n*END INSTANCE\n*INSTANCE, NAME=b, PART=B\n0, 5\n*END INSTANCE\n";
    let raw = read(&format!("{parts}{instances}*NSET, NSET=N, INSTANCE=b\n12\n"));
    assert_eq!((heights(&raw, "a").len(), heights(&raw, "b").len()), (4, 1));
    assert_eq!(points(&raw, "N"), [[1.0, 5.0]]);
}

#[test]
fn names_of_an_instance_are_found_under_its_own() {
    let part = "*NSET, NSET=Low\n1, 2, 3\n*NSET, NSET=High\n4, 5, 6\n*SURFACE, NAME=Lid\nE, S3\n";
    let rest = format!(
        "{TWO}*NSET, NSET=foot\nBlock-1.Low\n*NSET, NSET=head\nALL.block-2.HIGH\n*NSET, NSET=corners\nBlock-1.1, Block-2.6\n\
         *NSET, NSET=seam, INSTANCE=Block-2\nLow\n*SURFACE, NAME=Master\nBlock-1.E, S3\n*SURFACE, NAME=Slave\nBlock-2.2, S1\n\
         *SURFACE, TYPE=NODE, NAME=Dots\nBlock-2.Low, 1.\n*SURFACE, NAME=Both, COMBINE=UNION\nMaster, Block-2.Lid\n\
         *NSET, NSET=cells, INSTANCE=Block-2, ELSET=E\n"
    );
    let raw = read(&deck(part, &rest));
    assert_eq!(points(&raw, "foot"), BOTTOM);
    assert_eq!(points(&raw, "head"), BOTTOM.map(|[x, _]| [x, 2.0]));
    assert_eq!(points(&raw, "corners"), [[0.0, 0.0], [2.0, 2.0]]);
    assert_eq!(points(&raw, "seam"), BOTTOM.map(|[x, _]| [x, 1.0]));
    assert_eq!(points(&raw, "Dots"), points(&raw, "seam"));
    assert_eq!(sides(&raw, "Master"), [[[1.0, 1.0], [0.0, 1.0]], [[2.0, 1.0], [1.0, 1.0]]]);
    assert_eq!(sides(&raw, "Slave"), [[[1.0, 1.0], [2.0, 1.0]]]);
    let both = sides(&raw, "Both");
    assert!(
        both.len() == 4
            && both[..2].iter().flatten().all(|p| p[1] == 1.0)
            && both[2..].iter().flatten().all(|p| p[1] == 2.0)
    );
    assert!(points(&raw, "cells").len() == 6 && points(&raw, "cells").iter().all(|p| p[1] >= 1.0));
}

#[test]
fn sets_may_be_listed_before_they_are_defined() {
    let raw = read(&plate(
        "CPE4",
        "*NSET, NSET=All\nBot, All, 6\n*SURFACE, NAME=S\nLate, S1\n*NSET, NSET=Bot\n1, 2, 3\n*ELSET, ELSET=Late\n2\n",
    ));
    assert_eq!(points(&raw, "All"), [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 1.0]]);
    assert_eq!(sides(&raw, "S"), [[[1.0, 0.0], [2.0, 0.0]]]);
}

#[test]
fn members_that_are_not_there_are_told_with_their_line() {
    let after = |sets: &str| plate("CPE4", sets);
    refused(&after("*NSET, NSET=N\n1, 2\nNowhere\n"), &["line 13", "node set 'Nowhere'"]);
    refused(&after("*ELSET, ELSET=N\nBlock-1.E\n"), &["line 12", "element set 'Block-1.E'"]);
    refused(&after("*NSET, NSET=N, ELSET=Nowhere\n"), &["line 11", "element set 'Nowhere'"]);
    refused(&after("*NSET, NSET=N, INSTANCE=None\n1\n"), &["line 12", "*INSTANCE 'None'"]);
    refused(&after("*SURFACE, NAME=S\n9, S1\n"), &["line 12", "element 9"]);
    refused(&after("*SURFACE, NAME=S, COMBINE=UNION\nT\n"), &["line 11", "surface 'T'"]);
    refused(&after("*NSET, NSET=A\nB\n*NSET, NSET=B\nA\n"), &["lists itself"]);
    refused(&after("*SURFACE, NAME=A, COMBINE=UNION\nB\n*SURFACE, NAME=B, COMBINE=UNION\nA\n"), &["lists itself"]);
    refused(&deck("*NSET, NSET=Low\n1\n", &format!("{ONE}*NSET, NSET=N\nLow\n")), &["node set 'Low'", "INSTANCE.SET"]);
    refused(
        &deck("", &format!("{ONE}*NSET, NSET=N, INSTANCE=Block-1\nLow\n")),
        &["node set 'Low' in the instance 'Block-1'"],
    );
    // Numbers that no node has are left out, and told.
    let (raw, notes) =
        read_with_notes(&after("*NSET, NSET=N\n1, 99\n*NSET, NSET=M, GENERATE\n2, 18446744073709551615\n"));
    assert_eq!((points(&raw, "N").len(), points(&raw, "M").len()), (1, 5));
    assert!(notes.len() == 1 && notes[0].contains("N (99)"), "{notes:?}");
}

#[test]
fn sets_listed_in_sets_cost_no_more_than_their_members() {
    let mut text = plate("CPE4", "*NSET, NSET=N0\n1, 2\n*SURFACE, NAME=S0\nE, S1\n");
    for i in 1..60 {
        let before = i - 1;
        text += &format!(
            "*NSET, NSET=N{i}\nN{before}, N{before}\n*SURFACE, NAME=S{i}, COMBINE=UNION\nS{before}, S{before}\n"
        );
    }
    let raw = read(&text);
    assert_eq!((points(&raw, "N59").len(), sides(&raw, "S59").len()), (2, 2));
    let forward: String = (0..100_000).map(|i| format!("*NSET, NSET=N{i}\nN{}\n", i + 1)).collect();
    refused(&format!("{NODES}*ELEMENT, TYPE=CPE4\n{CELLS}{forward}*NSET, NSET=N100000\n1\n"), &["more than 64 sets"]);
}
