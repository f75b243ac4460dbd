//! The data that all chains of a problem share, and its division into chains.

use super::fit::Chain;
use super::interval_moments::{Positions, moments, reference};
use super::sample_pairs::PairSums;
use super::{CalibrationProblem, CalibrationSettings, CommandedMotion, Trust, Vector3};
use crate::error::{Error, InputError, Refusal, Result};
use crate::motion::KnownEnds;
use crate::sensor::Quantity;
use nalgebra::SVector;
use std::ops::Range;

/// The data that all chains of a problem share.
pub(super) struct Context<'a> {
    pub(super) problem: &'a CalibrationProblem<'a>,
    pub(super) command: &'a CommandedMotion,
    pub(super) settings: &'a CalibrationSettings,
    /// Readings within the motion, and their places on it.
    pub(super) readings: &'a [Vector3<f64>],
    pub(super) positions: Positions,
    /// Pairs of nearby samples, for the whiteness test.
    pub(super) pairs: PairSums,
    /// The reading nearest to each node.
    reference: Vec<Vector3<f64>>,
    /// Standard deviation of a sample, in the unit of the readings.
    pub(super) noise: Vector3<f64>,
}

impl<'a> Context<'a> {
    pub(super) fn new(
        problem: &'a CalibrationProblem<'a>,
        command: &'a CommandedMotion,
        settings: &'a CalibrationSettings,
        used: Range<usize>,
    ) -> Result<Self> {
        let times = &problem.recording.times_s[used.clone()];
        let readings = &problem.recording.readings[used];
        let tau = command.motion.times_s();
        let positions = Positions::locate(times, tau);
        let mut context = Self {
            problem,
            command,
            settings,
            readings,
            pairs: PairSums::new(&positions),
            positions,
            reference: reference(times, readings, tau),
            noise: Vector3::repeat(1.0),
        };
        if command.trust == Trust::Unknown && command.known_ends != KnownEnds::Both {
            return Err(Error::experiment(InputError::new(
                Refusal::KeyMissing,
                "trust `unknown` needs the acceleration at both ends",
                "set known_ends = \"both\"",
            )));
        }
        context.noise = context.noise_of_a_sample()?;
        Ok(context)
    }

    /// The times of the nodes from the middle of the motion, s.
    pub(super) fn nodes_s(&self) -> Vec<f64> {
        let tau = self.command.motion.times_s();
        let middle = 0.5 * (tau[0] + tau[tau.len() - 1]);
        tau.iter().map(|time| time - middle).collect()
    }

    /// σ_ν in the unit of the readings. For counts without a nominal gain, a rough gain comes from the data.
    fn noise_of_a_sample(&self) -> Result<Vector3<f64>> {
        let sensor = self.problem.sensor;
        let gain = match sensor.gain {
            Some(gain) => gain,
            None => Vector3::from_fn(
                |axis, _| if axis < sensor.axes { self.gain_from_data(axis).abs() } else { 1.0 },
            ),
        };
        let noise = sensor.noise(&gain).ok_or_else(|| {
            Error::experiment(InputError::new(
                Refusal::KeyMissing,
                "the noise of a sample is not given",
                "set `sensor.noise_mps2`",
            ))
        })?;
        match sensor
            .active_axes()
            .iter()
            .find(|axis| !(noise[axis.index()] > 0.0 && noise[axis.index()].is_finite()))
        {
            Some(axis) => Err(Error::experiment(InputError::new(
                Refusal::ValueInvalid,
                format!("the noise of axis {axis} is {}, not a positive number", noise[axis.index()]),
                "set `sensor.noise_mps2` (or `noise_counts`) to the standard deviation of one sample",
            ))),
            None => Ok(noise),
        }
    }

    /// Rough gain of one axis, negative where the axis is reversed: reading against commanded acceleration, over the samples or (trust `unknown`) the two ends.
    fn gain_from_data(&self, axis: usize) -> f64 {
        let nodes = self.command.motion.acceleration_mps2();
        let last = nodes.len() - 1;
        let ends =
            (self.reference[last][axis] - self.reference[0][axis]) / (nodes[last][axis] - nodes[0][axis]);
        let gain = if self.command.trust == Trust::Unknown {
            ends
        } else {
            let mean = |values: &dyn Fn(usize) -> f64| {
                (0..nodes.len()).map(values).sum::<f64>() / nodes.len() as f64
            };
            let (a, y) = (mean(&|i| nodes[i][axis]), mean(&|i| self.reference[i][axis]));
            let covariance = mean(&|i| (nodes[i][axis] - a) * (self.reference[i][axis] - y));
            covariance / mean(&|i| (nodes[i][axis] - a).powi(2))
        };
        if gain.is_finite() && gain != 0.0 { gain } else { 1.0 }
    }

    /// The chain of these axes.
    pub(super) fn chain<const D: usize, const P: usize>(
        &self,
        axes: [usize; D],
        slots: [usize; P],
    ) -> Chain<D, P> {
        let motion = &self.command.motion;
        let pick = |v: &Vector3<f64>| SVector::<f64, D>::from_fn(|k, _| v[axes[k]]);
        let jerk = motion.jerk_mps3();
        // noise below the rounding of the accelerations counts as zero
        let rounding =
            64.0 * f64::EPSILON * motion.acceleration_mps2().iter().map(Vector3::amax).fold(0.0, f64::max);
        let variance: Vec<SVector<f64, D>> = (0..motion.intervals())
            .map(|i| match self.command.trust {
                Trust::Known => SVector::zeros(),
                Trust::Unknown => SVector::repeat(f64::INFINITY),
                Trust::Noisy(noise) => pick(&noise.sd(&jerk[i])).map(|sd| {
                    let step = sd * motion.interval_s(i);
                    if step <= rounding { 0.0 } else { step * step }
                }),
            })
            .collect();
        let commanded =
            motion.acceleration_mps2().windows(2).map(|pair| pick(&(pair[1] - pair[0]))).collect();
        let mut fixed = vec![[false; D]; motion.intervals()];
        if self.command.known_ends == KnownEnds::Both && self.command.trust != Trust::Known {
            // exactly known last increments make the nodes before them known
            for k in 0..D {
                let mut i = motion.intervals() - 1;
                fixed[i][k] = true;
                while i > 0 && variance[i][k] == 0.0 {
                    i -= 1;
                    fixed[i][k] = true;
                }
            }
        }
        Chain {
            moments: moments(&self.positions, self.readings, &self.reference, axes),
            reference: self.reference.iter().map(pick).collect(),
            weight: pick(&self.noise).map(|noise| 1.0 / (noise * noise)),
            variance,
            commanded,
            fixed,
            prior: self.prior(slots),
            rigid: self.command.trust == Trust::Known,
        }
    }

    fn prior<const P: usize>(&self, slots: [usize; P]) -> Option<(SVector<f64, P>, SVector<f64, P>)> {
        if !self.settings.datasheet_prior {
            return None;
        }
        let sensor = self.problem.sensor;
        let list = sensor.parameter_list();
        let parameters = list.describe(sensor, &sensor.nominal()?);
        // with gravity the place of a bias is that of the reading at rest, of which the datasheet says nothing
        let is_hidden = |slot: usize| {
            self.command.gravity.is_some() && matches!(list.quantities()[slot], Quantity::Bias(_))
        };
        let mean = SVector::from_fn(|k, _| parameters[slots[k]].nominal.unwrap_or(0.0));
        let weight = SVector::from_fn(|k, _| match parameters[slots[k]].spread {
            Some(spread) if !is_hidden(slots[k]) => spread.powi(-2),
            _ => 0.0,
        });
        Some((mean, weight))
    }

    /// Initial parameters for trust `unknown`. The gain comes from the two ends, or is nominal if noise hides it. The bias comes from the
    /// start.
    pub(super) fn start_from_ends(&self, axis: usize) -> (f64, f64) {
        let last = self.reference.len() - 1;
        let clear = (self.reference[last][axis] - self.reference[0][axis]).abs() > 10.0 * self.noise[axis];
        let gain = match self.problem.sensor.gain {
            Some(nominal) if !clear => nominal[axis],
            _ => self.gain_from_data(axis),
        };
        (self.reference[0][axis] - gain * self.command.motion.acceleration_mps2()[0][axis], gain)
    }
}
