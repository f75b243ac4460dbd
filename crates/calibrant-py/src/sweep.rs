//! Designs for several values of one quantity.

use crate::choice::Choice;
use crate::experiment::Experiment;
use crate::failure::{invalid, raised};
use crate::options::parsed;
use crate::page::Page;
use crate::work::{How, run_as};
use crate::{design, trajectory};
use calibrant::Result;
use calibrant::design::SweepVariable;
use calibrant::io::Plan;
use pyo3::prelude::*;

/// Largest number of values of a sweep.
const MOST: usize = 1000;

/// Sweeps a commanded motion, or the trajectory of a machine.
#[pyfunction]
#[pyo3(signature = (experiment, quantity, values, choice, *, threads=None, progress=None))]
pub(crate) fn sweep(
    py: Python<'_>,
    experiment: &Experiment,
    quantity: &str,
    values: Vec<f64>,
    choice: &str,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Page> {
    let read = || -> Result<_> {
        checked(&values)?;
        Ok((parsed::<Choice>(choice)?, variable(quantity)?))
    };
    let (choice, variable) = read().map_err(|error| raised(py, &error))?;
    let experiment = experiment.clone();
    run_as(py, How { threads, progress, keeps_the_best: true }, move |given| match experiment.read.plan {
        Plan::Machine(_) => trajectory::sweep(&experiment, (variable, &values), &choice, &given),
        _ => design::sweep(&experiment, (variable, &values), &choice, &given),
    })
}

fn variable(name: &str) -> Result<SweepVariable> {
    SweepVariable::named(name).ok_or_else(|| {
        let names = SweepVariable::ALL.map(|variable| variable.name()).join(", ");
        invalid(format!("`quantity` is {name:?}"), format!("what can be swept is {names}"))
    })
}

fn checked(values: &[f64]) -> Result<()> {
    if values.is_empty() || values.len() > MOST {
        return Err(invalid(format!("there are {} `values`", values.len()), "give 1 to 1000"));
    }
    match values.iter().find(|value| !(value.is_finite() && **value > 0.0)) {
        Some(value) => Err(invalid(format!("`values` has {value}"), "give numbers above 0")),
        None => Ok(()),
    }
}
