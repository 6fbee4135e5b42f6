//! `why.html`: the page for a reader who doubts. It says why the bracket is guaranteed, with the figures of this run, and how to
//! check it without this program.

use maud::{Markup, PreEscaped, html};

use super::style::CSS;
use crate::report::document::document;
use crate::report::figure::bracket::bracket;
use crate::report::text::number::{at_most_percent, clean, digits_to_tell, enclosing, grouped, percent, significant};
use crate::report::text::words::upper_from;
use crate::report::{DualSummary, Energy, GuaranteeLevel, Report};

/// The name of the file.
pub(crate) const NAME: &str = "why.html";

/// First line of the file; a file of another origin with this name begins otherwise.
pub(crate) const BEGINS: &str = "<!-- hypercircle: why this number is guaranteed -->\n";

/// The page; `None` where there is no bracket to explain.
pub fn why(report: &Report) -> Option<String> {
    let (energy, dual) = (report.energy.as_ref()?, report.dual.as_ref()?);
    let title = format!("{} · why is this number guaranteed?", clean(&report.title));
    let body = html! {
        header {
            h1 { "Why is this number guaranteed?" }
            p.sub { bdi { (clean(&report.title)) } ", scene " bdi { code { (clean(&report.scene)) } } }
            (claim(report, energy))
        }
        main {
            (from_below(energy, dual))
            (from_above(report, energy))
            (between(energy))
            (rounding(energy))
            (check(report, energy))
            (assumed(report))
            (again(report))
        }
    };
    Some(format!("{BEGINS}{}", document(&title, &[CSS], Some(&report.run), body)))
}

/// The two ends, rounded outwards so that what is printed still encloses what is known.
fn ends(energy: &Energy) -> [String; 2] {
    let [lower, upper] = [energy.lower, energy.upper];
    enclosing([lower, upper], digits_to_tell(lower, upper).max(6) + 2)
}

fn claim(report: &Report, energy: &Energy) -> Markup {
    let [lower, upper] = ends(energy);
    let (class, word) = match energy.guarantee.level {
        GuaranteeLevel::Proved => ("agree", "Proved"),
        GuaranteeLevel::Guaranteed => ("agree", "Guaranteed"),
        GuaranteeLevel::NotGuaranteed => ("undecided", "Not guaranteed for the scene as written"),
    };
    html! {
        div class=(format!("verdict {class}")) {
            div {
                div.word { (word) }
                p { "The exact energy 𝓛(u) of this scene is no less than " b { (lower) } " and no more than " b { (upper) } "." }
                p {
                    "The computed stress is therefore within " b { (at_most_percent(energy.relative_error_bound)) } " of the exact one, in the norm of the elastic energy, "
                    "without an estimate, a constant that nobody knows, or a finer mesh."
                }
                p { "On whose word: " (clean(&energy.guarantee.words)) "." }
            }
        }
        figure.asked { (PreEscaped(bracket(report))) }
    }
}

/// True if friction takes part in the energy.
fn rubs(energy: &Energy) -> bool {
    energy.friction_work.is_some()
}

fn from_below(energy: &Energy, dual: &DualSummary) -> Markup {
    let degrees = match (dual.degree_min, dual.degree_max) {
        (least, most) if least == most => format!("degree {most}"),
        (least, most) => format!("degrees {least} to {most}"),
    };
    html! {
        section {
            h2 { "1. A stress in equilibrium gives a number that is not above" }
            p {
                "Take any stress λ that balances the loads in every body, meets the tractions and pulls nowhere on a contact. Write Π(λ) = ½∫ aλ : λ − ∫ T(λ)·u" sub { "0" } " − ∫ T" sub { "n" } "(λ) g "
                "for the energy that it stores, less its work on prescribed displacements and gaps. The exact stress has the least Π of all of them, and there Π(σ) = −𝓛(u). So −Π(λ) ≤ 𝓛(u), "
                "whoever computed λ and however badly."
                @if rubs(energy) { " Friction asks of λ that its traction along a contact is nowhere above the given bound τ̄, and adds nothing to Π." }
            }
            p {
                "This run has such a stress on " b { (grouped(dual.triangles)) } " triangles, with polynomials of " (degrees) ", found by the method " code { (clean(&dual.method)) } ". Its equilibrium is measured afterwards on "
                "the stress itself, by code that the method does not share: what is missing is " b { (significant(dual.equilibrium_residual, 3)) } " of the applied load, which is rounding and is accounted for below. "
                "It gives −Π(λ) = " b { (ends(energy)[0]) } "."
            }
        }
    }
}

fn from_above(report: &Report, energy: &Energy) -> Markup {
    let others = report.primal.iter().filter(|primal| primal.name != energy.upper_from);
    html! {
        section {
            h2 { "2. A displacement without penetration gives a number that is not below" }
            p {
                "The exact displacement has the least energy 𝓛(v) = ½∫ c e(v) : e(v) − ∫ F·v − ∫ P·v of all that keep the supports and do not penetrate. So 𝓛(u) ≤ 𝓛(v) for any of them, whoever made it. "
                "That v respects supports and contact holds along whole edges, and not at nodes alone."
                @if rubs(energy) { " Where v slides by v" sub { "t" } ", friction adds ∫ τ̄ |v" sub { "t" } "| to 𝓛(v)." }
            }
            p {
                "The best one here, " b { (upper_from(&energy.upper_from)) } ", gives 𝓛(v) = " b { (ends(energy)[1]) } "."
            }
            @for primal in others {
                p {
                    (clean(&primal.name)) " has the energy " (significant(primal.energy, 8))
                    @if primal.admissible { ", an upper bound as well." } @else { ". It penetrates or misses a support by more than rounding, so that its energy bounds nothing." }
                }
            }
        }
    }
}

fn between(energy: &Energy) -> Markup {
    let local = energy.free_upper.zip(energy.gap_local).map(|(upper, local)| {
        let gap = upper - energy.lower;
        (gap, local, (gap - local).abs() / energy.complementary.abs().max(f64::MIN_POSITIVE))
    });
    html! {
        section {
            h2 { "3. The gap bounds the error of both" }
            p {
                "Prager and Synge (1947): if λ is in equilibrium and v is admissible, the exact stress lies on a sphere in the space of stresses with the distance from c e(v) to λ as a diameter, and contact only takes from it. "
                "So neither is farther from the exact stress than √(2·gap) in the energy norm. Here the gap is " b { (significant(energy.gap, 6)) } ", the stress stores 𝒮(λ) = "
                (significant(energy.complementary, 6)) ", and √(gap/𝒮) = " b { (percent(energy.relative_error_bound)) } "."
            }
            @if let Some((gap, local, apart)) = local {
                p {
                    "The gap is computed twice. As the difference of two energies of the whole scene, of the free displacement that the stress gives, it is " (significant(gap, 6)) "; as a sum over triangles and contacts of terms none of which is "
                    "negative, ½∫ a(λ − c e(v)) : (λ − c e(v)) and ∫ (−T" sub { "n" } ")(g − [v" sub { "n" } "])"
                    @if rubs(energy) { ", with friction also ∫ (τ̄ |v" sub { "t" } "| + T" sub { "t" } " v" sub { "t" } ")" }
                    ", it is " (significant(local, 6)) ". They are computed by code of their own and differ by "
                    b { (significant(apart, 2)) } " of 𝒮. A load that one of them forgets, a sign, or a missing row shows here."
                }
            }
        }
    }
}

fn rounding(energy: &Energy) -> Markup {
    let part = energy.widening / energy.gap.abs().max(f64::MIN_POSITIVE);
    html! {
        section {
            h2 { "4. Rounding is on the safe side" }
            p {
                "Computers round. Sums of energies are compensated, what rounding can have cost them is bounded term by term, and what is missing of equilibrium is counted with the largest work that it can do. "
                "All of it together, " b { (significant(energy.widening, 3)) } ", is subtracted from the lower end and added to the upper one: " (percent(part)) " of the gap."
            }
        }
    }
}

fn check(report: &Report, energy: &Energy) -> Markup {
    let scene = format!("{}.toml", clean(&report.scene));
    html! {
        section #check {
            h2 { "5. Check it without this program" }
            p {
                code { "proof.npz" } " beside this page holds the stress, the displacement and the scene. " code { "hypercircle-check" } " is a short Python program by itself, which shares nothing with the one that made this page. It finds, in rational "
                "arithmetic, a stress exactly in equilibrium and a displacement exactly admissible beside those of the file, and encloses their energies in intervals:"
            }
            div.scroll { pre { code { "pip install ./checker\nhypercircle-check proof.npz --scene " (scene) } } }
            p {
                "Its exit code is 0 if the bracket holds, and it prints the two numbers that it proved. "
                @match energy.guarantee.level {
                    GuaranteeLevel::Proved => { "It has done so when this page was made: " (clean(&energy.guarantee.words)) "." },
                    _ => { "When this page was made, it was not run, or did not prove all of it: " (clean(&energy.guarantee.words)) "." },
                }
            }
            p {
                "A doubter needs no program at all: one stress in equilibrium with −Π above " (ends(energy)[1]) ", or one admissible displacement with an energy below " (ends(energy)[0]) ", would refute this page."
            }
        }
    }
}

fn assumed(report: &Report) -> Markup {
    let weakening = report.notes.iter().filter(|note| note.weakens_guarantee);
    html! {
        section {
            h2 { "6. What is assumed" }
            ul {
                li { "The model: linear elasticity and small displacements, in the kinematics, with the materials, loads and contacts that the scene file says. That a part behaves so is for its engineer to say." }
                li { "The theorem of section 1 to 3." }
                li { "The figure: the bodies are the triangles of this run. A curved boundary is what the scene says of it." }
                @for note in weakening { li { b { "This weakens the guarantee: " } (clean(&note.text)) } }
            }
            p { "Nothing is assumed about the mesh, about the convergence of an iteration, or about a constant: a stress that was found badly makes the interval wide, and never wrong." }
        }
    }
}

fn again(report: &Report) -> Markup {
    let provenance = &report.provenance;
    let rows = [
        ("command", provenance.command_line.as_str()),
        ("program", provenance.version.as_str()),
        ("date", provenance.date.as_str()),
        ("SHA-256 of the scene", provenance.scene_sha256.as_str()),
        ("SHA-256 of the mesh as solved", provenance.mesh_sha256.as_str()),
        ("SHA-256 of the versions of all libraries", provenance.lock_sha256.as_str()),
        ("run", report.run.as_str()),
    ];
    html! {
        section {
            h2 { "7. Make it again" }
            p { "Numbers repeat bit by bit for one build and number of threads." }
            table {
                tbody { @for (name, value) in rows { @if !value.is_empty() { tr { td { (name) } td.long { code { (clean(value)) } } } } } }
            }
            p {
                "W. Prager, J. L. Synge: Approximations in elasticity based on the concept of function space. Quart. Appl. Math. 5 (1947), 241–269. "
                "J. Haslinger, I. Hlaváček: Contact between elastic bodies. III. Dual finite element analysis. Apl. Mat. 26 (1981), 321–344."
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::problem::Note;
    use crate::report::sample::{Sample, Verdict};

    #[test]
    fn it_says_what_the_report_knows_and_stands_alone() {
        let sample = Sample::new(3, Verdict::Agree);
        let mut dossier = sample.dossier();
        let page = why(&dossier.report).expect("a bracket");
        let energy = dossier.report.energy.clone().expect("a bracket");
        for end in ends(&energy) {
            assert!(page.contains(&end), "{end}");
        }
        assert!(page.contains("hypercircle-check proof.npz"));
        for forbidden in ["<script", "<link", "@import", "url(", "src=", "<a&b>"] {
            assert!(!page.contains(forbidden), "{forbidden}");
        }
        dossier.report.energy = None;
        assert!(why(&dossier.report).is_none());
    }

    #[test]
    fn friction_is_told_where_it_takes_part() {
        let sample = Sample::new(3, Verdict::Agree);
        let mut dossier = sample.dossier();
        let mut told = |work: Option<f64>| {
            dossier.report.energy.as_mut().expect("a bracket").friction_work = work;
            why(&dossier.report).expect("a bracket").matches("τ̄").count()
        };
        assert_eq!((told(None), told(Some(0.25))), (0, 3));
    }

    #[test]
    fn a_guarantee_that_is_weakened_is_not_claimed() {
        let sample = Sample::new(3, Verdict::Agree);
        let mut dossier = sample.dossier();
        dossier.report.notes.push(Note { weakens_guarantee: true, text: "The gap bends between vertices.".into() });
        if let Some(energy) = &mut dossier.report.energy {
            energy.guarantee = crate::report::Guarantee::of_notes(&dossier.report.notes);
        }
        let page = why(&dossier.report).expect("a bracket");
        assert!(
            page.contains("Not guaranteed for the scene as written") && page.contains("This weakens the guarantee")
        );
    }

    #[test]
    fn printed_ends_enclose_what_is_known() {
        let sample = Sample::new(3, Verdict::Agree);
        let mut energy = sample.dossier().report.energy.expect("a bracket");
        (energy.lower, energy.upper) = (-1.797_262_459_67, -1.796_075_585_32);
        let [lower, upper] = ends(&energy).map(|end| end.replace('−', "-").parse::<f64>().expect("a number"));
        assert!(
            lower <= energy.lower && upper >= energy.upper && upper - lower < 1.001 * (energy.upper - energy.lower)
        );
    }
}
