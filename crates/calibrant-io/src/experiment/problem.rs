//! Makes the design problem that an experiment file describes.

use super::{CriterionLetter, Experiment, Plan, Prior, ScaleBy};
use crate::EarlierCalibration;
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::estimate::KnownTerm;
use calibrant_core::information::criterion::{
    AOptimality, COptimality, Criterion, DOptimality, EOptimality, IOptimality, MOptimality,
};
use calibrant_core::sensor::{ParameterList, SensorParameters};
use calibrant_design::{DesignProblem, DesignSettings};
use nalgebra::{DMatrix, DVector};

impl Experiment {
    /// The criterion that `[design]` minimises, for these parameters of a sensor like `at`.
    ///
    /// With `scale_by = "datasheet"` the parameters are divided by their spread (for c the variances by its
    /// square). I needs no scale.
    ///
    /// # Errors
    /// [`Error::Experiment`] where c has no weight, I no range or no correction (`S` singular), or a spread
    /// is missing.
    pub fn criterion(&self, list: &ParameterList, at: &SensorParameters) -> Result<Criterion> {
        let reject = |key: &str, message: &str, help: &str| {
            Error::experiment(
                InputError::new(Refusal::KeyMissing, message, help).about_key(format!("design.{key}")),
            )
        };
        let scale = match self.design.scale_by {
            ScaleBy::None => DVector::repeat(list.len(), 1.0),
            ScaleBy::Datasheet => {
                let described = list.describe(&self.sensor, at);
                let spreads: Option<Vec<f64>> =
                    described.iter().map(|parameter| parameter.spread.filter(|sd| *sd > 0.0)).collect();
                DVector::from_vec(spreads.ok_or_else(|| {
                    reject("scale_by", "the datasheet spread of a parameter is missing", "add it to [sensor]")
                })?)
            }
        };
        Ok(match self.design.criterion {
            CriterionLetter::A => Criterion::A(AOptimality { scale }),
            CriterionLetter::D => Criterion::D(DOptimality { scale }),
            CriterionLetter::E => Criterion::E(EOptimality { scale }),
            CriterionLetter::M => Criterion::M(MOptimality { scale }),
            CriterionLetter::C => {
                let mut weights = DVector::zeros(list.len());
                for (name, weight) in &self.design.weights {
                    if let Some(place) = list.position(name) {
                        weights[place] = weight.get() / (scale[place] * scale[place]);
                    }
                }
                if weights.amax() == 0.0 {
                    let help = "weights = { \"scale.x\" = 1.0 } in [design]";
                    return Err(reject("weights", "criterion c needs a weight above 0", help));
                }
                Criterion::C(COptimality { weights })
            }
            CriterionLetter::I => {
                let range = self.design.range_mps2.map(f64::from).ok_or_else(|| {
                    reject(
                        "range_mps2",
                        "criterion I needs the operating range",
                        "range_mps2 = 20.0 in [design]",
                    )
                })?;
                Criterion::I(IOptimality::new(list, at, range).ok_or_else(|| {
                    reject(
                        "criterion",
                        "the matrix S cannot be inverted, so there is no corrected reading",
                        "check the sensor's gain, or the calibration that the design begins with",
                    )
                })?)
            }
        })
    }

    /// The design problem, with the information of earlier calibrations. Their information adds up, and the
    /// last one gives the values. Without any, the values are nominal.
    ///
    /// `[calibrate] prior = "datasheet"` adds the datasheet's information once, however many of the
    /// calibrations already contain it.
    ///
    /// # Errors
    /// [`Error::Experiment`] for a `[holds]` experiment, an unknown nominal gain or offset, or a calibration
    /// of another sensor (its parameters, their units). Also as [`criterion`](Self::criterion).
    pub fn design_problem(&self, earlier: &[EarlierCalibration]) -> Result<DesignProblem<'_>> {
        let Plan::Motion(plan) = &self.plan else {
            return Err(Error::experiment(InputError::new(
                Refusal::ExperimentUnsuited,
                format!("a design needs a [motion] experiment, this one has {}", self.plan.section()),
                "see `calibrant init report`",
            )));
        };
        let list = self.sensor.parameter_list();
        let (at, prior) = self.known_before(&list, earlier)?;
        Ok(DesignProblem {
            sensor: &self.sensor,
            intervals: plan.intervals,
            interval_s: plan.interval_s,
            rate_hz: plan.rate_hz,
            trust: plan.trust,
            known_ends: plan.known_ends,
            gravity: plan.gravity,
            clock: plan.clock,
            limits: &self.limits,
            criterion: self.criterion(&list, &at)?,
            at,
            prior,
        })
    }

    /// What the datasheet says of each parameter of the accelerometer, where it is the prior.
    #[must_use]
    pub fn datasheet_terms(&self) -> Vec<KnownTerm> {
        let nominal = self.sensor.nominal().filter(|_| self.calibrate.prior == Prior::Datasheet);
        let Some(nominal) = nominal else { return Vec::new() };
        let list = self.sensor.parameter_list();
        let described = list.describe(&self.sensor, &nominal).into_iter().zip(list.of_accelerometer());
        described
            .filter_map(|(of, quantity)| {
                Some(KnownTerm { quantity, value: of.nominal?, sd: Some(of.spread?) })
            })
            .collect()
    }

    /// The sensor at which a design begins, and the information that is there already.
    pub(super) fn known_before(
        &self,
        list: &ParameterList,
        earlier: &[EarlierCalibration],
    ) -> Result<(SensorParameters, Option<DMatrix<f64>>)> {
        let mut at = self.sensor.nominal();
        let mut prior: Option<DMatrix<f64>> = None;
        let mut datasheets = 0;
        for calibration in earlier {
            at = Some(calibration.sensor_of(list, self.sensor.unit)?);
            let information = calibration.information();
            prior = Some(prior.map_or_else(|| information.clone(), |sum| sum + information));
            datasheets += usize::from(calibration.has_datasheet_prior);
        }
        let at = at.ok_or_else(|| {
            let input_error = InputError::new(Refusal::KeyMissing,
                "the sensor's nominal gain and offset are not known, so a design has nothing to begin with",
                "give gain_counts_per_mps2 and offset_counts in [sensor], or an earlier calibration (option `from` calibration.json)",
            );
            Error::experiment(input_error.about_key("sensor.gain_counts_per_mps2"))
        })?;
        let wanted = usize::from(self.calibrate.prior == Prior::Datasheet);
        if wanted != datasheets && (wanted == 1 || datasheets > 1) {
            let described = list.describe(&self.sensor, &at);
            let weights: Option<Vec<f64>> =
                described.iter().map(|parameter| parameter.spread.map(|sd| 1.0 / (sd * sd))).collect();
            if let Some(weights) = weights {
                let times = 1.0 - datasheets as f64;
                let datasheet = DMatrix::from_diagonal(&(DVector::from_vec(weights) * times));
                prior = Some(prior.map_or_else(|| datasheet.clone(), |sum| sum + &datasheet));
            }
        }
        Ok((at, prior))
    }

    /// The settings of the search that `[design]` gives.
    #[must_use]
    pub fn design_settings(&self) -> DesignSettings {
        DesignSettings {
            starts: self.design.starts,
            seed: self.design.seed,
            certificate: self.design.certificate,
            ..DesignSettings::default()
        }
    }
}
