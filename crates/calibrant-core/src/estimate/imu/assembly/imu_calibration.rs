//! Assembles the result, and computes nothing else.

use crate::diagnostic::Change;
use crate::error::Result;
use crate::estimate::at_rest::AtRest;
use crate::estimate::hold_result::{HoldCalibration, HoldResult};
use crate::estimate::imu::assembly::gyroscope_before::{gyroscope_before, with_plain_gyroscope};
use crate::estimate::imu::assembly::holds::hold_results;
use crate::estimate::imu::assembly::rotations::rotation_results;
use crate::estimate::imu::assembly::stationary::stationary_result;
use crate::estimate::imu::clock::ClockDifference;
use crate::estimate::imu::covariance::ImuUncertainty;
use crate::estimate::imu::initial::accelerometer::InitialAccelerometer;
use crate::estimate::imu::model::{ImuModel, TurnData, singular};
use crate::estimate::imu::problem::{ImuProblem, Turn};
use crate::estimate::imu::result::{GyroscopeCalibration, TurnResult};
use crate::estimate::imu::rotations::movement::Movement;
use crate::estimate::imu::stationary::gyroscope::StationaryGyroscope;
use crate::estimate::imu::temperature::RecordingTemperature;
use crate::estimate::imu::terms::sums::degrees_of_freedom;
use crate::estimate::imu::terms::term::At;
use crate::estimate::imu::thermometer::ThermometerLag;
use crate::estimate::imu::variance_components::solution::Solution;
use crate::estimate::recording_biases::RecordingBiases;
use crate::estimate::result::{Calibration, FitStatistics};
use crate::sensor::{ImuParameters, ImuQuantity, Parameter, PerSensor, SensorKind};

/// The parts of the result.
pub(crate) struct Finished<'a> {
    pub(crate) problem: &'a ImuProblem<'a>,
    pub(crate) accelerometer: &'a InitialAccelerometer,
    pub(crate) temperature: &'a RecordingTemperature<'a>,
    /// Numbers of the used holds.
    pub(crate) numbers: &'a [usize],
    pub(crate) gyroscope: &'a StationaryGyroscope,
    pub(crate) movement: &'a Movement<'a>,
    /// The IMU before the least squares.
    pub(crate) start: &'a ImuParameters,
    /// The gyroscope's biases in earlier recordings.
    pub(crate) biases: Option<&'a RecordingBiases>,
    pub(crate) model: &'a ImuModel<'a>,
    pub(crate) solution: &'a Solution,
    pub(crate) uncertainty: ImuUncertainty,
    pub(crate) clock: Option<ClockDifference>,
    pub(crate) thermometer: Option<ThermometerLag>,
    /// Changes of the sensors.
    pub(crate) changes: Vec<Change>,
}

impl Finished<'_> {
    /// The result without warnings.
    pub(crate) fn assemble(self) -> Result<Calibration> {
        let Self { problem, model, solution, uncertainty, gyroscope, .. } = self;
        let (fit, imu) = (&solution.fit, solution.fit.state.imu);
        let before = gyroscope_before(problem.gyroscope, &model.holds, self.start, &imu);
        let plain = with_plain_gyroscope(self.start, &before);
        let rotations = rotation_results(model, solution, self.movement, &plain, self.numbers);
        let holds =
            hold_results(problem, (self.accelerometer, self.temperature), self.numbers, model, &fit.state)?;
        let of_hold = |hold: &HoldResult| self.temperature.of_hold(&hold.hold);
        let follows = !problem.setup.thermal.is_none();
        let units: PerSensor<_> = [problem.accelerometer.unit, problem.gyroscope.unit].into();
        let unit = |quantity: &ImuQuantity| units[quantity.sensor_kind()];
        let at_rest = AtRest {
            parameters: model.quantities.iter().map(|of| Parameter::undescribed(*of, unit(of))).collect(),
            quantities: model.quantities.clone(),
            units: PerSensor::from_fn(|sensor_kind| Some(units[sensor_kind])),
            imu,
            uncertainty: uncertainty.uncertainty,
            holds: HoldCalibration {
                temperatures_c: follows.then(|| holds.holds.iter().map(of_hold).collect()),
                thermometer: self.thermometer,
                ..holds
            },
            fit: FitStatistics::of_chi2(
                fit.chi2,
                degrees_of_freedom(&At { model, state: &fit.state, rotations: &fit.residuals }),
            ),
            status: fit.status,
            iterations: fit.iterations,
            gradient_norm: fit.gradient_norm,
        };
        let mut calibration = at_rest.calibration();
        // an IMU says it of each, also where there is no prior
        calibration.prior_share.resize(model.quantities.len(), 0.0);
        Ok(Calibration {
            gyroscope: Some(Box::new(GyroscopeCalibration {
                unit: problem.gyroscope.unit,
                still: stationary_result(
                    model,
                    (&fit.state, &solution.between),
                    (gyroscope, self.numbers),
                    &plain,
                    problem.setup.vertical_rate(),
                )?,
                before,
                recording_biases: self.biases.cloned(),
                rotations,
                between_rotations_sd_rad: model.rotation_scatter.between_sd_rad,
                knock_rms: model.rotation_scatter.knock_rms,
                turns_in_holds: model.turns_in_holds,
                turns: turn_results(model, &problem.setup.turns, &imu)?,
                time_offset: self.clock.map(|clock| clock.time_offset()),
                clocks: self.clock.and_then(|clock| clock.rate()),
                latitude_deg: problem.setup.latitude_deg,
                of_vertical: uncertainty.of_vertical,
                north_rms_radps: uncertainty.north_rms_radps,
            })),
            changes: self.changes,
            ..calibration
        })
    }
}

/// The turns of known angle, measured with the calibrated gyroscope.
fn turn_results(model: &ImuModel<'_>, turns: &[Turn], imu: &ImuParameters) -> Result<Vec<TurnResult>> {
    let result = |(data, turn): (&TurnData, &Turn)| {
        let correction =
            imu.at(data.temperature_c)[SensorKind::Gyroscope].matrix.try_inverse().ok_or_else(singular)?;
        Ok(TurnResult {
            start_s: turn.start_s,
            end_s: turn.end_s,
            angle_rad: data.angle,
            measured_rad: data.angle + correction * model.turn_residual(data, imu),
        })
    };
    model.turns.iter().zip(turns).map(result).collect()
}
