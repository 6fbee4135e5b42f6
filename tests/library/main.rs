//! The library, called as a program calls it.

mod accuracy;
mod adaptive;
mod anisotropic;
#[path = "../support/arcs.rs"]
mod arcs;
mod bonds;
mod circular_gap;
mod comparison;
mod congruent;
mod contact_pressure;
mod contact_qp;
mod curve_remarks;
mod curved_adaptive;
mod curved_contact;
mod degrees;
mod diagnosis_of_nothing;
mod drafts;
mod dual_limits;
mod dual_methods;
mod effectivity;
mod element_formulas;
mod element_properties;
mod equilibrium;
mod fuzzed;
mod gap_breaks;
mod gap_curves;
mod inner_segments;
mod intervals;
mod invariance;
mod known_solutions;
#[path = "../support/lame.rs"]
mod lame;
mod layers;
#[path = "../malformed/mod.rs"]
mod malformed;
mod malformed_scenes;
mod mean_pressure;
mod mesh_files;
mod mesh_formats;
mod mesh_inventory;
mod mesh_parts;
mod mesh_selection;
mod methods_on_cases;
mod obstacles;
mod own_element;
mod paper_block;
mod paper_objects;
mod paper_rates;
mod paper_reactions;
mod paper_theorems;
mod prescribed;
mod pressure_at_ends;
mod quadrilaterals;
mod quantities;
mod refinement_ends;
mod revolved;
mod rings;
mod rounding;
mod scene_schema;
mod setup;
mod squares;
#[path = "../support/mod.rs"]
mod support;
mod two_blocks;
mod upper_bound;
mod workbench;
