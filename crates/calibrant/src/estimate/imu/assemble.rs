//! Puts the result together.

use super::changing::Changing;
use super::clocks::{ClockDifference, ClockRate};
use super::contradiction::contradictions;
use super::faces::First;
use super::joint::{Fit, HoldData, Joint, Miss, State};
use super::magnitudes;
use super::rates::{LocalBias, Path};
use super::readings::{Integrable, Span};
use super::solver::singular;
use super::start;
use super::still::StillNoise;
use super::thermal::Climate;
use super::verdict;
use super::weights::Weighed;
use super::{ImuCalibration, ImuProblem, NoiseSource, RotationResult, StillGyroscope, TurnResult};
use crate::error::Result;
use crate::estimate::gravity::gravity_slope;
use crate::estimate::holds::left_out;
use crate::estimate::one_sided::one_sided;
use crate::estimate::{CoarseAxis, HoldCalibration, Uncalibrated};
use crate::information;
use crate::sensor::{
    Condition, Correction, ImuParameters, MeanReading, ReadingUnit, Temperatures, Thermal, Triad,
};
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};
use rayon::prelude::*;

/// Everything that the result is put together from.
pub(super) struct Finished<'a> {
    pub(super) joint: &'a Joint<'a>,
    pub(super) fit: &'a Fit,
    pub(super) weighed: &'a Weighed,
    pub(super) before: &'a ImuParameters,
    pub(super) between: Vector3<f64>,
    pub(super) integrable: &'a Integrable<'a>,
    pub(super) noise_source: NoiseSource,
    /// What is to be said of holds that were given, in words.
    pub(super) said: &'a [String],
    /// Axes of the gyroscope whose steps are coarse.
    pub(super) coarse: &'a [CoarseAxis],
    /// Standard deviation of the gyroscope's samples within the holds.
    pub(super) scatter: Vector3<f64>,
    pub(super) spans: &'a [Span],
    pub(super) chosen: &'a [usize],
    pub(super) climate: &'a Climate<'a>,
    /// Mean readings of the gyroscope in the holds, also in those in which it is taken to turn.
    pub(super) stills: &'a [Option<MeanReading>],
}

impl Finished<'_> {
    pub(super) fn assemble(
        &self,
        problem: &ImuProblem<'_>,
        holds: &HoldCalibration,
        axes: Option<start::Axes>,
        first: &First,
    ) -> Result<ImuCalibration> {
        let (joint, fit) = (self.joint, self.fit);
        let size = joint.quantities.len();
        let mut covariance = information::covariance(&fit.information).ok_or_else(singular)?;
        let prior_share: Vec<f64> = (0..size)
            .map(|k| {
                joint
                    .prior
                    .as_ref()
                    .map_or(0.0, |(_, weight)| (weight[k] * covariance[(k, k)]).clamp(0.0, 1.0))
            })
            .collect();
        let imu = fit.state.imu;
        let g = problem.setup.holds.gravity;
        // what gravity's own uncertainty adds
        let slope = gravity_slope(&joint.quantities, &imu, &g);
        covariance += &slope * slope.transpose() * (g.sd_mps2 * g.sd_mps2);
        // what coarse steps add: holds that show nearly the same are off alike
        let of_noise = covariance.clone();
        for (slope, sd) in self.common_slopes(&of_noise) {
            covariance += &slope * slope.transpose() * (sd * sd);
        }
        let (of_vertical, north_rms_radps) = self.add_earth(&mut covariance)?;
        let before = self.gyroscope_before(problem);
        let rotations = self.rotations(&before);
        let counted = rotations.iter().filter(|rotation| rotation.used).count();
        let stills = joint.holds.iter().filter(|hold| hold.gyroscope.is_some()).count();
        let equations =
            3 * joint.holds.len() + 3 * stills + 2 * counted + 3 * joint.turns.len() + joint.priors();
        let unknowns = size + 2 * joint.holds.iter().filter(|hold| hold.known.is_none()).count();
        let mut holds = holds.clone();
        for (&j, force) in self.chosen.iter().zip(&fit.state.forces) {
            holds.holds[j].force_mps2 = *force;
        }
        let said_before = left_out(&holds);
        magnitudes::correct(&mut holds, &imu, self.climate)?;
        // of faces the fit of these knows it
        if first.met.is_none() {
            let of_accelerometer = |k: &usize| joint.quantities[*k].triad() == Triad::Accelerometer;
            let known = |k: &usize| joint.prior.as_ref().is_some_and(|(_, weight)| weight[*k] > 0.0);
            let unknown = (0..size).filter(of_accelerometer).filter(|k| !known(k)).count();
            holds.degrees_of_freedom = joint.holds.len().saturating_sub(unknown);
        }
        holds.before = Uncalibrated::accelerometer(problem.accelerometer, &imu.accelerometer);
        let turns = joint
            .turns
            .iter()
            .zip(&problem.setup.turns)
            .map(|(data, turn)| {
                let correction =
                    imu.at(data.temperature_c).gyroscope.matrix.try_inverse().ok_or_else(singular)?;
                Ok(TurnResult {
                    start_s: turn.start_s,
                    end_s: turn.end_s,
                    angle_rad: data.angle,
                    measured_rad: data.angle + correction * joint.turn_residual(data, &imu),
                })
            })
            .collect::<Result<_>>()?;
        let follows = !problem.setup.thermal.is_none();
        let hold_temperatures_c =
            follows.then(|| holds.holds.iter().map(|hold| self.climate.of_hold(&hold.hold)).collect());
        let of_accelerometer = first.warnings.iter().filter(|said| !said_before.contains(said));
        let warnings =
            left_out(&holds).into_iter().chain(of_accelerometer.chain(self.said).cloned()).collect();
        let (stills, between, chosen) = (self.stills, self.between, self.chosen);
        let changes = Changing { joint, fit, stills, between, holds: &holds, chosen }.changes();
        let mut calibration = ImuCalibration {
            status: fit.status,
            iterations: fit.iterations,
            gradient_norm: fit.gradient_norm,
            values: joint.quantities.iter().map(|quantity| quantity.of(&imu)).collect(),
            quantities: joint.quantities.clone(),
            covariance,
            prior_share,
            imu,
            accelerometer_unit: problem.accelerometer.unit,
            gyroscope_unit: problem.gyroscope.unit,
            latitude_deg: problem.setup.latitude_deg,
            of_vertical,
            north_rms_radps,
            chi2: fit.chi2,
            degrees_of_freedom: equations.saturating_sub(unknowns),
            holds,
            still: StillGyroscope {
                noise: joint.gyroscope_noise.of_sample,
                noise_source: self.noise_source,
                within_holds_sd: StillNoise::of(self.scatter, self.coarse).of_sample,
                between_holds_sd: self.between_holds_sd(),
                rate_rms_radps: self.rate_rms(&imu, problem.setup.vertical_rate()).ok_or_else(singular)?,
                rate_rms_before_radps: self
                    .rate_rms(&self.plain(&before), problem.setup.vertical_rate())
                    .ok_or_else(singular)?,
            },
            gyroscope_before: before,
            rotations,
            rotation_excess_sd_rad: joint.excess_rad,
            turns,
            hold_temperatures_c,
            changes,
            clocks: None,
            validations: Vec::new(),
            warnings,
        };
        if !calibration.changes.is_empty() {
            let temperatures = Temperatures::of(problem.recording).ok().flatten().filter(|_| !follows);
            let range_c = temperatures.and_then(|temperatures| temperatures.range_c());
            let said = calibration.changes.iter().map(|change| change.warning(range_c));
            calibration.warnings.splice(0..0, said.collect::<Vec<_>>());
        }
        calibration.warnings.extend(verdict::warnings(&calibration, axes.as_ref()));
        calibration.warnings.extend(contradictions(
            &calibration,
            (joint, fit),
            &problem.setup.turns,
            &self.scatter,
            axes.is_some(),
        ));
        let unit = problem.gyroscope.unit.symbol();
        calibration.warnings.extend(self.coarse.iter().map(|found| {
            format!(
                "{}; the standard deviations know of it; choose a smaller range, or more digits in the file",
                found.words("gyroscope", unit)
            )
        }));
        if let Some(gyroscope) = &problem.recording.gyroscope {
            let used = calibration.holds.holds.iter().filter(|hold| hold.used).map(|result| &result.hold);
            calibration.warnings.extend(one_sided(gyroscope, Triad::Gyroscope, used));
        }
        if let Some((rate, words)) = self.clocks(problem) {
            calibration.clocks = rate;
            calibration.warnings.splice(0..0, words);
        }
        calibration.warnings.extend(verdict::extrapolation(&imu.thermal, self.climate.of_recording()));
        Ok(calibration)
    }

    /// What the unknown rate of the Earth adds to a covariance: `D C Dᵀ`, with `C` that of its unknowns and `D = −K C⁻¹` how the estimates follow them, `K` the covariance of both. Gives how each
    /// estimate follows the rate about the vertical, by one standard deviation of that, where it is unknown, and how large that about the north is.
    fn add_earth(&self, covariance: &mut DMatrix<f64>) -> Result<(Option<DVector<f64>>, f64)> {
        let (places, all) = (self.joint.gyroscope_places(), &self.weighed.covariance);
        let count = all.nrows() - places.len();
        let mut both = DMatrix::zeros(covariance.nrows(), count);
        for (row, &k) in places.iter().enumerate() {
            both.row_mut(k).copy_from(&all.view((row, places.len()), (1, count)));
        }
        let own = all.view((places.len(), places.len()), (count, count)).into_owned();
        let of_vertical = self
            .joint
            .earth
            .has_vertical()
            .then(|| both.column(0) / own[(0, 0)].max(f64::MIN_POSITIVE).sqrt());
        let north_rms_radps = self.joint.earth.north_rms(&own);
        let follow = own.cholesky().ok_or_else(singular)?.solve(&both.transpose());
        *covariance += both * follow;
        Ok((of_vertical, north_rms_radps))
    }

    /// The scatter between holds, with that by the Earth's rate beyond what was given.
    fn between_holds_sd(&self) -> Vector3<f64> {
        let (joint, state) = (self.joint, &self.fit.state);
        let found = |(j, hold): (usize, &HoldData)| {
            let rate = joint.earth.rate_found(j, &state.forces[j]);
            (state.imu.at(hold.temperature_c).gyroscope.matrix * rate).map(|reading| reading * reading)
        };
        let squares: Vector3<f64> = joint.holds.iter().enumerate().map(found).sum();
        (squares / joint.holds.len() as f64 + self.between.component_mul(&self.between)).map(f64::sqrt)
    }

    /// The rates of the sensors' clocks, and what is to be said of them.
    fn clocks(&self, problem: &ImuProblem<'_>) -> Option<(Option<ClockRate>, Option<String>)> {
        let (accelerometer, gyroscope) =
            (problem.recording.accelerometer.as_ref()?, problem.recording.gyroscope.as_ref()?);
        let found = ClockDifference::of(self.joint, &self.fit.state, accelerometer)?;
        Some((found.rate(), found.words(accelerometer, gyroscope)))
    }

    /// For each coarse axis of the gyroscope: how the estimates follow errors that its means in the holds, or its readings in the rotations, have in common, and their size. Holds that read nearly the
    /// same are rounded alike; what the force changes of the reading is then stretched or shrunk, so that a part of the error follows the force.
    fn common_slopes(&self, covariance: &DMatrix<f64>) -> Vec<(DVector<f64>, f64)> {
        let (joint, imu) = (self.joint, &self.fit.state.imu);
        let of = |found: &CoarseAxis| {
            let axis = found.axis.index();
            // the same in all, and along each component of the force
            let mut of_holds: [DVector<f64>; 4] =
                std::array::from_fn(|_| DVector::zeros(joint.quantities.len()));
            let mut of_rotations = of_holds[0].clone();
            for (miss, data) in self.fit.misses.iter().zip(&joint.rotations) {
                let Some(miss) = miss.as_ref().filter(|_| data.counts) else { continue };
                let by_reading = miss.by_turn * miss.rotation.by_reading().column(axis);
                let weighted = joint.weight(miss) * by_reading;
                for (k, by_parameter) in miss.by_parameters.column_iter().enumerate() {
                    of_rotations[k] -= by_parameter.dot(&weighted);
                }
            }
            for (j, (hold, force)) in joint.holds.iter().zip(&self.fit.state.forces).enumerate() {
                let Some((_, weight)) = &hold.gyroscope else { continue };
                let (stimulus, temperature_c) = (joint.earth.rate(j, force), hold.temperature_c);
                let at = Condition { imu, stimulus, force: *force, temperature_c };
                let shapes = force.push(joint.gravity) / joint.gravity;
                for k in joint.gyroscope_places() {
                    let weighted = joint.quantities[k].derivative(&at)[axis] * weight[axis];
                    of_holds
                        .iter_mut()
                        .zip(shapes.iter())
                        .for_each(|(gradient, shape)| gradient[k] += weighted * shape);
                }
            }
            // an axis that hardly turns in the rotations is off by the same in these as in the holds
            of_holds[0] += &of_rotations;
            let all = of_holds.into_iter().chain([of_rotations]);
            all.map(|gradient| (covariance * gradient, found.mean_sd)).collect::<Vec<_>>()
        };
        self.coarse.iter().flat_map(of).collect()
    }

    /// The mean rate that an IMU's gyroscope shows in the holds, root mean square over them; `None` where its matrix is singular.
    fn rate_rms(&self, imu: &ImuParameters, vertical_rate: f64) -> Option<f64> {
        let (mut sum, mut count) = (0.0, 0);
        for (hold, force) in self.joint.holds.iter().zip(&self.fit.state.forces) {
            let Some((mean, _)) = &hold.gyroscope else { continue };
            let correction = Correction::of(&imu.at(hold.temperature_c).gyroscope)?;
            let rate = correction.apply(&(mean - imu.g_sensitivity * force));
            sum += (rate - force * vertical_rate).norm_squared();
            count += 1;
        }
        Some((sum / f64::from(count.max(1))).sqrt())
    }

    /// The IMU with this gyroscope, of which nothing else is known.
    fn plain(&self, gyroscope: &Uncalibrated) -> ImuParameters {
        ImuParameters {
            gyroscope: gyroscope.sensor,
            g_sensitivity: Matrix3::zeros(),
            thermal: Thermal::none(),
            ..*self.before
        }
    }

    /// The gyroscope before: the datasheet's gain and the mean reading at rest; where the gain had to be found, one for all axes.
    fn gyroscope_before(&self, problem: &ImuProblem<'_>) -> Uncalibrated {
        let mut sensor = self.before.gyroscope;
        sensor.bias = start::mean_bias(&self.joint.holds, &Thermal::none());
        let nominal = problem.gyroscope.gain.map(|gain| Matrix3::from_diagonal(&gain));
        let source = match problem.gyroscope.unit {
            ReadingUnit::Counts if nominal == Some(sensor.matrix) => {
                "the datasheet's gain, less the mean reading at rest"
            }
            ReadingUnit::Counts => {
                let gain = |matrix: &Matrix3<f64>| matrix.row_iter().map(|row| row.norm()).sum::<f64>() / 3.0;
                // the search for a start keeps the order of the axes, its gain is a rough one
                sensor.matrix *= gain(&self.fit.state.imu.gyroscope.matrix) / gain(&sensor.matrix);
                "one gain for all axes, the mean of those found, less the mean reading at rest"
            }
            _ => "the readings less their mean at rest",
        };
        Uncalibrated { sensor, source: source.to_owned() }
    }

    fn rotations(&self, before: &Uncalibrated) -> Vec<RotationResult> {
        let joint = self.joint;
        let with_before = State { imu: self.plain(before), forces: self.fit.state.forces.clone() };
        let angle = |miss: &Miss| miss.error.norm();
        joint
            .rotations
            .par_iter()
            .zip(self.spans)
            .enumerate()
            .map(|(i, (data, span))| {
                let (from_hold, to_hold) = (self.chosen[i], self.chosen[i + 1]);
                let after = self.fit.misses[i].as_ref();
                // one bias throughout
                let mut plain = data.clone();
                plain.samples.drift = plain.samples.drift.map(|end| LocalBias::none(end.temperature_c));
                let before = after.and_then(|_| joint.miss(&plain, &with_before));
                let studentised = self.weighed.studentised.get(i).copied().unwrap_or(f64::INFINITY);
                let reason = match self.integrable.obstacle(span) {
                    Some(obstacle) => Some(obstacle),
                    None if !data.counts => Some(format!(
                        "it misses gravity by {:.2}°, {studentised:.1} standard deviations",
                        after.map_or(0.0, &angle).to_degrees()
                    )),
                    None => None,
                };
                let path = after.map_or_else(Path::default, |_| data.samples.path(&self.fit.state.imu));
                RotationResult {
                    from_hold,
                    to_hold,
                    start_s: span.start_s,
                    end_s: span.end_s,
                    path_rad: path.length_rad,
                    peak_radps: path.peak_radps,
                    error_rad: after.map_or(0.0, &angle),
                    error_before_rad: before.as_ref().map_or(0.0, &angle),
                    studentised: if studentised.is_finite() { studentised } else { 0.0 },
                    used: data.used && data.counts,
                    reason,
                }
            })
            .collect()
    }
}
