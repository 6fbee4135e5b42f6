//! The names of checks: what each asks, and of which field, contact or quantity.
//!
//! A name as text is stable, for `--allow NAME=VALUE` and for junit; here alone it is written and read. A new check is a variant here; the
//! compiler then asks for the sentence of its failure ([`crate::compare::Check`] has the others).

/// Upper bounds without a displacement model have this in place of a field.
pub const FREE_BOUND: &str = "free bound";

/// A family of names, each with a field or a contact between a beginning and an end.
macro_rules! family {
    ($(#[$of:meta])* $family:ident { $($(#[$doc:meta])* $variant:ident = $start:literal, $end:literal;)* }) => {
        $(#[$of])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum $family { $($(#[$doc])* $variant,)* }

        impl $family {
            /// All of them.
            pub const ALL: &'static [Self] = &[$(Self::$variant,)*];

            const fn ends(self) -> [&'static str; 2] {
                match self { $(Self::$variant => [$start, $end],)* }
            }

            /// The name of the check of `subject`.
            pub fn of(self, subject: &str) -> String {
                let [start, end] = self.ends();
                format!("{start}{subject}{end}")
            }

            /// The check of this family that has a name, with its subject.
            fn read(name: &str) -> Option<(Self, &str)> {
                let subject = |own: &Self| {
                    let [start, end] = own.ends();
                    name.strip_prefix(start)?.strip_suffix(end)
                };
                Self::ALL.iter().find_map(|own| Some((*own, subject(own)?)))
            }
        }
    };
}

family! {
    /// Checks of a displacement field.
    OfField {
        /// It meets its supports and does not penetrate.
        Admissible = "admissible/", "";
        /// Its guaranteed error is small.
        EnergyError = "certified/", "/energy-error";
        /// Friction limited by its own reactions carries what it does in the stresses.
        FrictionForce = "coulomb/", "/friction-force";
        /// Its energy with Coulomb friction is no less than the bound without.
        Coulomb = "energy/coulomb/", "";
        /// Its gap from energies is that from local terms.
        GapTwoWays = "energy/gap-two-ways/", "";
        /// Its energy is minus its strain energy.
        Identity = "energy/identity/", "";
        /// The lower bound is below its energy.
        LowerBelow = "energy/lower-below/", "";
        /// The energy that is reported is its energy.
        Recomputed = "energy/recomputed/", "";
        /// The strain energy that is reported is its own.
        Strain = "energy/strain/", "";
        /// It is in equilibrium in its own space.
        Equilibrium = "primal/equilibrium/", "";
        /// The reactions that are reported are those of its stresses.
        Reactions = "primal/reactions/", "";
        /// Its stresses are no farther from those in equilibrium than the energies allow.
        StressDifference = "stress/difference/", "";
    }
}

family! {
    /// Checks that compare a contact in stresses with that in the best displacement field.
    OfContact {
        /// The part that is open.
        OpenLength = "contact/", "/open-length";
        /// The largest pressures where the bracket explains their factor.
        PeakPressure = "contact/", "/peak-pressure";
        /// Pressures in the mean.
        PressureL2 = "contact/", "/pressure-l2";
        /// The largest pressures.
        PressureMax = "contact/", "/pressure-max";
        /// Reactions at vertices.
        Reactions = "contact/", "/reactions";
        /// The force.
        Resultant = "contact/", "/resultant";
    }
}

family! {
    /// Checks of a contact of a field that claims to be a discrete solution.
    OfSolutionContact {
        /// Nothing penetrates.
        Penetration = "solution/contact/", "/penetration";
        /// Nodes of a contact that holds in the mean.
        PenetrationAtNodes = "solution/contact/", "/penetration-at-nodes";
        /// Nothing pulls.
        Pulling = "solution/contact/", "/pulling";
        /// Nothing pushes where it is open.
        PressureWhereOpen = "solution/contact/", "/pressure-where-open";
        /// Friction follows its law.
        Friction = "solution/contact/", "/friction";
    }
}

family! {
    /// Checks without a subject.
    OfRun {
        /// The bracket tells models apart.
        Sharpness = "bracket/sharpness", "";
        /// The bracket is as narrow as was asked for.
        Tolerance = "bracket/tolerance", "";
        /// The stresses are in equilibrium.
        DualEquilibrium = "dual/equilibrium", "";
        /// The guaranteed error of a claimed solution leaves something of it.
        GuaranteedError = "solution/guaranteed-error", "";
        /// A claimed solution is in equilibrium.
        Residual = "solution/residual", "";
        /// A claimed solution meets its supports.
        Supports = "solution/supports", "";
        /// Forces of supports and contacts of a claimed solution balance the loads.
        SolutionReactions = "solution/reactions", "";
        /// Work and strain energy of a claimed solution go together.
        EnergyIdentity = "solution/energy-identity", "";
    }
}

impl OfRun {
    /// The name of the check.
    pub fn name(self) -> &'static str {
        self.ends()[0]
    }

    /// True if it asks about a claimed solution.
    pub fn is_of_solution(self) -> bool {
        use OfRun::{
            DualEquilibrium, EnergyIdentity, GuaranteedError, Residual, Sharpness, SolutionReactions, Supports,
            Tolerance,
        };
        match self {
            Sharpness | Tolerance | DualEquilibrium => false,
            GuaranteedError | Residual | Supports | SolutionReactions | EnergyIdentity => true,
        }
    }
}

/// What holds the value of a quantity against its interval, beside the displacement fields.
pub const GIVEN: &str = "given";
/// What asks for the width of the interval of a quantity.
pub const WIDTH: &str = "tolerance";

/// The name of the check that holds what `by` says of a quantity against its interval: a field, [`GIVEN`] or [`WIDTH`].
pub fn of_quantity(quantity: &str, by: &str) -> String {
    format!("quantity/{quantity}/{by}")
}

/// The name of the check that compares the energies of two displacement solutions of degrees p < q, both P or both Q.
pub fn of_order(letter: char, p: usize, q: usize) -> String {
    let letter = letter.to_ascii_lowercase();
    format!("energy/{letter}{p}-above-{letter}{q}")
}

/// The name of the check that holds a number against that of a baseline.
pub fn of_baseline(number: &str) -> String {
    format!("baseline/{number}")
}

/// A name that was read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Name<'a> {
    /// Nothing in particular.
    Run(OfRun),
    /// A displacement field.
    Field(OfField, &'a str),
    /// Two displacement solutions, `p1` and `p2`.
    Order(&'a str, &'a str),
    /// A contact.
    Contact(OfContact, &'a str),
    /// A contact of a claimed solution.
    SolutionContact(OfSolutionContact, &'a str),
    /// A quantity, and what holds against its interval.
    Quantity(&'a str, &'a str),
    /// A number of a baseline.
    Baseline(&'a str),
    /// Something that this program does not make.
    Other,
}

impl<'a> Name<'a> {
    /// Reads a name. Those of contacts, quantities and fields may contain slashes.
    pub fn read(text: &'a str) -> Self {
        if let Some((of, "")) = OfRun::read(text) {
            return Name::Run(of);
        }
        if let Some(number) = text.strip_prefix("baseline/") {
            return Name::Baseline(number);
        }
        if let Some((quantity, by)) = text.strip_prefix("quantity/").and_then(|rest| rest.rsplit_once('/')) {
            return Name::Quantity(quantity, by);
        }
        if let Some((of, contact)) = OfSolutionContact::read(text) {
            return Name::SolutionContact(of, contact);
        }
        if let Some((of, contact)) = OfContact::read(text) {
            return Name::Contact(of, contact);
        }
        if let Some((of, field)) = OfField::read(text) {
            return Name::Field(of, field);
        }
        match text.strip_prefix("energy/").and_then(|rest| rest.split_once("-above-")) {
            Some((low, high)) => Name::Order(low, high),
            None => Name::Other,
        }
    }

    /// The displacement field that it names.
    pub fn field(self) -> Option<&'a str> {
        match self {
            Name::Field(_, field) => Some(field),
            Name::Quantity(_, by) if ![GIVEN, WIDTH].contains(&by) => Some(by),
            _ => None,
        }
    }

    /// The contact that it names.
    pub fn contact(self) -> Option<&'a str> {
        match self {
            Name::Contact(_, contact) | Name::SolutionContact(_, contact) => Some(contact),
            _ => None,
        }
    }

    /// True if it asks about a claimed solution.
    pub fn is_of_solution(self) -> bool {
        match self {
            Name::Run(of) => of.is_of_solution(),
            Name::SolutionContact(..) => true,
            _ => false,
        }
    }
}

/// The names of the checks that a comparison of displacement `fields` in a scene with these `contacts` can make. Those that end
/// with their degree, as `FEniCSx P2` and `FEniCSx Q2` do, are also compared with each other.
pub fn names_of_checks(contacts: &[String], fields: &[String]) -> Vec<String> {
    let of_run = OfRun::ALL.iter().map(|of| of.name().to_string());
    let of_fields = OfField::ALL.iter().flat_map(|of| fields.iter().map(|field| of.of(field)));
    let of_contacts = OfContact::ALL.iter().flat_map(|of| contacts.iter().map(|contact| of.of(contact)));
    let of_solution = OfSolutionContact::ALL.iter().flat_map(|of| contacts.iter().map(|contact| of.of(contact)));
    let orders = ['P', 'Q'].into_iter().flat_map(|letter| {
        let degree = |field: &String| field.rsplit_once(&format!(" {letter}")).and_then(|(_, k)| k.parse().ok());
        let degrees: Vec<usize> = fields.iter().filter_map(degree).collect();
        degrees.windows(2).map(|pair| of_order(letter, pair[0], pair[1])).collect::<Vec<String>>()
    });
    of_run.chain(of_fields).chain(of_contacts).chain(of_solution).chain(orders).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_is_read_as_what_it_was_written_for() {
        let (contact, field) = ("a/b|c", "some/file.vtu");
        for of in OfRun::ALL {
            assert_eq!(Name::read(of.name()), Name::Run(*of));
        }
        for of in OfField::ALL {
            assert_eq!(Name::read(&of.of(field)), Name::Field(*of, field));
        }
        for of in OfContact::ALL {
            assert_eq!(Name::read(&of.of(contact)), Name::Contact(*of, contact));
        }
        for of in OfSolutionContact::ALL {
            assert_eq!(Name::read(&of.of(contact)), Name::SolutionContact(*of, contact));
        }
        assert_eq!(Name::read(&of_quantity("σ/yy", GIVEN)), Name::Quantity("σ/yy", GIVEN));
        assert_eq!(Name::read(&of_order('P', 1, 2)), Name::Order("p1", "p2"));
        assert_eq!(Name::read(&of_baseline("energy.upper")), Name::Baseline("energy.upper"));
        assert_eq!(Name::read("energy/wrong"), Name::Other);
    }
}
