//! A standard deviation that a design should reach, as people write it: `scale.x=50ppm`.

use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::sensor::{
    ImuQuantity, ParameterList, Quantity, ReadingUnit, SensorKind, SensorParameters,
};
use calibrant_design::Goal;
use calibrant_io::nearest;
use calibrant_machine_design::TrajectoryGoal;

/// A parameter, and the standard deviation that it should have.
///
/// # Examples
/// ```
/// use calibrant::GoalRequest;
///
/// assert!(GoalRequest::parse("scale.x=50ppm").is_ok());
/// assert!(GoalRequest::parse("scale.x=5 furlongs").is_err());
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct GoalRequest {
    name: String,
    value: f64,
    /// As it was written.
    text: String,
    dimension: Dimension,
}

/// What a value is measured in.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Dimension {
    /// The parameter's own unit.
    Own,
    /// A share: of scale factors and cross-axis sensitivities.
    Share,
    /// m/s²: of biases.
    Acceleration,
    /// rad/s: of biases of gyroscopes.
    Rate,
}

/// The units, with their size.
const UNITS: [(&str, f64, Dimension); 14] = [
    ("deg/h", std::f64::consts::PI / 180.0 / 3600.0, Dimension::Rate),
    ("°/h", std::f64::consts::PI / 180.0 / 3600.0, Dimension::Rate),
    ("deg/s", std::f64::consts::PI / 180.0, Dimension::Rate),
    ("°/s", std::f64::consts::PI / 180.0, Dimension::Rate),
    ("rad/s", 1.0, Dimension::Rate),
    ("ppm", 1e-6, Dimension::Share),
    ("%", 1e-2, Dimension::Share),
    ("mg", 9.806_65e-3, Dimension::Acceleration),
    ("ug", 9.806_65e-6, Dimension::Acceleration),
    ("µg", 9.806_65e-6, Dimension::Acceleration),
    ("mm/s2", 1e-3, Dimension::Acceleration),
    ("mm/s²", 1e-3, Dimension::Acceleration),
    ("m/s2", 1.0, Dimension::Acceleration),
    ("m/s²", 1.0, Dimension::Acceleration),
];

impl GoalRequest {
    /// Reads `scale.x=50ppm` or `bias.z=0.2mg`.
    ///
    /// # Errors
    /// What is wrong with the text.
    pub fn parse(text: &str) -> std::result::Result<Self, String> {
        let (name, value) =
            text.split_once('=').ok_or("write NAME=SD, for example scale.x=50ppm or bias.z=0.2mg")?;
        Self::of(name, value)
    }

    /// The same of a name, and a value with its unit.
    ///
    /// # Errors
    /// What is wrong with the value.
    pub fn of(name: &str, value: &str) -> std::result::Result<Self, String> {
        let value = value.trim();
        let (number, size, dimension) = UNITS
            .iter()
            .find_map(|(unit, size, dimension)| {
                value.strip_suffix(unit).map(|number| (number, *size, *dimension))
            })
            .unwrap_or((value, 1.0, Dimension::Own));
        let number: Option<f64> = number.trim().parse().ok();
        let number = number.filter(|number| number.is_finite() && *number > 0.0).ok_or_else(|| {
            let units = UNITS.map(|(unit, ..)| unit).join(", ");
            format!("\"{value}\" is not a number above 0 with one of the units {units}")
        })?;
        Ok(Self { name: name.trim().to_owned(), value: number * size, text: value.to_owned(), dimension })
    }

    /// In words: `scale.x to 50ppm`.
    pub(crate) fn in_words(&self) -> String {
        format!("{} to {}", self.name, self.text)
    }
}

/// The goals for these parameters. Shares and accelerations count for readings in counts through the gain of
/// the parameter's axis, counts per m/s².
pub(crate) fn goals(
    requests: &[GoalRequest],
    list: &ParameterList,
    unit: ReadingUnit,
    at: &SensorParameters,
) -> Result<Vec<Goal>> {
    requests.iter().map(|request| goal(request, list, unit, at)).collect()
}

fn goal(
    request: &GoalRequest,
    list: &ParameterList,
    unit: ReadingUnit,
    at: &SensorParameters,
) -> Result<Goal> {
    let reject = |message: String, help: String| {
        Err(Error::experiment(InputError::new(Refusal::ValueInvalid, message, help)))
    };
    let Some(parameter) = list.position(&request.name) else {
        let message = format!("option `reach`: this sensor has no parameter \"{}\"", request.name);
        let names = list.names();
        let near = nearest(&request.name, names.iter().map(String::as_str));
        let hint = near.map_or(String::new(), |near| format!("did you mean {near}? "));
        return reject(message, format!("{hint}its parameters are {}", names.join(", ")));
    };
    let quantity = list.quantities()[parameter];
    let is_bias = matches!(quantity, Quantity::Bias(_));
    let fits = match request.dimension {
        Dimension::Own => true,
        Dimension::Share => quantity.unit(ReadingUnit::MetrePerSecondSquared) == "1",
        Dimension::Acceleration => is_bias,
        Dimension::Rate => false,
    };
    if !fits {
        let message =
            format!("option `reach`: {} is not measured in the unit of {}", request.name, request.text);
        let help = if is_bias { "give mg, ug or m/s2" } else { "give ppm or %" };
        return reject(message, help.into());
    }
    let gain = at.matrix.row(quantity.axis().index()).norm();
    let is_counted = unit == ReadingUnit::Counts
        && request.dimension != Dimension::Own
        && !matches!(quantity, Quantity::Nonlinear(..));
    Ok(Goal { parameter, sd: request.value * if is_counted { gain } else { 1.0 } })
}

/// The goals for the parameters of an IMU. A name without a sensor, or without an axis, is of all that it fits: `scale`, `gyroscope.bias`, `scale.x`.
pub(crate) fn goals_of_imu(
    requests: &[GoalRequest],
    quantities: &[ImuQuantity],
) -> Result<Vec<TrajectoryGoal>> {
    let mut goals = Vec::new();
    for request in requests {
        let fits = |name: &str| {
            let wanted: Vec<&str> = request.name.split('.').collect();
            let found: Vec<&str> = name.split('.').collect();
            found.windows(wanted.len()).any(|part| part == wanted)
        };
        let places: Vec<usize> = (0..quantities.len()).filter(|i| fits(&quantities[*i].name())).collect();
        let refused = |message: String, help: String| {
            Err(Error::experiment(InputError::new(Refusal::ValueInvalid, message, help)))
        };
        if places.is_empty() {
            let names: Vec<String> = quantities.iter().map(|quantity| quantity.name()).collect();
            let near = nearest(&request.name, names.iter().map(String::as_str));
            let hint = near.map_or(String::new(), |near| format!("did you mean {near}? "));
            let message = format!("option `reach`: this sensor has no parameter \"{}\"", request.name);
            return refused(message, format!("{hint}its parameters are {}", names.join(", ")));
        }
        let measured = |place: &usize| match quantities[*place] {
            ImuQuantity::Of(SensorKind::Accelerometer, Quantity::Bias(_)) => Dimension::Acceleration,
            ImuQuantity::Of(SensorKind::Gyroscope, Quantity::Bias(_)) => Dimension::Rate,
            ImuQuantity::Of(..) => Dimension::Share,
            _ => Dimension::Own,
        };
        // a unit says which are meant: `bias=1mg` is of the accelerometer
        let fitting =
            places.iter().filter(|place| [Dimension::Own, measured(place)].contains(&request.dimension));
        let before = goals.len();
        goals.extend(fitting.map(|place| TrajectoryGoal { parameter: *place, sd: request.value }));
        if goals.len() == before {
            let name = quantities[places[0]].name();
            let message = format!("option `reach`: {name} is not measured in the unit of {}", request.text);
            let help = match measured(&places[0]) {
                Dimension::Acceleration => "give mg, ug or m/s2",
                Dimension::Rate => "give deg/h, deg/s or rad/s",
                Dimension::Share => "give ppm or %",
                Dimension::Own => "give a number in the parameter's unit",
            };
            return refused(message, help.into());
        }
    }
    Ok(goals)
}

#[cfg(test)]
mod tests {
    use super::*;
    use calibrant_core::sensor::SensorModel;
    use nalgebra::Matrix3;

    #[test]
    fn goals_have_the_units_of_data_sheets() {
        let list = ParameterList::new(3, SensorModel::ScaleBias);
        let of = |text: &str, unit| {
            let request = GoalRequest::parse(text).expect("a request");
            let gain = if unit == ReadingUnit::Counts { 400.0 } else { 1.0 };
            let at = SensorParameters { matrix: Matrix3::identity() * gain, ..SensorParameters::identity() };
            goals(&[request], &list, unit, &at).map(|goals| (goals[0].parameter, goals[0].sd))
        };
        let mps2 = ReadingUnit::MetrePerSecondSquared;
        let (parameter, sd) = of("scale.y=50ppm", mps2).expect("a goal");
        assert_eq!(parameter, 4);
        assert!((sd - 5e-5).abs() < 1e-18);
        assert!((of("bias.x=1mg", mps2).expect("a goal").1 - 9.80665e-3).abs() < 1e-15);
        assert!(
            (of("bias.x=1mg", ReadingUnit::Counts).expect("a goal").1 - 400.0 * 9.80665e-3).abs() < 1e-12
        );
        assert!((of("bias.x=0.01", ReadingUnit::Counts).expect("a goal").1 - 0.01).abs() < 1e-15);
        // names as calibrations have them
        assert_eq!(of("accelerometer.scale.y=50ppm", mps2).expect("a goal"), (parameter, sd));
        assert!(of("accelerometer.bias.x=1mg", mps2).is_ok());
        assert!(of("scale.x=1mg", mps2).is_err() && of("scale.q=1ppm", mps2).is_err());
        for wrong in ["scale.x", "scale.x=-1", "scale.x=much", "scale.x=5furlong"] {
            assert!(GoalRequest::parse(wrong).is_err(), "{wrong}");
        }
    }
}
