//! hypercircle says, with a guarantee, how wrong a plane contact computation is.
//!
//! Elastic bodies in frictionless contact minimise the potential energy over admissible displacements,
//!
//! 𝓛(v) = ½∫ c e(v):e(v) − ∫F·v − ∫P·v → min, v_n' + v_n'' ≤ g on Γ_K,
//!
//! or, equivalently, the complementary energy over stresses in equilibrium,
//!
//! Π(λ) = ½∫ a λ:λ − ∫T(λ)·u0 − ∫T_n(λ) g → min, T_n(λ) ≤ 0 on Γ_K.
//!
//! The two minima add up to zero, so any admissible v and any equilibrated λ enclose the exact energy,
//!
//! −Π(λ) ≤ 𝓛(u) ≤ 𝓛(v),
//!
//! and both stresses lie within √(2·gap) of the exact one in the energy norm (Prager and Synge). The stress side is solved
//! here with the self-equilibrated block elements of Haslinger and Hlaváček (Apl. mat. 26, 1981); the displacement side
//! comes from the dual solution itself, from FEniCSx, or from the user.
//!
//! Data travel in the order of the modules: [`process`] and [`budget`] → [`scene`] → [`mesh`] → [`problem`] → [`statics`] →
//! [`element`] → [`dual`] →
//! [`bounds`] → [`primal`] → [`compare`] → [`report`] → [`diff`] and [`study`] → [`workbench`] → [`measure`] → [`chart`] and [`stability`] → [`job`], with [`cli`], and
//! the Python package, as thin doors.
//!
//! ```
//! use std::path::Path;
//!
//! use hypercircle::dual::{Condensed, Options};
//! use hypercircle::problem::Problem;
//! use hypercircle::scene::Scene;
//! use hypercircle::study::certify;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let text = r#"
//!     model.kinematics = "plane-strain"
//!     geometry.size = 0.25
//!     bodies.block = { young = 1.0, poisson = 0.3 }
//!     supports = [{ on = "base", type = "clamped" }]
//!     tractions = [{ on = "top", pressure = 1.0 }]
//!
//!     [[geometry.polygons]]
//!     body = "block"
//!     points = [[0, 0], [1, 0], [1, 1], [0, 1]]
//!     edges = ["base", "", "top", ""]
//! "#;
//! let scene = Scene::parse(text, Path::new("block.toml"))?;
//! let problem = Problem::load(scene)?;
//! let run = certify(problem, &Condensed::default(), &Options::default())?;
//!
//! let (lower, free) = (run.bracket.lower(), run.bracket.free?);
//! assert!(lower <= free.upper());
//! assert!(run.dual.equilibrium.residual() < 1e-12);
//! # Ok(())
//! # }
//! ```

#[cfg(doctest)]
#[doc = include_str!("../docs/library.md")]
struct Library;

use hypercircle_core::vector;
pub use hypercircle_core::{
    bounds, budget, compare, diagnose, dual, elasticity, element, load, mesh, optimise, primal, problem, process,
    proof, quantity, scene, statics,
};

pub mod cause;
pub mod chart;
pub mod cli;
pub mod diff;
pub mod job;
pub mod measure;
pub mod plot;
pub mod published;
pub mod report;
pub mod stability;
pub mod study;
pub mod workbench;
