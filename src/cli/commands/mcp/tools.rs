//! The tools, as an agent is told of them.

use schemars::{JsonSchema, schema_for};
use serde_json::{Value, json};

use super::arguments::{Certify, Diagnose, Element, Solve, Verify};

/// Instructions that an agent reads before it calls any tool.
pub const INSTRUCTIONS: &str = "\
hypercircle bounds the exact answer of plane and axisymmetric elastic contact problems from both sides, with a guarantee, and says what is wrong with \
finite-element results. Every answer has a status (agree, disagree, undecided, infeasible), a verdict in one sentence, and numbers; the exact energy lies \
between energy.lower and energy.upper, the exact value of a quantity between its lower and upper. A scene is the text of a TOML file:

[model]
kinematics = \"plane-strain\"
[geometry]
size = 0.25
[[geometry.polygons]]
body = \"block\"
points = [[0, 0], [1, 0], [1, 1], [0, 1]]
edges = [\"base\", \"\", \"top\", \"\"]
[bodies.block]
young = 1.0
poisson = 0.3
[[supports]]
on = \"base\"
type = \"clamped\"
[[tractions]]
on = \"top\"
value = [0.0, -1.0]
[[quantities]]
name = \"sinking\"
displacement = \"top\"
direction = [0, -1]

The resource hypercircle://scene.schema.json has every key, hypercircle://example.toml a commented scene with contact. Start with solve; verify needs FEniCSx on \
the machine of the server.";

struct Tool {
    name: &'static str,
    title: &'static str,
    about: &'static str,
    takes: fn() -> Value,
}

fn schema_of<T: JsonSchema>() -> Value {
    schema_for!(T).to_value()
}

const TOOLS: [Tool; 5] = [
    Tool {
        name: "solve",
        title: "Solve, with guaranteed bounds",
        about: "Solves a scene in stresses that are in equilibrium, and gives two numbers between which the exact energy lies, a bound on the relative error, the \
                contact forces, and an interval for each quantity of the scene. Milliseconds to seconds; a tolerance refines until it is reached.",
        takes: schema_of::<Solve>,
    },
    Tool {
        name: "verify",
        title: "Cross-validate against FEniCSx",
        about: "Solves a scene twice, in stresses here and in displacements with FEniCSx on the same mesh, and compares: do the two agree, how far can each be from \
                the truth, where do they differ.",
        takes: schema_of::<Verify>,
    },
    Tool {
        name: "certify",
        title: "Certify somebody else's result",
        about: "Holds a displacement field from another program, or printed values of quantities, against the guaranteed bounds of the scene. With solution = true the \
                field also has to be the discrete solution of its mesh.",
        takes: schema_of::<Certify>,
    },
    Tool {
        name: "diagnose",
        title: "Say which mistake explains a wrong field",
        about: "Says whether a displacement field is the discrete solution of its mesh, and if it is not, which mistake explains it: a wrong constant, load, support, \
                plane state, integration, a missing contact.",
        takes: schema_of::<Diagnose>,
    },
    Tool {
        name: "element",
        title: "Examine an element formulation",
        about: "Says property by property what is right and wrong with the stiffness matrix of one plane element (rigid motions, patch test, symmetry, stored energy), \
                and which mistake explains the difference. Without arguments it lists the elements that come with the program.",
        takes: schema_of::<Element>,
    },
];

/// True if there is a tool of that name.
pub fn is_tool(name: &str) -> bool {
    TOOLS.iter().any(|tool| tool.name == name)
}

/// The names of all.
pub fn names() -> Vec<&'static str> {
    TOOLS.iter().map(|tool| tool.name).collect()
}

/// The result of `tools/list`.
pub fn list() -> Value {
    let told = |tool: &Tool| {
        json!({
            "name": tool.name,
            "title": tool.title,
            "description": tool.about,
            "inputSchema": (tool.takes)(),
            "outputSchema": {
                "type": "object",
                "properties": {
                    "status": {"type": "string", "description": "agree, disagree, undecided, infeasible; refused, not-installed or failed with an error"},
                    "verdict": {"type": "string", "description": "one sentence"},
                },
                "required": ["status", "verdict"],
            },
            "annotations": {"readOnlyHint": true, "destructiveHint": false, "idempotentHint": true, "openWorldHint": false},
        })
    };
    json!({"tools": TOOLS.iter().map(told).collect::<Vec<_>>()})
}
