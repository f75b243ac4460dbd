//! What a log of a machine's motion, and a machine, contain.

use crate::motion::Motion;
use crate::options::time_unit;
use crate::page::{Page, page};
use crate::work::run;
use calibrant::diagnostic::files::MeshMissing;
use calibrant::diagnostic::{Diagnostic, Phrase};
use calibrant::inspection::{chain_sheet, log_sheet};
use calibrant::io::{
    MachineFile, MissingMesh, ReferenceInspectionFile, ReferenceLogFile, ReferenceLogOptions, Urdf,
    file_name, inspect_reference_log, is_reference_log, read_reference_log, to_json,
};
use calibrant::session::MotionSource;
use pyo3::prelude::*;
use std::path::PathBuf;

fn options(time_unit_name: Option<String>, topic: Option<String>) -> calibrant::Result<ReferenceLogOptions> {
    Ok(ReferenceLogOptions { time_unit: time_unit(&time_unit_name)?, topic, ..Default::default() })
}

/// Is a file a log of a motion?
#[pyfunction]
#[pyo3(signature = (path, time_unit=None, topic=None))]
pub(crate) fn is_log(
    py: Python<'_>,
    path: PathBuf,
    time_unit: Option<String>,
    topic: Option<String>,
) -> PyResult<bool> {
    run(py, move || Ok(is_reference_log(&path, &options(time_unit, topic)?)))
}

/// What a log of joints or poses contains.
#[pyfunction]
#[pyo3(signature = (motion, time_unit=None, topic=None))]
pub(crate) fn inspect_log(
    py: Python<'_>,
    motion: &Motion,
    time_unit: Option<String>,
    topic: Option<String>,
) -> PyResult<Page> {
    let motion = motion.0.clone();
    run(py, move || {
        let name = motion.path().display().to_string();
        let mut file = match &motion {
            MotionSource::Logged(log) | MotionSource::OnKnots(log, _) => {
                ReferenceLogFile::of_log(log.clone())?
            }
            _ => read_reference_log(motion.path(), &options(time_unit, topic)?)?,
        };
        let placed = |found: Diagnostic| found.in_file(file_name(motion.path()));
        file.findings = file.findings.into_iter().map(placed).collect();
        let inspection = inspect_reference_log(&file);
        let json = to_json(&ReferenceInspectionFile { file: &file, inspection: &inspection });
        Ok(page(json, &file.findings, &log_sheet(&file, &inspection, &name)))
    })
}

/// The joints of a machine between two links.
#[pyfunction]
#[pyo3(signature = (path, base=None, tip=None, packages=Vec::new()))]
pub(crate) fn inspect_machine(
    py: Python<'_>,
    path: PathBuf,
    base: Option<String>,
    tip: Option<String>,
    packages: Vec<PathBuf>,
) -> PyResult<Page> {
    run(py, move || {
        let machine = Urdf::read(&path)?;
        let chain = machine.chain(base.as_deref(), tip.as_deref())?;
        let meshes = if packages.is_empty() { Vec::new() } else { machine.missing_meshes(&packages) };
        let missing = |mesh: &MissingMesh| MeshMissing { mesh: Phrase(mesh.to_string()) }.into();
        let notes: Vec<Diagnostic> = meshes.iter().map(missing).collect();
        let json = to_json(&MachineFile { machine: &machine, chain: &chain, meshes: &meshes });
        Ok(page(json, &notes, &chain_sheet(&machine, &chain, &path.display().to_string())))
    })
}
