//! `sweep.json` and `sweep.csv` of trajectories: the best of several durations.

use super::heading::{Heading, JsonFile};
use calibrant_core::error::Result;
use calibrant_core::json::flat;
use calibrant_core::json_object;
use calibrant_machine_design::{TrajectorySweep, TrajectorySweepPoint};
use calibrant_recording::files::atomic_output::write_atomically;
use schemars::JsonSchema;
use serde::Serialize;
use std::path::Path;

/// The content of `sweep.json` of a machine.
#[derive(Clone, Copy)]
pub struct TrajectorySweepFile<'a> {
    /// The designs.
    pub sweep: &'a TrajectorySweep,
}

json_object! {
    /// The best trajectories of a machine for several durations.
    TrajectorySweepFile<'_> as file {
        heading: flat(Heading::<Self>::of()),
        /// The parameters of the sensor, in the order of all lists.
        parameters: file.sweep.quantities.iter().map(|quantity| quantity.name()).collect::<Vec<_>>(),
        /// One for each duration.
        points: file.sweep.points.iter().map(Point::of).collect::<Vec<_>>(),
    }
}

impl JsonFile for TrajectorySweepFile<'_> {
    const KIND: &'static str = "trajectory-sweep";
}

/// The best trajectory of a duration.
#[derive(Serialize, JsonSchema)]
struct Point {
    /// Duration, s.
    duration_s: f64,
    /// How the search ended; null where there is none.
    status: Option<&'static str>,
    /// Why there is no trajectory.
    error: Option<String>,
    /// Value of the criterion, nats.
    value: Option<f64>,
    /// That of the plain routine, nats.
    plain_value: Option<f64>,
    /// Standard deviation of each parameter.
    sd: Option<Vec<f64>>,
}

impl Point {
    fn of(point: &TrajectorySweepPoint) -> Self {
        let design = point.outcome.as_ref().ok();
        let plain = design.and_then(|design| design.plain.as_ref());
        let finite = |value: f64| Some(value).filter(|value| value.is_finite());
        Self {
            duration_s: point.duration_s,
            status: design.map(|design| design.status.name()),
            error: point.outcome.as_ref().err().cloned(),
            value: design.and_then(|design| finite(design.optimal.value)),
            plain_value: plain.and_then(|plain| finite(plain.evaluation.value)),
            sd: design.filter(|of| of.optimal.covariance.is_some()).map(|design| design.optimal.sd()),
        }
    }
}

/// Writes `sweep.csv`: a row for each duration, with the standard deviation of each parameter in SI units.
///
/// # Errors
/// [`Error::Output`](calibrant_core::Error::Output) where it cannot be written.
pub fn write_trajectory_sweep_csv(path: &Path, sweep: &TrajectorySweep) -> Result<()> {
    write_atomically(path, |out| {
        let mut csv = csv::Writer::from_writer(out);
        let fixed = ["duration_s", "status", "error", "value", "plain_value"].map(str::to_owned);
        let names = sweep.quantities.iter().map(|quantity| format!("{}_sd", quantity.name()));
        csv.write_record(fixed.into_iter().chain(names))?;
        for point in &sweep.points {
            let of = Point::of(point);
            let number = |value: Option<f64>| value.map_or_else(String::new, |value| format!("{value:?}"));
            let mut row = vec![
                number(Some(of.duration_s)),
                of.status.unwrap_or_default().to_owned(),
                of.error.unwrap_or_default(),
                number(of.value),
                number(of.plain_value),
            ];
            let sds = of.sd.map(|sds| sds.into_iter().map(Some).collect::<Vec<_>>());
            row.extend(sds.unwrap_or_else(|| vec![None; sweep.quantities.len()]).into_iter().map(number));
            csv.write_record(row)?;
        }
        csv.flush()
    })
}
