//! The part of a rig that can be judged without its input: the strut above a wheel whose motion was measured.

use std::sync::Arc;

use strut_model::Value;

use super::Rig;
use super::kind::{Kind, Undriven};
use crate::plant::models;

impl Rig {
    /// The rig that stands for this one where no column has its input; none if the rig file names none.
    ///
    /// # Errors
    /// If its model is none of the library, or this rig's values do not fit it.
    pub fn undriven(&self) -> Result<Option<Self>, String> {
        let Some(Undriven { model, .. }) = &self.kind.undriven else { return Ok(None) };
        let kind = Kind::published().iter().find(|kind| kind.model == *model);
        let (kind, plant) = kind
            .zip(models::named(model))
            .ok_or_else(|| format!("undriven: the library has no model `{model}`"))?;
        let own = self.plant.parameters.iter().zip(&self.parameters);
        let values: Vec<(&str, Value)> = own
            .filter(|(declared, _)| plant.parameter(&declared.name).is_some())
            .map(|(declared, value)| (declared.name.as_str(), Value::Real(*value)))
            .collect();
        let given = values.iter().map(|(name, value)| (*name, value));
        let mut part = Self::made((self.name.clone(), self.fmu.clone()), plant, kind.clone(), given)?;
        let here = |index: usize| part.plant.parameter(&self.plant.parameters[index].name);
        let known =
            self.known.iter().filter_map(|(index, value, error)| Some((here(*index)?, *value, *error)));
        let known = known.collect();
        let is_stated = |name: &str| self.plant.parameter(name).is_some_and(|index| self.stated[index]);
        part.stated = part.plant.parameters.iter().map(|it| is_stated(&it.name)).collect();
        part.known = known;
        part.of = Some(Arc::new(self.clone()));
        Ok(Some(part))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_stands_for_a_car_without_a_road_has_its_values_and_what_is_known_of_them() {
        let mut car = Rig::published("tum-quarter-vehicle").unwrap();
        let mass = car.plant.parameter("sprung_mass").unwrap();
        car.known.push((mass, 94.0, 0.5));
        let part = car.undriven().unwrap().unwrap();
        assert_eq!((part.name.as_str(), part.plant.name.as_str()), ("tum-quarter-vehicle", "SprungMass"));
        for (index, declared) in part.plant.parameters.iter().enumerate() {
            let own = car.plant.parameter(&declared.name).unwrap_or_else(|| panic!("{}", declared.name));
            assert_eq!((part.parameters[index], part.stated[index]), (car.parameters[own], car.stated[own]));
        }
        let mass = part.plant.parameter("sprung_mass").unwrap();
        assert_eq!(part.known, [(mass, 94.0, 0.5)]);
        assert!(part.undriven().unwrap().is_none());
    }
}
