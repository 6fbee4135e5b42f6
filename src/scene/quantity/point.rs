//! Values at points and stress intensities.

use std::ops::Range;

use super::check::{Context, DIRECTION_OF_DISPLACEMENT};
use super::{Component, Invariant, Mode, PointValue, Target};
use crate::scene::reading::error::{Fault, SceneError};
use crate::scene::reading::raw::{At, Pair};

impl Context<'_> {
    pub(super) fn displacement_at(
        &self,
        of: &At<String>,
        point: &Pair,
        whole: Range<usize>,
    ) -> Result<Target, SceneError> {
        self.refuse(&["window", "about", "box", "polygon", "component"], "`displacement`")?;
        let body = self.body("displacement", of)?;
        let direction = self.required(&self.raw.direction, "direction", DIRECTION_OF_DISPLACEMENT, whole)?;
        self.at(body, point, PointValue::Displacement(self.direction(direction)?))
    }

    pub(super) fn stress_at(&self, of: &At<String>, point: &Pair, whole: Range<usize>) -> Result<Target, SceneError> {
        self.refuse(&["window", "about"], "`stress`")?;
        let body = self.body("stress", of)?;
        let one_of = |first, second, both| Fault::OneOf { table: self.table.to_owned(), first, second, both };
        let region = [("`box`", &self.raw.corners), ("`polygon`", &self.raw.polygon)];
        if let Some((key, list)) = region.into_iter().find_map(|(key, list)| Some((key, list.as_ref()?))) {
            let error = self.source.error(list.span(), one_of("`point`", key, true));
            return Err(error.with_related(point.span(), "the other one"));
        }
        let value = match (&self.raw.component, &self.raw.direction) {
            (Some(word), None) => match Invariant::ALL.into_iter().find(|known| known.word() == word.value) {
                Some(invariant) => PointValue::Invariant(invariant),
                None => PointValue::Stress(self.component(word)?),
            },
            (None, Some(direction)) => PointValue::Stress(Component::along(self.direction(direction)?)),
            (None, None) => return self.fail(whole, one_of("`component`", "`direction`", false)),
            (Some(word), Some(direction)) => {
                let error = self.source.error(direction.span(), one_of("`component`", "`direction`", true));
                return Err(error.with_related(word.span(), "the other one"));
            }
        };
        self.at(body, point, value)
    }

    fn at(&self, body: usize, point: &Pair, value: PointValue) -> Result<Target, SceneError> {
        let at = self.source.vector(point, (self.table, "point"))?;
        let is_whole = |n: f64| n >= 0.0 && n <= PointValue::SMOOTHEST as f64 && n.fract() == 0.0;
        let rule = ("the smoothness of a weight is a whole number from 0 to 6", "write 2, or leave `smoothness` out");
        let smoothness = match &self.raw.smoothness {
            Some(given) => self.source.number(given, (self.table, "smoothness"), is_whole, rule)? as usize,
            None => value.smoothness(),
        };
        Ok(Target::Point { body, at, value, smoothness })
    }

    pub(super) fn stress_intensity(&self, of: &At<String>, whole: Range<usize>) -> Result<Target, SceneError> {
        let others = ["direction", "window", "about", "box", "polygon", "component", "point", "smoothness"];
        self.refuse(&others, "`stress_intensity`")?;
        let Some(mode) = [Mode::I, Mode::II].into_iter().find(|mode| mode.word() == of.value) else {
            let known = vec!["KI".to_owned(), "KII".to_owned()];
            let (table, found) = (self.table.to_owned(), of.value.clone());
            return self.fail(of.span(), Fault::UnknownWord { key: "stress_intensity", table, found, known });
        };
        let tip = self.required(&self.raw.tip, "tip", "add tip = [x, y], the end of the crack", whole)?;
        Ok(Target::StressIntensity { mode, tip: self.source.vector(tip, (self.table, "tip"))? })
    }
}
