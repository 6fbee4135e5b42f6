//! On whose word the bracket of a report holds.

use schemars::JsonSchema;
use serde::Serialize;

use crate::problem::Note;

/// On whose word a bracket holds.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Guarantee {
    /// How far it goes.
    pub level: GuaranteeLevel,
    /// The same in words, with who verified it, or why it does not go farther.
    pub words: String,
}

/// How far a guarantee goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum GuaranteeLevel {
    /// Verified in exact arithmetic by the checker, a program that shares nothing with this one.
    Proved,
    /// By theory, rounding being enclosed by this program itself.
    Guaranteed,
    /// For the data as represented on the mesh alone.
    NotGuaranteed,
}

impl Guarantee {
    /// The guarantee on this program's own word: guaranteed, unless one of the notes weakens that.
    pub fn of_notes(notes: &[Note]) -> Self {
        match notes.iter().find(|note| note.weakens_guarantee) {
            None => {
                Guarantee { level: GuaranteeLevel::Guaranteed, words: "guaranteed (rounding enclosed)".to_string() }
            }
            Some(note) => Guarantee {
                level: GuaranteeLevel::NotGuaranteed,
                words: format!("not guaranteed for the scene as written, because {}", note.text.trim_end_matches('.')),
            },
        }
    }

    /// Verified by the checker of this name and version; what the data stand for is still as the notes say.
    pub fn proved_by(self, checker: &str) -> Self {
        let proved = format!("proved (verified in exact arithmetic by {checker})");
        match self.level {
            GuaranteeLevel::NotGuaranteed => {
                Guarantee { words: format!("{proved} for the data on the mesh; {}", self.words), ..self }
            }
            _ => Guarantee { level: GuaranteeLevel::Proved, words: proved },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_proof_is_for_the_data_that_it_is_of() {
        let plain = Guarantee::of_notes(&[Note { weakens_guarantee: false, text: "A remark.".to_string() }]);
        assert_eq!(plain.level, GuaranteeLevel::Guaranteed);
        let proved = plain.proved_by("hypercircle-check 0.1.0");
        assert_eq!(proved.level, GuaranteeLevel::Proved);
        assert_eq!(proved.words, "proved (verified in exact arithmetic by hypercircle-check 0.1.0)");
        let weak = Guarantee::of_notes(&[Note { weakens_guarantee: true, text: "the gap bends.".to_string() }]);
        assert_eq!(weak.words, "not guaranteed for the scene as written, because the gap bends");
        let proved = weak.proved_by("a checker");
        assert_eq!(proved.level, GuaranteeLevel::NotGuaranteed);
        assert!(
            proved
                .words
                .starts_with("proved (verified in exact arithmetic by a checker) for the data on the mesh; not")
        );
    }
}
