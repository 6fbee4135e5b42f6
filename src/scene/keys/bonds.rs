//! Bonds: two boundaries that move as one.

use super::conditions::Taken;
use super::springs::layer;
use crate::scene::reading::error::{Fault, SceneError};
use crate::scene::reading::raw::{At, RawBond, Table};
use crate::scene::reading::source::counted;
use crate::scene::{ContactSides, Normals, Scene};

/// Two boundaries that are glued to each other. Their vertices need not be the same.
#[derive(Debug, Clone, PartialEq)]
pub struct Bond {
    /// The boundaries, which coincide as polylines.
    pub sides: [String; 2],
    /// Force per area and relative displacement, normal and tangential and both positive, of an elastic layer between them; `None`
    /// where they move as one.
    pub stiffness: Option<[f64; 2]>,
    /// Unit vector along which sides that need not coincide are matched: the second is moved onto the first.
    pub direction: Option<[f64; 2]>,
}

impl Bond {
    /// Name used in reports and messages: `first|second`.
    pub fn name(&self) -> String {
        format!("{}|{}", self.sides[0], self.sides[1])
    }
}

/// Two boundaries whose vertices are made to match: the sides of a contact, or of a bond.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Joint<'a> {
    /// `contact` or `bond`.
    pub kind: &'static str,
    /// The boundaries.
    pub sides: &'a [String; 2],
    /// The direction along which they are matched; `None` where they coincide.
    pub direction: Option<[f64; 2]>,
    /// True if the sides may be those of a contact across a distance, along normals that turn.
    pub turns: bool,
}

impl Joint<'_> {
    /// How messages call it: `contact a|b`.
    pub fn name(&self) -> String {
        let Joint { kind, sides: [first, second], .. } = self;
        format!("{kind} {first}|{second}")
    }

    /// True if its sides are those of a bond.
    pub fn is_bond(&self) -> bool {
        self.kind == "bond"
    }

    /// As [`Self::name`], with the name quoted for errors.
    pub fn quoted(&self) -> String {
        let Joint { kind, sides: [first, second], .. } = self;
        format!("{kind} '{first}|{second}'")
    }
}

impl Scene {
    /// Every two boundaries that are made to match: contacts between two sides first, then bonds.
    pub(crate) fn joints(&self) -> impl Iterator<Item = Joint<'_>> {
        let contacts = self.contacts.iter().filter_map(|contact| match &contact.sides {
            ContactSides::Between(sides) => Some(Joint {
                kind: "contact",
                sides,
                direction: contact.direction,
                turns: contact.normals == Normals::Smooth && contact.direction.is_none(),
            }),
            ContactSides::Rigid(_) => None,
        });
        contacts.chain(self.bonds.iter().map(Bond::joint))
    }
}

impl Bond {
    /// The bond as two boundaries that are made to match.
    pub(crate) fn joint(&self) -> Joint<'_> {
        Joint { kind: "bond", sides: &self.sides, direction: self.direction, turns: false }
    }
}

/// Checks one entry of `[[bonds]]`.
pub(in crate::scene) fn bond(raw: &At<Table<RawBond>>, table: &str, taken: &mut Taken) -> Result<Bond, SceneError> {
    let Table(bond) = &raw.value;
    let remedy = "name the two boundaries that are glued to each other";
    let stiffness = bond.stiffness.as_ref().map(|k| layer(k, table, taken.source)).transpose()?;
    let along = "write the direction from the first side to the second, like [0.0, -1.0]";
    let direction = bond.direction.as_ref().map(|d| taken.source.unit(d, (table, "direction"), along)).transpose()?;
    Ok(Bond { sides: taken.between(&bond.between, table, remedy)?, stiffness, direction })
}

impl Taken<'_> {
    /// The two different boundaries of `between`, which from now on belong to `table`.
    pub(in crate::scene) fn between(
        &mut self,
        between: &At<Vec<At<String>>>,
        table: &str,
        remedy: &'static str,
    ) -> Result<[String; 2], SceneError> {
        let [first, second] = between.value.as_slice() else {
            let found = counted(between.value.len(), "name");
            let (key, expected) = ("between".to_owned(), "2".to_owned());
            let fault = Fault::Count { key, table: table.to_owned(), found, expected, remedy };
            return Err(self.source.error(between.span(), fault));
        };
        if first.value == second.value && !first.value.trim().is_empty() {
            let fault = Fault::SelfContact { name: first.value.clone(), table: table.to_owned() };
            return Err(self.source.error(second.span(), fault));
        }
        Ok([self.claim(first, table, "between")?, self.claim(second, table, "between")?])
    }
}
