//! Advice on each kind of failure: a likely reason, and a remedy to try.

/// The sort of mistake behind a failure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// A contact is missing, incomplete or another one.
    Contact,
    /// A support.
    Support,
    /// A load.
    Load,
    /// Elastic constants or the plane state.
    Material,
    /// The thickness.
    Thickness,
    /// The element, or how it is integrated.
    Element,
    /// A triangle, a vertex or an equation.
    Local,
    /// Displacements at the wrong nodes.
    Values,
    /// The mesh has moved.
    Moved,
    /// Numbers of too few digits.
    Precision,
    /// Equilibrium is missing for a reason that is not known.
    Equilibrium,
    /// An energy that is reported.
    Reported,
    /// Contact forces that are reported.
    Reactions,
    /// The bracket or the distance of the stresses.
    Bound,
    /// A field that is the solution of too coarse a mesh.
    Coarse,
    /// Work on prescribed displacements and gaps.
    Work,
    /// A quantity or a tolerance.
    Value,
}

impl Kind {
    /// The kind of a finding of a diagnosis, by its name.
    pub fn of_finding(name: &str) -> Self {
        match name.split('/').next().unwrap_or(name) {
            "contact" | "bond" => Kind::Contact,
            "support" => Kind::Support,
            "load" | "loads" => Kind::Load,
            "body" | "bodies"
                if [
                    "/body_force",
                    "/temperature",
                    "/temperature_gradient",
                    "/temperature_across",
                    "/initial_stress",
                    "/initial_stress_shear",
                ]
                .iter()
                .any(|end| name.ends_with(end)) =>
            {
                Kind::Load
            }
            "body" | "bodies" | "stiffness" | "kinematics" => Kind::Material,
            "thickness" => Kind::Thickness,
            "integration" => Kind::Element,
            "displacement" | "value" => Kind::Values,
            "points" => Kind::Moved,
            "precision" => Kind::Precision,
            "boundary" if name.ends_with("/forces") => Kind::Load,
            "boundary" => Kind::Support,
            "temperature" => Kind::Load,
            "revolution" => Kind::Element,
            _ => Kind::Local,
        }
    }

    /// True if the mistake can be seen better at one place than at another.
    pub fn has_place(self) -> bool {
        !matches!(self, Kind::Thickness | Kind::Moved | Kind::Precision)
    }

    /// True if the mistake itself is at the place that is named, and not only seen best there.
    pub fn is_local(self) -> bool {
        matches!(self, Kind::Contact | Kind::Support | Kind::Local | Kind::Load)
    }
}

/// Advice for a check that fails without any other.
pub const ALONE: [&str; 2] = [
    "Nothing else fails with it, so the models agree in the rest.",
    "Look at the picture of this check, and whether both models ask for the same thing.",
];

/// The likely reason for a failure of this kind, and a remedy to try; `name` is that of the finding.
pub fn of(kind: Kind, name: &str) -> [&'static str; 2] {
    let last = name.rsplit('/').next().unwrap_or(name);
    match (kind, last) {
        (Kind::Contact, "missing") => [
            "The rows of this contact are not in the system, or its two sides were not paired.",
            "Count the rows of the contact constraint: one for each vertex of the first side, and for degree 2 one for each edge. Look whether the \
             names of both boundaries were found.",
        ],
        (Kind::Contact, "in-part") => [
            "Rows of the contact constraint are missing at the marked nodes, or their nodes are paired with others.",
            "Print the pairs of this contact around the marked vertex. First and last vertex of a side, and those shared with a support, are lost most \
             often.",
        ],
        (Kind::Contact, "gap") => [
            "The right-hand side of the contact constraint is not the gap of the scene.",
            "Compare the gap at the marked vertex with `gap` of the scene: a gap that is ignored counts as zero, and one of a mesh may be counted twice.",
        ],
        (Kind::Contact, "penalty") => [
            "Contact is enforced by a penalty, which gives way.",
            "Raise the stiffness until the penetration no longer matters, or use multipliers.",
        ],
        (Kind::Contact, "weak") => [
            "Contact holds in the mean and not at the nodes, which is no mistake of a method that asks for no more; where it begins or ends, its \
             integration rule or an unfinished iteration leaves the rest.",
            "Hand the field in with `--contact weak`, and let that program iterate until its contact forces no longer change.",
        ],
        (Kind::Contact, "rigid") => [
            "The two sides share their displacements: the layer is a tie, or its nodes were merged.",
            "Give each side nodes of its own, and put springs of the stiffness of the scene between them.",
        ],
        (Kind::Contact | Kind::Support, "stiffness" | "normal" | "tangential") => [
            "The springs are not those of the scene: another stiffness, another direction, or integrated in another way.",
            "Their stiffness is force per area and displacement, not per node. Compare it in both directions, and its unit; ∫ k j φ of a linear edge has \
             1/3 and 1/6 of its length.",
        ],
        (Kind::Contact, "glued" | "pulling") => [
            "The constraint is an equation where it should be an inequality.",
            "Look at the active set: nodes whose force pulls have to leave it.",
        ],
        (Kind::Contact, "frictionless") => [
            "The tangential traction of this contact is not in the equations.",
            "Look whether the friction bound of this contact is read and given to both sides; a coefficient is no bound.",
        ],
        (Kind::Contact, "sticks") => [
            "Tangential jumps of this contact are held, whatever force that takes.",
            "Release a node along the contact where its tangential force is larger than its share of the bound, ∫τ̄φ.",
        ],
        (Kind::Contact, "friction-sign") => [
            "Friction pushes the sides on in the sense in which they slide.",
            "The traction on the first side is −τ̄ times the sign of its slip against the second; look at which side the jump is counted from.",
        ],
        (Kind::Contact, "friction-bound" | "friction-turned") => [
            "The friction bound is not that of the scene.",
            "Compare the bound as the model uses it with `friction` of the scene: unit, thickness, arc length, and whether it is counted once for \
             two sides.",
        ],
        (Kind::Contact, "tangential-penalty") => [
            "Sticking is enforced by a penalty, which gives way.",
            "Raise the tangential stiffness until the slip below the bound no longer matters, or use multipliers.",
        ],
        (Kind::Contact, "regularised") => [
            "The jump of the friction law at rest is smoothed, so that nothing ever sticks.",
            "Lower ε until the slip below the bound no longer matters, or use a method that knows sticking.",
        ],
        (Kind::Contact, "friction-law") => [
            "Nodes stick or slide where the law of friction says otherwise, or the iteration is not finished.",
            "Compare at the marked node the tangential force with ∫τ̄φ, and its sign with that of the slip.",
        ],
        (Kind::Contact, "tied" | "friction") => [
            "The sides cannot slide along each other.",
            "Constrain the jump along the direction of contact alone, and give the two sides vertices of their own.",
        ],
        (Kind::Contact, _) => [
            "The contact constraint is not met: the set of active nodes is not the right one, or a direction or gap differs.",
            "Compare direction, gap and reaction at the marked node with those of the scene.",
        ],
        (Kind::Support, "displacement") => [
            "The prescribed displacement is not that of the scene.",
            "Compare `displacement` of the support with what the model sets at the marked node.",
        ],
        (Kind::Support, "held" | "springs") => [
            "The model has a condition on this side that the scene does not have.",
            "Add the support, the springs, the contact or the obstacle to the scene if it is meant, or take it out of the model.",
        ],
        (Kind::Support, _) => [
            "The support is not in the system, or on other nodes.",
            "Look whether its boundary was found by name and its nodes collected, and whether a later step overwrites them.",
        ],
        (Kind::Load, "lumped-edges" | "lumped-bodies" | "lumped-all") => [
            "The sum of the nodal forces is that of the load, and their distribution is not ∫P·φ.",
            "Integrate the load with the shape functions of the element: ends of a quadratic edge have 1/6, its middle has 2/3.",
        ],
        (Kind::Load, "mean") => [
            "Thermal strains of a linear element are constant in it, as its displacements are linear: that program chooses them so.",
            "Take elements of second order there, or give the temperature in steps that are constant on each body.",
        ],
        (Kind::Load, "forces") => [
            "Nodal forces along one boundary are not those of its load; all equations elsewhere are met.",
            "Print the nodal forces on this boundary and compare each with ∫P·φ along its edges, ends and corners first.",
        ],
        (Kind::Load, _) => [
            "The right-hand side is not that of the scene.",
            "Compare the sum of the nodal forces with the resultant of the load; then sign, direction, unit and thickness.",
        ],
        (Kind::Material, "kinematics") => [
            "The stiffness is that of the other plane state.",
            "Look at `kinematics` of the scene, and which λ the model uses.",
        ],
        (Kind::Material, "thickness-strain") => [
            "In such a layer the stress across the thickness vanishes in the mean around a node and not in every point; its fields are no \
             solutions of plane stress, and differ less the finer the mesh is.",
            "Compare in plane strain (CPE elements), refine the mesh, or take elements of plane stress from another program.",
        ],
        (Kind::Material, "lambda" | "shear") => [
            "The elastic law in the stiffness has a wrong sign or factor.",
            "Check λ = Eν/((1 + ν)(1 − 2ν)) and σ = λ tr(e) 1 + 2μ e, and half or whole shear strains.",
        ],
        (Kind::Material, _) => [
            "The stiffness has other elastic constants than the scene.",
            "Print E and ν of each body as the model uses them; names of bodies, order of materials and units are what is mistaken most often.",
        ],
        (Kind::Thickness, _) => [
            "Displacements do not depend on the thickness where it multiplies stiffness and loads alike; energies and forces do.",
            "Multiply energies, loads and reactions by `thickness` of the scene.",
        ],
        (Kind::Moved, "rounded") => [
            "The field is a solution on another mesh than that of the scene, by the digits that were lost.",
            "Give the scene the mesh that the field was computed on, or write both with all digits.",
        ],
        (Kind::Moved, _) => [
            "The mesh was written after it moved, and the scene was made of it.",
            "Write the mesh as it was before (Elmer: `Displace Mesh = False`), or subtract the displacement from the points of both files.",
        ],
        (Kind::Precision, _) => [
            "Nothing but rounding separates the field from a solution.",
            "Assemble and solve in double precision, and write the displacements in it.",
        ],
        (Kind::Values, "value") => [
            "One value is off, and all others belong to a solution.",
            "Look at what writes or changes the displacement of this node after the solve: a constraint, a cast, an output filter.",
        ],
        (Kind::Values, _) => [
            "The displacements are those of a solution, but not at the nodes they are given for.",
            "Compare numbering of nodes and order of components of the two programs.",
        ],
        (Kind::Local, "material") => [
            "One triangle has other elastic constants than its body.",
            "Print the material that the marked triangle is given; look at what maps elements to materials there.",
        ],
        (Kind::Local, "equation") => [
            "One equation is not that of the scene: a force or a support acts at this node alone.",
            "Look for a point load, a constraint or an overwritten row at the marked node.",
        ],
        (Kind::Element, "hoop" | "plane-strain") => [
            "The strain around the axis, u_r/r, is not in the stiffness.",
            "Add its row to B, with the radius of each integration point.",
        ],
        (Kind::Element, "weight" | "weight-of-stiffness" | "weight-of-loads" | "weight-of-body-forces") => [
            "Integrals over a body of revolution have the weight r, which is not in all of them.",
            "Multiply the weight of every integration point by its radius, in the stiffness, in body forces and in tractions alike.",
        ],
        (Kind::Element, "reduced") => [
            "The equations are those of fewer points: a field may have motions that store no energy at these, seen as hourglass patterns.",
            "Choose the fully integrated element of the program, or leave --solution out: the bound of the error holds for any field.",
        ],
        (Kind::Element, _) => [
            "The element is another than the plain one of its nodes, which is no mistake in itself.",
            "Choose the fully integrated element of the program, or leave --solution out: the bound of the error holds for any field.",
        ],
        (Kind::Local, _) => [
            "All but a few equations are met: the assembly goes wrong at one spot.",
            "Look at the marked node and triangle: coordinates, material, orientation, connectivity.",
        ],
        (Kind::Equilibrium, "untried") => [
            "The displacement minimises another energy than that of the scene, or the solver stopped early. Which mistake explains it is looked for in degrees 1 and 2 on triangles alone, and where contacts and gaps put no vertices into the mesh.",
            "Run degrees 1 and 2 of the same solver on triangles beside it (of FEniCSx: --primal-cells triangles): what is wrong with those is named.",
        ],
        (Kind::Equilibrium, _) => [
            "The displacement minimises another energy than that of the scene, or the solver stopped early. No single mistake that is looked for explains it.",
            "Begin at the marked node; make the scene smaller until the failure goes away, and see what went last.",
        ],
        (Kind::Reported, _) => [
            "The displacement is right and the number beside it is not: the field passes its own checks.",
            "Look at how the energy is summed: 𝓛 = ½a(u, u) − L(u), times the thickness.",
        ],
        (Kind::Reactions, _) => [
            "The displacement is right and the forces reported with it are not: a sign, an order of nodes, or a factor.",
            "Compare the reactions with K u − f at the nodes of the contact.",
        ],
        (Kind::Bound, _) => [
            "No pair of correct solutions can do this. As nothing fails that asks about the field alone, the two models were given different scenes.",
            "Compare what both were given: loads, materials, supports, gaps, thickness.",
        ],
        (Kind::Coarse, _) => [
            "The mesh or the degree is too coarse for this scene: what the stresses may be wrong by is as large as they are.",
            "Refine where the stresses change most, or take elements of a higher degree, and hand in that field.",
        ],
        (Kind::Work, _) => [
            "The nodal forces balance, and their work is not that on the displacements and gaps of the scene.",
            "Compare prescribed displacements and gaps as the model uses them with those of the scene, and the digits of the file.",
        ],
        (Kind::Value, _) => [
            "The value cannot be that of a correct solution of this scene, or it belongs to another place or direction.",
            "Compare boundary, direction, window and sign of the quantity in the two programs.",
        ],
    }
}
