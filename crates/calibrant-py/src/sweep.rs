//! Designs for several values of one quantity.

use crate::choice::chosen;
use crate::experiment::Experiment;
use crate::failure::invalid;
use crate::page::Page;
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
    let quantity = quantity.to_owned();
    chosen(py, experiment, choice, (threads, progress), move |experiment, choice, given| {
        checked(&values)?;
        let asked = (variable(&quantity)?, values.as_slice());
        match experiment.read.plan {
            Plan::Machine(_) => trajectory::sweep(experiment, asked, choice, given),
            _ => design::sweep(experiment, asked, choice, given),
        }
    })
}

fn variable(name: &str) -> Result<SweepVariable> {
    SweepVariable::named(name).ok_or_else(|| {
        let names = SweepVariable::ALL.map(|variable| variable.name()).join(", ");
        invalid(format!("`quantity` is {name:?}"), format!("what can be swept is {names}"))
    })
}

/// Checks the values of a sweep.
pub(crate) fn checked(values: &[f64]) -> Result<()> {
    if values.is_empty() || values.len() > MOST {
        return Err(invalid(format!("there are {} `values`", values.len()), "give 1 to 1000"));
    }
    match values.iter().find(|value| !(value.is_finite() && **value > 0.0)) {
        Some(value) => Err(invalid(format!("`values` has {value}"), "give numbers above 0")),
        None => Ok(()),
    }
}
