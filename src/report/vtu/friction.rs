//! Friction on the triangles along contacts.

use crate::compare::FrictionState;
use crate::report::{ContactSummary, Dossier};

/// Of every triangle, by the middle of its edge on a contact with friction.
pub struct OnTriangles {
    /// As a number; −1 away from such contacts.
    pub state: Vec<i64>,
    /// The tangential traction on the first side, and its bound; zero away from such contacts.
    pub traction: Vec<f64>,
    pub bound: Vec<f64>,
}

impl OnTriangles {
    /// `None` where no contact has friction.
    pub fn of(dossier: &Dossier) -> Option<Self> {
        let (mesh, contacts) = (&dossier.problem.mesh, &dossier.report.contact);
        if contacts.iter().all(|contact| contact.friction.is_none()) {
            return None;
        }
        let count = mesh.triangles.len();
        let mut all = OnTriangles { state: vec![-1; count], traction: vec![0.0; count], bound: vec![0.0; count] };
        for (interface, contact) in dossier.problem.interfaces.iter().zip(contacts) {
            for pair in &interface.pairs {
                let edges = pair.edges.into_iter().flatten();
                let triangles = edges.filter_map(|e| mesh.edges[e].triangles[0]);
                triangles.for_each(|t| all.put(t, contact, 0.5 * (pair.arc[0] + pair.arc[1])));
            }
        }
        Some(all)
    }

    fn put(&mut self, t: usize, contact: &ContactSummary, s: f64) {
        let Some(friction) = &contact.friction else { return };
        let state = friction.zones.iter().find(|zone| zone.from <= s && s <= zone.to).map(|zone| zone.state);
        self.state[t] = state.map_or(-1, number);
        self.traction[t] = value(&friction.traction, s);
        self.bound[t] = value(&friction.bound, s);
    }
}

fn number(state: FrictionState) -> i64 {
    match state {
        FrictionState::Open => 0,
        FrictionState::Free => 1,
        FrictionState::Slip => 2,
        FrictionState::Stick => 3,
    }
}

/// A piecewise linear function of the arc length, zero beyond its ends.
fn value(points: &[[f64; 2]], s: f64) -> f64 {
    let around = points.windows(2).find(|w| w[0][0] <= s && s <= w[1][0] && w[1][0] > w[0][0]);
    around.map_or(0.0, |w| w[0][1] + (s - w[0][0]) / (w[1][0] - w[0][0]) * (w[1][1] - w[0][1]))
}
