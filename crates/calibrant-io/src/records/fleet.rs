//! The fleet: how each parameter differs from sensor to sensor.

use super::database::Records;
use super::failure::failed;
use calibrant_core::error::Result;
use calibrant_core::fleet::Distribution;
use std::collections::BTreeMap;

/// A parameter over all sensors.
#[derive(Debug, Clone, PartialEq)]
pub struct FleetParameter {
    /// Its name.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// The values of the sensors.
    pub values: Distribution,
    /// Root mean square of the standard deviations of the calibrations; `None` where they have none.
    pub calibration_sd: Option<f64>,
    /// The sensors that are farthest from the median, the farthest first: the sensor, its value, and the distance ([`Distribution::distance`]).
    pub farthest: Vec<(String, f64, f64)>,
}

/// Number of sensors that are named.
const FARTHEST: usize = 3;

impl Records {
    /// The parameters over all sensors, in the order of their first model. The latest calibration of each sensor counts, unless it is bad.
    ///
    /// # Errors
    /// [`Error::Experiment`](calibrant_core::Error::Experiment) where the records are damaged.
    pub fn fleet(&self) -> Result<Vec<FleetParameter>> {
        let sql = |error| failed(&self.path, error);
        // of several bare columns beside one max(), SQLite takes those of that row
        let query = "
            WITH newest AS (
                SELECT id, sensor, model, max((recorded IS NOT NULL) || coalesce(recorded, '') || printf(' %020d', id))
                FROM latest WHERE verdict <> 'bad' GROUP BY sensor
            )
            SELECT newest.sensor, names.name, names.unit, parameters.value, parameters.sd, names.model, names.place
            FROM newest JOIN parameters ON parameters.calibration = newest.id
            JOIN names ON names.model = newest.model AND names.place = parameters.place";
        let mut statement = self.connection.prepare_cached(query).map_err(sql)?;
        let mut rows = statement.query([]).map_err(sql)?;
        let mut found: BTreeMap<(String, String), Found> = BTreeMap::new();
        while let Some(row) = rows.next().map_err(sql)? {
            let column = |k: usize| row.get::<_, String>(k).map_err(sql);
            let place = (row.get(5).map_err(sql)?, row.get(6).map_err(sql)?);
            let parameter = found.entry((column(1)?, column(2)?)).or_insert_with(|| Found::at(place));
            parameter.place = parameter.place.min(place);
            parameter.sensors.push((column(0)?, row.get(3).map_err(sql)?));
            parameter.sds.extend(row.get::<_, Option<f64>>(4).map_err(sql)?);
        }
        let mut found: Vec<_> = found.into_iter().collect();
        found.sort_by_key(|(_, parameter)| parameter.place);
        Ok(found
            .into_iter()
            .filter_map(|((name, unit), parameter)| parameter.over_sensors(name, unit))
            .collect())
    }
}

struct Found {
    /// The first model that has it, and its place there.
    place: (i64, i64),
    sensors: Vec<(String, f64)>,
    sds: Vec<f64>,
}

impl Found {
    fn at(place: (i64, i64)) -> Self {
        Self { place, sensors: Vec::new(), sds: Vec::new() }
    }

    fn over_sensors(self, name: String, unit: String) -> Option<FleetParameter> {
        let values = Distribution::of(self.sensors.iter().map(|(_, value)| *value))?;
        let mut farthest: Vec<(String, f64, f64)> = (self.sensors.into_iter())
            .filter_map(|(sensor, value)| Some((sensor, value, values.distance(value)?)))
            .collect();
        farthest
            .sort_by(|one, other| other.2.abs().total_cmp(&one.2.abs()).then_with(|| one.0.cmp(&other.0)));
        farthest.truncate(FARTHEST);
        let squares: f64 = self.sds.iter().map(|sd| sd * sd).sum();
        let calibration_sd = (!self.sds.is_empty()).then(|| (squares / self.sds.len() as f64).sqrt());
        Some(FleetParameter { name, unit, values, calibration_sd, farthest })
    }
}
