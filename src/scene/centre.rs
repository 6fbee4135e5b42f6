//! Coordinates from the middle of a scene that lies far from the point (0, 0).
//!
//! A number has sixteen digits. Those of a coordinate that say how far away the scene is are lost to every length and angle
//! in it, and again in every product. So a scene far away is moved to the middle of what it describes before anything is
//! computed: the differences from a point in the middle are exact, and nothing that the coordinates carry is lost. Messages
//! and results show the coordinates of the file.

use super::{Load, MeshSource, Note, Scene, SupportKind};

/// Largest distance from the point (0, 0), in sizes of the scene, at which coordinates stay as they are.
const NEAR: f64 = 16.0;
/// Distance of neighbouring coordinates, in sizes of the scene, from which on a note says so.
const COARSE: f64 = 1e-11;

impl Scene {
    /// Counts coordinates from a point in the middle of `points`, in each direction in which they lie far from zero. Returns the
    /// scene and that point, by which the caller has to move `points` themselves.
    ///
    /// A traction P(x) = value + gradient · x is rewritten in the new coordinates, as are body forces and clamped boundaries; regions and
    /// points of quantities move along.
    pub(crate) fn about_middle<'a>(self, points: impl Iterator<Item = &'a [f64; 2]> + Clone) -> (Scene, [f64; 2]) {
        let [x, y] = [0, 1].map(|c| range(points.clone().map(|p| p[c])));
        let size = (x[1] - x[0]).max(y[1] - y[0]);
        // Half and double of the middle enclose all coordinates, and within that range differences are exact.
        let middle = [x, y].map(|[low, high]| {
            let middle = low + 0.5 * (high - low);
            if middle.abs() > NEAR * size && middle.is_finite() { middle } else { 0.0 }
        });
        (if middle == [0.0; 2] { self } else { self.counted_from(middle) }, middle)
    }

    /// The scene with coordinates that count from a point.
    pub(crate) fn counted_from(mut self, middle: [f64; 2]) -> Scene {
        if let MeshSource::Geometry { polygons, .. } = &mut self.draft.mesh {
            for polygon in polygons {
                let through = polygon.arcs.iter_mut().map(|arc| &mut arc.through);
                for p in polygon.points.iter_mut().chain(through) {
                    *p = [p[0] - middle[0], p[1] - middle[1]];
                }
            }
        }
        for traction in &mut self.draft.tractions {
            if let Load::Affine(load) = &mut traction.load {
                load.shift(middle);
            }
        }
        for body in &mut self.draft.bodies {
            body.initial = body.initial.about(middle);
            body.body_force.shift(middle);
        }
        for support in &mut self.draft.supports {
            if let SupportKind::Clamped { displacement } = &mut support.kind {
                displacement.shift(middle);
            }
        }
        self.draft.contacts.iter_mut().flat_map(|c| &mut c.obstacle).for_each(|obstacle| obstacle.shift(middle));
        self.draft.boundaries.iter_mut().for_each(|boundary| boundary.edges.shift(middle));
        self.draft.quantities.iter_mut().for_each(|quantity| quantity.shift(middle));
        self.draft.origin = [0, 1].map(|c| self.origin[c] + middle[c]);
        self
    }

    /// A point in the coordinates of the scene as it was written.
    pub fn as_written(&self, point: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|c| point[c] + self.origin[c])
    }

    /// A remark where the coordinates of a scene of this extent carry few of its digits.
    pub(crate) fn coarseness(&self, size: f64) -> Option<Note> {
        let far = self.origin[0].abs().max(self.origin[1].abs());
        let step = far * f64::EPSILON;
        (step > COARSE * size).then(|| Note {
            weakens_guarantee: false,
            text: format!(
                "The scene lies {far:.1e} from the point (0, 0), where neighbouring numbers are up to {step:.1e} apart: \
                 coordinates and loads that depend on them are taken as they are written, and say no more than that."
            ),
        })
    }
}

fn range(values: impl Iterator<Item = f64>) -> [f64; 2] {
    values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::load::Affine;

    fn square(corner: [f64; 2], value: f64) -> Scene {
        let [x, y] = corner;
        let text = format!(
            "model.kinematics = \"plane-strain\"\nbodies.b = {{ young = 1.0, poisson = 0.3 }}\n\
             tractions = [{{ on = \"side\", value = [{value:?}, 0.0], gradient = [[3.0, -7.0], [0.0, 0.0]] }}]\n\
             [[geometry.polygons]]\nbody = \"b\"\nedges = [\"side\", \"\", \"\", \"\"]\n\
             points = [[{:?}, {:?}], [{:?}, {:?}], [{:?}, {:?}], [{:?}, {:?}]]\n",
            x,
            y,
            x + 1.0,
            y,
            x + 1.0,
            y + 1.0,
            x,
            y + 1.0
        );
        Scene::parse(&text, Path::new("square.toml")).expect("a scene")
    }

    fn moved(scene: Scene) -> Scene {
        let MeshSource::Geometry { polygons, .. } = scene.mesh.clone() else { panic!("polygons") };
        scene.about_middle(polygons.iter().flat_map(|p| &p.points)).0
    }

    #[test]
    fn a_scene_near_the_origin_stays_as_it_is() {
        for corner in [[0.0, 0.0], [-3.0, 10.0]] {
            assert_eq!(moved(square(corner, 4.0)), square(corner, 4.0));
        }
    }

    #[test]
    fn a_scene_far_away_keeps_every_digit_and_its_loads() {
        let corner = [1e8, -2e8];
        let scene = moved(square(corner, 4.0 - 3.0 * corner[0] + 7.0 * corner[1]));
        let MeshSource::Geometry { polygons, .. } = &scene.mesh else { panic!("polygons") };
        assert_eq!(polygons[0].points, [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]]);
        assert_eq!(scene.as_written([0.5, -0.5]), [1e8 + 1.0, -2e8]);
        let Load::Affine(Affine { value, gradient }) = scene.tractions[0].load else { panic!("affine") };
        assert_eq!((value, gradient), ([4.0 + 0.5 * (3.0 - 7.0), 0.0], [[3.0, -7.0], [0.0, 0.0]]));
        assert!(scene.coarseness(1.0).is_some_and(|note| note.text.contains("2.0e8")));
        assert_eq!(moved(square([100.0, 0.0], 0.0)).coarseness(1.0), None);
    }
}
