//! Which mistake explains a field that is not the discrete solution it claims to be.
//!
//! The residual r = Q(K u − F) of a field, with Q what neither supports nor contacts can take, is linear in the loads and in the
//! elastic constants of every body. A wrong one of these leaves a residual in the span of a few columns, which least squares find;
//! mistakes that are not linear are made on purpose and held against the residual as well. Of the hypotheses that explain it
//! about equally well the simplest is named, of two together where none does alone, and none where none does. A hypothesis is one that somebody can have made
//! (`physical`) and has far fewer unknowns than the residual has numbers. What contact and
//! supports do shows in forces and displacements there and is read from them.

mod choice;
mod fit;
mod mistakes;
mod physical;
mod space;
mod words;

use schemars::JsonSchema;
use serde::Serialize;

use crate::compare::Solution;
use crate::compare::solution::SOLVER;
use choice::Limits;
use fit::Terms;
pub use mistakes::contact::in_the_mean;
use space::Space;

/// Of the squared residual what the nearest hypothesis explains where it lacks no more than digits.
const NEARLY_ALL: f64 = 0.95;

/// What is wrong with a field, as far as it can be told.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Diagnosis {
    /// Name of the field.
    pub field: String,
    /// All of it in a sentence or two.
    pub sentence: String,
    /// What was found; several take part together.
    pub findings: Vec<Finding>,
    /// Part of the squared residual that the findings explain; `null` where the residual is none.
    pub explained: Option<f64>,
    /// How many hypotheses were held against the residual.
    pub tried: usize,
}

/// One mistake.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Finding {
    /// Stable name, for example `body/left/young` or `contact/left_face|right_face/penalty`.
    pub name: String,
    /// What was found: a factor, a modulus, a stiffness, a shift.
    pub value: Option<f64>,
    /// What the scene says in its place.
    pub expected: Option<f64>,
    /// In words.
    pub sentence: String,
    /// The node where it is worst, counted as vertices, then midpoints of edges; `None` where that is not known.
    #[serde(skip)]
    pub node: Option<usize>,
}

impl Finding {
    fn new(name: impl Into<String>, value: Option<f64>, expected: Option<f64>, sentence: impl Into<String>) -> Self {
        Finding { name: name.into(), value, expected, sentence: sentence.into(), node: None }
    }

    fn at(self, node: Option<usize>) -> Self {
        Finding { node, ..self }
    }
}

impl Finding {
    /// True if it is read from forces along a contact, in which whatever else is wrong takes part.
    fn is_of_contact_forces(&self) -> bool {
        ["/glued", "/open", "/friction-law"].iter().any(|end| self.name.ends_with(end))
    }

    /// True if it is of the friction of a contact.
    fn is_of_friction(&self) -> bool {
        self.name.starts_with("contact/")
            && self.name.rsplit('/').next().is_some_and(|last| last == "sticks" || last.starts_with("friction"))
    }

    /// True if it asks for forces on a boundary that is a side of a contact named by one of the findings `told`.
    fn is_of_contact_in(&self, told: &[&str]) -> bool {
        let side = self.name.strip_prefix("boundary/").and_then(|rest| rest.strip_suffix("/forces"));
        let about = |side: &str, name: &&str| {
            let contact = name.strip_prefix("contact/").and_then(|rest| rest.rsplit_once('/'));
            contact.is_some_and(|(sides, _)| sides.split('|').any(|of| of == side))
        };
        side.is_some_and(|side| told.iter().any(|name| about(side, name)))
    }
}

/// A hypothesis after it was held against the residual.
struct Trial {
    /// The simpler the smaller.
    rank: usize,
    /// Remaining part of the squared residual.
    left: f64,
    findings: Vec<Finding>,
}

impl Trial {
    /// True if it has a number of every load, or of every body force, beside that of one of them.
    fn is_of_all_and_a_part(&self) -> bool {
        let is_load = |finding: &Finding| finding.name.starts_with("load/") || finding.name.ends_with("/body_force");
        let has = |name: &str| self.findings.iter().any(|finding| finding.name == name);
        let others = |name: &str| self.findings.iter().any(|finding| finding.name != name && is_load(finding));
        ["loads", "bodies/body_force"].into_iter().any(|whole| has(whole) && others(whole))
    }

    /// True if a finding of forces or displacements along supports and contacts stands beside this explanation, and is no consequence of
    /// it.
    fn leaves(&self, finding: &Finding) -> bool {
        let of_values = self.findings.iter().any(|f| f.name == "value" || f.name.starts_with("displacement/"));
        !of_values && !finding.is_of_contact_forces()
    }
}

/// Energies of a field as it is, and of an admissible one of its space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Energies {
    /// 𝓛 of the field.
    pub own: f64,
    /// 𝓛 of a field of the same space that does not penetrate, where there is one other than the field itself.
    pub admissible: Option<f64>,
    /// 𝓛 and ½a(u, u) as the program that made the field reports them, relative to those of the field.
    pub reported: Option<[f64; 2]>,
}

impl Energies {
    /// The thickness, where both energies are off by the same factor: no displacement shows it.
    fn thickness(&self, solution: &Solution<'_>) -> Option<Finding> {
        let [whole, strain] = self.reported?;
        let same = (whole - strain).abs() <= SOLVER && (whole - 1.0).abs() > SOLVER;
        let given = solution.problem.scene.thickness;
        let sentence = format!(
            "the thickness is {} times what the scene says: so are both energies reported",
            words::number(whole)
        );
        same.then(|| Finding::new("thickness", Some(whole * given), Some(given), sentence))
    }
}

/// Looks for what explains that `solution` is none; `None` where it is one.
pub fn diagnose(solution: &Solution<'_>, energies: Energies) -> Option<Diagnosis> {
    let mut findings = mistakes::supports::findings(solution);
    findings.extend(mistakes::contact::findings(solution, energies));
    findings.extend(energies.thickness(solution));
    let mut diagnosis = Diagnosis {
        field: solution.candidate.name.clone(),
        sentence: String::new(),
        findings,
        explained: None,
        tried: 0,
    };
    let mut nearest = Vec::new();
    if solution.residual() > solution.allowed() {
        let space = Space::new(solution);
        let mut terms = Terms::new(&space);
        let mut trials = hypotheses(&space, &mut terms);
        trials.extend(terms.alone());
        diagnosis.tried = trials.len();
        trials.retain(Trial::is_possible);
        // What contact does at a side is read from the contact itself.
        let told: Vec<&str> = diagnosis.findings.iter().map(|finding| finding.name.as_str()).collect();
        trials.retain(|trial| !trial.findings.iter().any(|finding| finding.is_of_contact_in(&told)));
        let limits = Limits::of(solution);
        let trials = limits.without_places(trials);
        let found = limits.simplest(trials).or_else(|trials| {
            let together = terms.together();
            diagnosis.tried += together.len();
            limits.simplest(together).map_err(|_| trials)
        });
        match found {
            Ok(trial) => {
                diagnosis.explained = Some(1.0 - trial.left);
                diagnosis.findings.retain(|finding| trial.leaves(finding));
                // Friction is read from forces that are not yet right.
                let (rubbing, direct) = diagnosis.findings.into_iter().partition(Finding::is_of_friction);
                diagnosis.findings = direct;
                diagnosis.findings.extend(trial.findings);
                diagnosis.findings.extend::<Vec<Finding>>(rubbing);
            }
            Err(_) if mistakes::single::finding(solution).is_some() => {
                diagnosis.explained = Some(1.0);
                diagnosis.findings.extend(mistakes::single::finding(solution));
            }
            Err(trials) => {
                diagnosis.explained = Some(0.0);
                nearest = choice::nearest(trials);
                diagnosis.findings.extend(mistakes::moved::rounded(solution));
                // Forces along contacts tell nothing while most of them belong to something else.
                if !nearest.is_empty() {
                    diagnosis.findings.retain(|finding| !finding.is_of_contact_forces());
                }
            }
        }
    }
    if diagnosis.findings.is_empty() && diagnosis.explained.is_none() {
        return None;
    }
    diagnosis.sentence = sentence(&diagnosis, &nearest);
    Some(diagnosis)
}

/// All that is held against the residual, with terms to be fitted put into `terms`.
fn hypotheses<'a>(space: &'a Space<'a>, terms: &mut Terms<'a>) -> Vec<Trial> {
    let revolved = space.problem().section().is_revolved();
    if revolved {
        mistakes::turned::terms(space, terms);
    } else {
        mistakes::material::terms(space, terms);
        mistakes::initial::terms(space, terms);
    }
    mistakes::loads::terms(space, terms);
    mistakes::springs::terms(space, terms);
    let mut trials = mistakes::values::trials(space);
    trials.extend(mistakes::outline::trials(space, terms));
    if revolved {
        trials.extend(mistakes::turned::trials(space));
    } else {
        trials.extend(mistakes::shift::trial(space, |_| vec![[0.0; 2]; space.count()]));
        trials.push(mistakes::material::other_state(space));
        trials.extend(mistakes::initial::in_the_mean(space));
        trials.extend(mistakes::layer::trials(space));
        trials.extend(mistakes::moved::trial(space));
        trials.extend(mistakes::lumped::trials(space));
        trials.extend(mistakes::integration::trials(space));
    }
    trials.extend(mistakes::material::laws(space));
    trials.extend(mistakes::anisotropic::trials(space));
    trials.extend(mistakes::sampled::trials(space));
    trials.extend(mistakes::local::trials(space));
    trials.extend(mistakes::contact::trials(space));
    trials.extend(mistakes::springs::trials(space));
    trials.extend(mistakes::loads::trials(space));
    trials
}

fn sentence(diagnosis: &Diagnosis, nearest: &[Trial]) -> String {
    let said: Vec<&str> = diagnosis.findings.iter().map(|f| f.sentence.as_str()).collect();
    let mut text = said.join("; ");
    if !text.is_empty() {
        let begin = if diagnosis.explained == Some(0.0) { "This was found" } else { "This explains it" };
        text = format!("{begin}: {text}.");
    }
    match (diagnosis.explained, nearest) {
        (Some(share), _) if share > 0.0 => {
            text += &format!(" It accounts for {} of the residual.", words::share(share));
        }
        (Some(_), []) => {
            let begin = if text.is_empty() { "" } else { " " };
            text += &format!("{begin}None of {} hypotheses explains the residual, nor half of it.", diagnosis.tried);
        }
        (Some(_), trials) => {
            let near = trials.iter().map(|t| words::list(&t.findings)).collect::<Vec<_>>().join(" or that ");
            let explained = 1.0 - trials.iter().map(|t| t.left).fold(0.0, f64::max);
            let share = words::share(explained);
            let begin = if text.is_empty() { "" } else { " " };
            let how = if explained >= NEARLY_ALL { " to the digits of the field" } else { "" };
            text += &format!(
                "{begin}None of {} hypotheses explains the residual{how}; the nearest, that {near}, would account for {share} of it.",
                diagnosis.tried
            );
        }
        (None, _) => {}
    }
    text
}
