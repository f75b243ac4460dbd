//! A simulated sensor on a random motion.

use calibrant::estimate::{Calibration, CalibrationProblem, CalibrationSettings, Stimulus, calibrate};
use calibrant::motion::{CommandedMotion, JerkControlledMotion, KnownEnds, Limits, MotionClock, Trust};
use calibrant::sensor::{Recording, Sensor, SensorModel, SensorParameters};
use calibrant::simulate::{
    Purpose, draw_sensor, initial_motion, perturb, sample_times, simulate_recording, stream,
};

/// A simulated sensor on a random motion.
#[derive(Clone)]
pub(crate) struct Case {
    pub(crate) sensor: Sensor,
    pub(crate) truth: SensorParameters,
    pub(crate) command: CommandedMotion,
    pub(crate) recording: Recording,
}

impl Case {
    pub(crate) fn new(
        model: SensorModel,
        trust: Trust,
        intervals: usize,
        interval_s: f64,
        rate_hz: f64,
        seed: u64,
    ) -> Self {
        let mut rng = stream(seed, Purpose::Motion, 0);
        let motion = initial_motion(intervals, interval_s, 3, &Limits::default(), &mut rng).expect("valid");
        Self::with_motion(model, trust, motion, rate_hz, seed)
    }

    pub(crate) fn with_motion(
        model: SensorModel,
        trust: Trust,
        motion: JerkControlledMotion,
        rate_hz: f64,
        seed: u64,
    ) -> Self {
        let mut sensor = Sensor::memsic_mxd2020u();
        sensor.model = model;
        sensor.cross_axis_sd = Some(0.01);
        let mut rng = stream(seed, Purpose::Sensor, 0);
        let truth = draw_sensor(&sensor, &mut rng);
        let happened = match trust {
            Trust::Noisy(noise) => perturb(&motion, &noise, 3, KnownEnds::Start, &mut rng).expect("valid"),
            _ => motion.clone(),
        };
        let times = sample_times(&motion, rate_hz);
        let noise = sensor.noise_mps2.expect("given");
        let recording = simulate_recording(&truth, &noise, sensor.unit, 3, &happened, &times, &mut rng);
        let known_ends = if trust == Trust::Unknown { KnownEnds::Both } else { KnownEnds::Start };
        Self {
            sensor,
            truth,
            command: CommandedMotion {
                motion,
                trust,
                known_ends,
                gravity: None,
                clock: MotionClock::default(),
            },
            recording,
        }
    }

    pub(crate) fn with_trust(&self, trust: Trust, known_ends: KnownEnds) -> Self {
        let mut case = self.clone();
        case.command.trust = trust;
        case.command.known_ends = known_ends;
        case
    }

    pub(crate) fn problem(&self) -> CalibrationProblem<'_> {
        CalibrationProblem {
            sensor: &self.sensor,
            recording: &self.recording,
            stimulus: Stimulus::Motion(&self.command),
        }
    }

    pub(crate) fn calibrate(&self) -> calibrant::Result<Calibration> {
        calibrate(&self.problem(), &CalibrationSettings::default())
    }
}
