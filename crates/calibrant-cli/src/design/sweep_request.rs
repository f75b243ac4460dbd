//! Parses the request of `calibrant design --sweep`.

use calibrant::Error;
use calibrant::design::SweepVariable;
use calibrant::error::{InputError, Refusal};

/// Largest number of values of a sweep.
const MOST: usize = 1000;

/// The time of a campaign over temperature, min.
const BUDGET: &str = "budget";

/// The quantity of a sweep, and its values.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Request {
    /// `None`: the time of a campaign over temperature.
    pub(super) variable: Option<SweepVariable>,
    pub(super) values: Vec<f64>,
}

/// Reads `duration=5,10,20`, `duration=5:40:8` (geometric) or `duration=5:40:8:linear`.
pub(crate) fn parse(text: &str) -> Result<Request, String> {
    let (name, values) =
        text.split_once('=').ok_or("write NAME=VALUES, for example duration=5,10,20 or velocity=2:20:6")?;
    let variable = match name.trim() {
        BUDGET => None,
        name => Some(SweepVariable::named(name).ok_or_else(|| {
            let names: Vec<_> = SweepVariable::ALL.iter().map(|variable| variable.name()).collect();
            format!(
                "\"{name}\" cannot be swept; what can is {}, and {BUDGET} of a campaign",
                names.join(", ")
            )
        })?),
    };
    let number = |text: &str| {
        let number: Option<f64> = text.trim().parse().ok();
        number
            .filter(|value| value.is_finite() && *value > 0.0)
            .ok_or_else(|| format!("\"{}\" is not a number above 0", text.trim()))
    };
    let values = if values.contains(':') {
        let parts: Vec<&str> = values.split(':').collect();
        let linear = match parts.get(3) {
            None | Some(&"geometric") => false,
            Some(&"linear") => true,
            Some(word) => return Err(format!("\"{word}\" is neither linear nor geometric")),
        };
        let (&[from, to, count] | &[from, to, count, _]) = parts.as_slice() else {
            return Err("a range is FROM:TO:COUNT or FROM:TO:COUNT:linear".into());
        };
        let (from, to) = (number(from)?, number(to)?);
        let count: usize = count
            .trim()
            .parse()
            .ok()
            .filter(|count| (2..=MOST).contains(count))
            .ok_or(format!("\"{}\" is not a number of values from 2 to {MOST}", count.trim()))?;
        let last = (count - 1) as f64;
        let value = |k: usize| {
            let x = k as f64 / last;
            match k {
                0 => from,
                k if k + 1 == count => to,
                _ if linear => from + (to - from) * x,
                _ => from * (to / from).powf(x),
            }
        };
        (0..count).map(value).collect()
    } else {
        values.split(',').map(number).collect::<Result<Vec<_>, _>>()?
    };
    if values.len() > MOST {
        return Err(format!("{} values; at most {MOST}", values.len()));
    }
    Ok(Request { variable, values })
}

impl Request {
    /// What is swept of a motion.
    pub(super) fn of_motion(&self) -> calibrant::Result<SweepVariable> {
        self.variable.ok_or_else(|| {
            let help = "sweep its duration: --sweep duration=5,10,20";
            let message = "budget is the time of a campaign over temperature, and this is none";
            Error::experiment(InputError::new(Refusal::ExperimentUnsuited, message, help))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_lists_and_ranges() {
        let values = |text| parse(text).expect("good").values;
        assert_eq!(values("duration=5,10, 20"), [5.0, 10.0, 20.0]);
        assert_eq!(values("velocity=1:4:3"), [1.0, 2.0, 4.0]);
        assert_eq!(values("limits.jerk_mps3=1:4:4:linear"), [1.0, 2.0, 3.0, 4.0]);
        for (bad, says) in [
            ("duration", "write NAME=VALUES"),
            ("speed=1,2", "\"speed\" cannot be swept; what can is duration, acceleration"),
            ("duration=5,,10", "\"\" is not a number above 0"),
            ("duration=-5", "\"-5\" is not a number above 0"),
            ("duration=5:10", "a range is FROM:TO:COUNT"),
            ("duration=5:10:1", "\"1\" is not a number of values from 2 to 1000"),
            ("duration=5:10:3:log", "\"log\" is neither linear nor geometric"),
        ] {
            let stated = parse(bad).expect_err("bad");
            assert!(stated.contains(says), "{stated}");
        }
    }
}
