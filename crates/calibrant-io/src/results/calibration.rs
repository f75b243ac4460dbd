//! `calibration.json` of an accelerometer or of an IMU. Every reader of calibrations takes it.

use super::heading::{Heading, JsonFile};
use super::judgement::Judgement;
use super::origin::Origin;
use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::estimate::{Calibration, Validation};
use calibrant_core::json::{flat, if_any};
use calibrant_core::json_object;
use std::collections::BTreeMap;

/// The content of `calibration.json`, which [`read_calibrated_imu`](crate::read_calibrated_imu) reads: the calibration, where it comes from,
/// and what judges it.
///
/// The same calibration gives the same bytes. A section is there where it has something to say: `motion` or
/// `holds`, and `still_gyroscope`, `rotations`, `turns` of an IMU. Arrays over axes have 1 or 3 entries.
/// Fields in the unit of the readings end in `_mps2`, `_radps` or `_counts`. Angles are in rad; of a rotation
/// that could not be integrated they are `null`.
#[derive(Clone, Copy)]
pub struct CalibrationFile<'a> {
    /// The calibration.
    pub calibration: &'a Calibration,
    /// Its errors on data that it did not use.
    pub validations: &'a [Validation],
    /// Of which sensor it is, and from which files.
    pub origin: &'a Origin,
    /// What judges it.
    pub judgement: Judgement<'a>,
}

impl<'a> CalibrationFile<'a> {
    /// A calibration with all that stands beside it.
    #[must_use]
    pub fn of(
        calibration: &'a Calibration,
        validations: &'a [Validation],
        origin: &'a Origin,
        judgement: &Judgement<'a>,
    ) -> Self {
        Self { calibration, validations, origin, judgement: *judgement }
    }

    fn validation(&self) -> BTreeMap<&'static str, &'a Validation> {
        self.validations.iter().map(|validation| (validation.source_name(), validation)).collect()
    }

    fn warnings(&self) -> Vec<Diagnostic> {
        self.judgement.stated(&self.calibration.warnings)
    }
}

json_object! {
    /// A calibration of an accelerometer or of an IMU, where it comes from, and what judges it.
    CalibrationFile<'_> as file {
        heading: flat(Heading::<Self>::of()),
        origin: flat(file.origin),
        verdict: file.judgement.verdict(&file.calibration.warnings),
        calibration: flat(file.calibration),
        /// Errors on data that were not used, by their source: `recording`, `folds`.
        validation: if_any(file.validation()),
        /// The figures beside their limits.
        limits: if_any(file.judgement.limits),
        warnings: file.warnings(),
    }
}

impl JsonFile for CalibrationFile<'_> {
    const KIND: &'static str = "calibration";
}
