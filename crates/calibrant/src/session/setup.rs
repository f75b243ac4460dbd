//! What is known of the motion in one recording.

use super::clean::{take_out_motion_outliers, take_out_outliers};
use super::holds::{are_means, holds_of, with_holds};
use super::other_soaks::OtherSoaks;
use super::problem::Problem;
use super::recorded::Recorded;
use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::error::{Error, InputError, Refusal, Result, TaskOption};
use calibrant_core::estimate::{
    CalibrationProblem, FacesProblem, Gyroscope, HoldsSetup, ImuProblem, ImuSetup, KnownTerm,
    SoakTemperature, Stimulus, WhiteNoise, faces_found, recording_at,
};
use calibrant_core::motion::{CommandedMotion, Hold};
use calibrant_core::sensor::{ImuParameters, ImuQuantity, ImuRecording, Recording, Sensor, SensorKind};
use nalgebra::Vector3;

/// The commanded motion, or what is known of holds, rotations and turns.
#[derive(Clone)]
pub(crate) enum Setup<'e> {
    Motion(CommandedMotion),
    Holds(HoldsSetup),
    Faces(Faces),
    Imu(&'e Gyroscope, Box<ImuSetup>),
}

/// Holds of an accelerometer in known directions.
#[derive(Clone)]
pub(crate) struct Faces {
    pub(crate) holds: HoldsSetup,
    pub(crate) directions: Vec<Vector3<f64>>,
    pub(crate) face_sd_rad: Option<f64>,
}

impl<'e> Setup<'e> {
    fn holds_mut(&mut self) -> Option<&mut HoldsSetup> {
        match self {
            Self::Motion(_) => None,
            Self::Holds(holds) | Self::Faces(Faces { holds, .. }) => Some(holds),
            Self::Imu(_, setup) => Some(&mut setup.holds),
        }
    }

    /// Takes outliers out of the recording and finds the holds, where there are some.
    pub(crate) fn prepare(
        &mut self,
        accelerometer: &Sensor,
        recording: &mut ImuRecording,
    ) -> Vec<Diagnostic> {
        if let Self::Motion(command) = self {
            return take_out_motion_outliers(accelerometer, command, recording).into_iter().collect();
        }
        let Some(holds) = self.holds_mut() else { return Vec::new() };
        // among means no outlier is looked for
        let outliers = if are_means(holds, recording) { Vec::new() } else { take_out_outliers(recording) };
        *holds = with_holds(holds, recording);
        outliers
    }

    /// Each row of this recording is a hold.
    pub(crate) fn set_rows_as_holds(&mut self, recording: &ImuRecording) -> Result<()> {
        let times = recording[SensorKind::Accelerometer].as_ref().map_or(&[][..], Recording::times_s);
        match self {
            Self::Holds(holds) | Self::Faces(Faces { holds, .. }) => {
                holds.intervals_s = Some(times.iter().map(|&t| (t, t)).collect());
                Ok(())
            }
            Self::Motion(_) | Self::Imu(..) => Err(Error::experiment(InputError::new(
                Refusal::OptionsContradict,
                format!(
                    "{} is for an accelerometer that is held still: nothing moves between the rows",
                    TaskOption::RowsAreHolds
                ),
                "calibrate the accelerometer alone, with kind = \"accelerometer\"; a gyroscope needs the movements between the holds",
            ))),
        }
    }

    /// Gives each hold its direction, where these are known and no times were given. To be called with all holds found.
    pub(crate) fn set_faces(
        &mut self,
        accelerometer: &Sensor,
        recording: &ImuRecording,
    ) -> Result<Option<Diagnostic>> {
        let (holds, directions) = match self {
            Self::Faces(faces) if faces.has_recording_each() => return faces.one_hold_each().map(|()| None),
            Self::Faces(Faces { holds, directions, .. }) => (holds, directions),
            Self::Imu(_, setup) => match &mut setup.directions {
                Some(directions) => (&mut setup.holds, directions),
                None => return Ok(None),
            },
            Self::Motion(_) | Self::Holds(_) => return Ok(None),
        };
        if holds.intervals_s.is_some() {
            return Ok(None);
        }
        let all = match holds.found.take() {
            Some(found) => found,
            // again, for the reason
            None => holds_of(holds, recording)?.unwrap_or_default(),
        };
        let found = faces_found(accelerometer, &all, directions)?;
        *directions = found.directions;
        set_found(holds, found.holds);
        Ok(found.unmatched)
    }

    /// What other soaks say: the means of temperature terms, and a prior. Gives what is used of the prior: not what is known already.
    pub(crate) fn set_others(&mut self, others: &OtherSoaks) -> Vec<KnownTerm> {
        let (known, usual) = match self {
            Self::Holds(holds) => (&[][..], &mut holds.known),
            Self::Imu(_, setup) => {
                if let Some(sensor) = &others.sensor {
                    // what is said is about this temperature
                    setup.thermal.reference_c = Some(sensor.thermal.reference_c);
                }
                let setup = &mut **setup;
                (&setup.known[..], &mut setup.usual)
            }
            Self::Motion(_) | Self::Faces(_) => return Vec::new(),
        };
        for term in usual.iter_mut().filter(|term| term.sd.is_some()) {
            if let (ImuQuantity::Thermal(..), Some(sensor)) = (term.quantity, &others.sensor) {
                term.value = term.quantity.value(sensor);
            }
        }
        let is_free =
            |of: &&KnownTerm| known.iter().chain(&*usual).all(|known| known.quantity != of.quantity);
        let used: Vec<KnownTerm> = others.prior.iter().filter(is_free).copied().collect();
        usual.extend(&used);
        used
    }

    /// Takes the holds of an accelerometer alone to their mean temperature, by what is known of the sensor over temperature. Gives that temperature; `None` where there is none to
    /// be taken to. To be called with all holds found.
    pub(crate) fn take_to_mean_temperature(
        &mut self,
        imu: &ImuParameters,
        recording: &ImuRecording,
    ) -> Result<Option<f64>> {
        let Self::Holds(holds) = self else { return Ok(None) };
        let Some(found) = &mut holds.found else { return Ok(None) };
        let spans = found.iter().map(|hold| (hold.start_s, hold.end_s));
        let temperatures = SoakTemperature::each(recording, spans)?;
        let mean_c = temperatures.iter().map(|of| of.mean_c).sum::<f64>() / temperatures.len() as f64;
        let (sensor, thermal) =
            (imu[SensorKind::Accelerometer], imu.thermal.sensor(SensorKind::Accelerometer));
        let at = |celsius: f64| {
            let tau_k = imu.thermal.tau_k(celsius);
            (sensor.bias + thermal.bias_change(tau_k), thermal.gain_factor(tau_k))
        };
        for (hold, of) in found.iter_mut().zip(&temperatures) {
            let ((bias, gain), (mean_bias, mean_gain)) = (at(of.mean_c), at(mean_c));
            hold.mean = mean_bias + (hold.mean - bias).component_mul(&mean_gain).component_div(&gain);
        }
        // between given times the means would be taken from the recording again
        holds.intervals_s = None;
        // temperature explains it
        holds.bias_drift_sd_mps2 = 0.0;
        Ok((!temperatures.is_empty()).then_some(mean_c))
    }

    /// The uncertainty of the sample rate of these recordings, and where each further one begins.
    pub(crate) fn set_recordings(&mut self, recorded: &Recorded) {
        if let Some(holds) = self.holds_mut() {
            holds.further_from_s.clone_from(&recorded.further_from_s);
        }
        if let Self::Faces(Faces { holds, .. }) = self
            && !holds.further_from_s.is_empty()
        {
            // the intervals would be those of one recording
            holds.intervals_s = None;
        }
        if let Self::Imu(_, setup) = self {
            setup.rate_sd = recorded.rate_sd;
        }
    }

    /// The white noise of the gyroscope as this recording shows it.
    pub(crate) fn set_white_noise(&mut self, white_noise: Option<WhiteNoise>) {
        if let Self::Imu(_, setup) = self {
            setup.white_noise = white_noise;
        }
    }

    /// The setup for another recording of the same sensors. Intervals, directions, turns and known quantities belong to the first recording and are dropped.
    pub(crate) fn of_other(&self) -> Self {
        match self {
            Self::Motion(command) => Self::Motion(command.clone()),
            Self::Holds(holds) | Self::Faces(Faces { holds, .. }) => Self::Holds(of_other(holds)),
            Self::Imu(gyroscope, setup) => {
                let (holds, latitude_deg) = (of_other(&setup.holds), setup.latitude_deg);
                Self::Imu(gyroscope, Box::new(ImuSetup { holds, latitude_deg, ..ImuSetup::default() }))
            }
        }
    }

    /// The problem that this is part of.
    pub(crate) fn problem<'a>(
        &'a self,
        accelerometer: &'a Sensor,
        recorded: &'a Recorded,
    ) -> Result<Problem<'a>> {
        let stimulus = match self {
            Self::Motion(command) => Stimulus::Motion(command),
            Self::Holds(holds) => Stimulus::Holds(holds),
            Self::Faces(Faces { holds, directions, face_sd_rad }) => {
                let (recording, face_sd_rad) = (recorded.accelerometer()?, *face_sd_rad);
                let sensor = accelerometer;
                return Ok(Problem::Faces(FacesProblem {
                    sensor,
                    recording,
                    holds,
                    directions,
                    face_sd_rad,
                }));
            }
            Self::Imu(gyroscope, setup) => {
                let recording = &recorded.recording;
                return Ok(Problem::Imu(ImuProblem { accelerometer, gyroscope, recording, setup }));
            }
        };
        let recording = recorded.accelerometer()?;
        Ok(Problem::Accelerometer(CalibrationProblem { sensor: accelerometer, recording, stimulus }))
    }
}

impl Faces {
    /// Has each direction a recording of its own?
    fn has_recording_each(&self) -> bool {
        let further = self.holds.further_from_s.len();
        further > 0 && further + 1 == self.directions.len()
    }

    /// One hold for each direction: the longest of each recording.
    fn one_hold_each(&mut self) -> Result<()> {
        let holds = &mut self.holds;
        let recordings = holds.further_from_s.len() + 1;
        let found = holds.found.clone().unwrap_or_default();
        let longest = |recording: usize| {
            let of_it =
                found.iter().filter(|hold| recording_at(&holds.further_from_s, hold.start_s) == recording);
            of_it.max_by(|one, other| one.duration_s().total_cmp(&other.duration_s())).cloned()
        };
        let chosen: Vec<Option<Hold>> = (0..recordings).map(longest).collect();
        if let Some(missing) = chosen.iter().position(Option::is_none) {
            return Err(Error::experiment(InputError::new(
                Refusal::HoldsInvalid,
                format!("no hold was found in recording {} of {recordings}", missing + 1),
                "hold the sensor still in each recording, longer than holds.minimum_hold_s",
            )));
        }
        set_found(holds, chosen.into_iter().flatten().collect());
        Ok(())
    }
}

/// These holds are the ones.
fn set_found(holds: &mut HoldsSetup, chosen: Vec<Hold>) {
    holds.intervals_s = Some(chosen.iter().map(|hold| (hold.start_s, hold.end_s)).collect());
    holds.intervals_are_found = true;
    holds.found = Some(chosen);
}

/// Given intervals, found holds and further recordings belong to the first recording, and are dropped.
fn of_other(holds: &HoldsSetup) -> HoldsSetup {
    HoldsSetup {
        intervals_s: None,
        found: None,
        further_from_s: Vec::new(),
        known: Vec::new(),
        ..holds.clone()
    }
}
