//! The element workbench: what comes with the program is what it claims, and what is broken on purpose is named.

mod matrices;
mod rings;
mod stresses;

use std::sync::LazyLock;

use hypercircle::workbench::{Options, Report, SHIPPED, Shipped};

/// The reports on all elements that come with the program.
static REPORTS: LazyLock<Vec<(&'static str, Report)>> = LazyLock::new(|| {
    let of = |element: &'static Shipped| {
        let names = |list: &[&str]| list.iter().map(|name| name.to_string()).collect();
        let subject = element.subject().expect("can be made");
        (element.name, subject.examine(&Options { waived: names(element.lacks), claimed: names(element.adds) }))
    };
    SHIPPED.iter().map(of).collect()
});

/// The report on an element that comes with the program.
fn report(name: &str) -> &'static Report {
    &REPORTS.iter().find(|(known, _)| *known == name).expect("shipped").1
}

#[test]
fn shipped_elements_have_what_they_claim_and_lack_what_they_do_not() {
    for element in SHIPPED {
        let report = report(element.name);
        assert!(report.passed, "{}", report.verdict);
        for name in element.lacks {
            let finding = report.finding(name).expect("a property");
            assert_eq!(
                (finding.passed, finding.claim),
                (Some(false), false),
                "{}: {}",
                element.name,
                finding.in_words()
            );
        }
        for name in element.claims() {
            let finding = report.finding(name).expect("a property");
            assert_ne!(finding.passed, Some(false), "{}: {}", element.name, finding.in_words());
        }
    }
}

#[test]
fn spurious_modes_are_named_and_drawn() {
    let reduced = report("q4-reduced");
    let rank = reduced.finding("rank").expect("there");
    assert_eq!(rank.value, Some(2.0));
    assert!(rank.sentence.contains("hourglass"), "{}", rank.sentence);
    assert!(rank.picture.as_ref().is_some_and(|svg| svg.contains("2 of 2")));
    assert_eq!(reduced.diagnosis.as_ref().expect("differs from Q4").cause, "one-point-quadrature");
    let single = report("single-triangle");
    let rank = single.finding("traction-rank").expect("there");
    assert_eq!(rank.value, Some(2.0));
    assert!(rank.sentence.contains("spurious") && rank.picture.is_some(), "{}", rank.sentence);
}

/// Known of these elements: P1 and full Q4 lock, P2 and the block do not; Johnson and Mercier's space has dimension 15, nine of whose
/// fields are the block; the linear triangle has seven fields.
#[test]
fn known_figures_are_found() {
    let value = |element: &str, name: &str| report(element).finding(name).and_then(|f| f.value).expect("measured");
    assert!(value("p1", "incompressible") > 0.15 && value("q4", "incompressible") > 0.5);
    assert!(value("p2", "incompressible") < 0.01);
    assert_eq!(value("johnson-mercier", "dimension"), 6.0);
    assert_eq!(value("johnson-mercier", "span"), 0.0);
    assert_eq!(value("single-triangle", "dimension"), 2.0);
    assert!(value("p1", "convergence") < 0.1 && value("q4", "convergence") < 0.1);
}
