//! The expected information on all parameters: it assembles the blocks of the axes that are estimated
//! together.
//!
//! The axes of a scale-bias sensor share no parameter, so its information is block diagonal, one block for
//! each axis. A full sensor is one block. [`PartInformation`] computes a block and its change with the
//! motion.

use super::chain_model::FULL_SLOTS;
use super::clock_response::marginal;
use super::motion_information::PartInformation;
use crate::error::{Error, InputError, Refusal, Result};
use crate::motion::{IntervalSums, JerkControlledMotion, KnownEnds, MotionClock, Trust};
use crate::sensor::{Sensor, SensorModel, SensorParameters};
use nalgebra::{DMatrix, SMatrix, SVector, Vector3};

/// The conditions of an experiment, without its motion.
#[derive(Debug, Clone)]
pub struct MotionInformation {
    /// Number of axes, 1 or 3.
    pub axes: usize,
    /// The sensor's model.
    pub model: SensorModel,
    /// The parameters at which the information is taken, `p̄`.
    pub at: SensorParameters,
    /// Standard deviation of a sample, per axis, in the unit of the readings.
    pub noise: Vector3<f64>,
    /// How far the motion will be trusted.
    pub trust: Trust,
    /// Which ends of the motion are known.
    pub known_ends: KnownEnds,
    /// Sample rate, Hz.
    pub rate_hz: f64,
    /// What is known of the recording's clock: its delay and rate are marginalised.
    pub clock: MotionClock,
}

impl MotionInformation {
    /// The conditions of a recording of `sensor`, with the information taken at the parameters `at`.
    ///
    /// # Errors
    /// [`Error::Experiment`] where the noise of a sample is not known, or trust is `unknown` without both ends.
    pub fn new(
        sensor: &Sensor,
        at: SensorParameters,
        trust: Trust,
        known_ends: KnownEnds,
        rate_hz: f64,
    ) -> Result<Self> {
        let noise = sensor.noise(&at.matrix.diagonal().abs()).ok_or_else(|| {
            Error::experiment(InputError::new(
                Refusal::KeyMissing,
                "the noise of a sample is not given",
                "set `sensor.noise_mps2`",
            ))
        })?;
        if trust == Trust::Unknown && known_ends != KnownEnds::Both {
            return Err(Error::experiment(InputError::new(
                Refusal::KeyMissing,
                "trust `unknown` needs the acceleration at both ends",
                "set known_ends = \"both\"",
            )));
        }
        Ok(Self {
            axes: sensor.axes,
            model: sensor.model,
            at,
            noise,
            trust,
            known_ends,
            rate_hz,
            clock: MotionClock::default(),
        })
    }

    /// Information on all parameters, in the order of the parameter list: p × p, entry (i, j) in 1/(unit of θᵢ · unit of θⱼ).
    ///
    /// # Errors
    /// [`Error::NotIdentifiable`] where the samples do not determine the motion (trust `unknown`).
    ///
    /// # Examples
    /// One axis, two samples, known motion: `F = σ⁻² Σ (1, α)ᵀ (1, α)`.
    /// ```
    /// use calibrant_core::information::MotionInformation;
    /// use calibrant_core::motion::{JerkControlledMotion, KnownEnds, Trust};
    /// use calibrant_core::sensor::{Sensor, SensorParameters};
    /// use nalgebra::Vector3;
    /// let sensor = Sensor { axes: 1, noise_mps2: Some(Vector3::repeat(0.5)), ..Sensor::memsic_mxd2020u() };
    /// let setting = MotionInformation::new(&sensor, SensorParameters::identity(), Trust::Known, KnownEnds::Start, 1.0)?;
    /// let motion = JerkControlledMotion::uniform(1.0, vec![Vector3::repeat(-1.0), Vector3::repeat(3.0)])?;
    /// let f = setting.information(&motion)?;
    /// assert_eq!(f.as_slice(), [8.0, 8.0, 8.0, 40.0]);
    /// # Ok::<(), calibrant_core::Error>(())
    /// ```
    pub fn information(&self, motion: &JerkControlledMotion) -> Result<DMatrix<f64>> {
        if !self.clock.is_exact() && self.trust != Trust::Unknown {
            return Ok(marginal(&self.joint_with_clock(motion)?, &self.clock).0);
        }
        match self.model {
            SensorModel::Full => Ok(place(&[self.full(motion).at(motion)?], &[FULL_SLOTS.to_vec()])),
            SensorModel::ScaleBias => {
                let blocks = (0..self.axes)
                    .map(|axis| self.single(axis, motion).at(motion))
                    .collect::<Result<Vec<_>>>()?;
                let slots: Vec<_> = (0..self.axes).map(|axis| vec![axis, self.axes + axis]).collect();
                Ok(place(&blocks, &slots))
            }
        }
    }

    /// Information on all parameters and on the clock, which all axes share: delay and rate last.
    fn joint_with_clock(&self, motion: &JerkControlledMotion) -> Result<DMatrix<f64>> {
        if self.model == SensorModel::Full {
            return self.full(motion).joint_at(motion).map(|(joint, slots)| spread(&[(joint, slots)], 12));
        }
        let blocks = (0..self.axes)
            .map(|axis| self.single(axis, motion).joint_at(motion))
            .collect::<Result<Vec<_>>>()?;
        Ok(spread(&blocks, 2 * self.axes))
    }

    /// Derivative of `⟨Ω, F⟩` with respect to the accelerations of the motion's nodes, `Ω` symmetric (p × p). Of a scale-bias sensor with a clock that is not
    /// exact, each axis counts as if it alone told the time.
    ///
    /// # Errors
    /// As [`information`](Self::information).
    pub fn derivative(
        &self,
        motion: &JerkControlledMotion,
        omega: &DMatrix<f64>,
    ) -> Result<Vec<Vector3<f64>>> {
        let mut gradient = vec![Vector3::zeros(); motion.intervals() + 1];
        match self.model {
            SensorModel::Full => self.full(motion).add_derivative(motion, omega, &mut gradient)?,
            SensorModel::ScaleBias => {
                for axis in 0..self.axes {
                    self.single(axis, motion).add_derivative(motion, omega, &mut gradient)?;
                }
            }
        }
        Ok(gradient)
    }

    /// One axis of a scale-bias sensor, on the time grid of `motion`.
    #[must_use]
    pub fn single(&self, axis: usize, motion: &JerkControlledMotion) -> PartInformation<1, 2> {
        self.part([axis], [axis, self.axes + axis], motion)
    }

    /// All axes of a full sensor.
    #[must_use]
    pub fn full(&self, motion: &JerkControlledMotion) -> PartInformation<3, 12> {
        self.part([0, 1, 2], FULL_SLOTS, motion)
    }

    fn part<const D: usize, const P: usize>(
        &self,
        axes: [usize; D],
        slots: [usize; P],
        motion: &JerkControlledMotion,
    ) -> PartInformation<D, P> {
        PartInformation {
            axes,
            slots,
            tau: motion.times_s().to_vec(),
            sums: IntervalSums::all(motion, self.rate_hz),
            weight: SVector::from_fn(|k, _| self.noise[axes[k]].powi(-2)),
            s: SMatrix::from_fn(|i, j| self.at.matrix[(axes[i], axes[j])]),
            trust: self.trust,
            known_ends: self.known_ends,
            clock: if self.trust == Trust::Unknown { MotionClock::default() } else { self.clock },
        }
    }
}

/// Blocks of parameters, each with the clock behind them, in the places of the whole. The chains of a motion share only the clock.
pub(crate) fn spread(blocks: &[(DMatrix<f64>, Vec<usize>)], size: usize) -> DMatrix<f64> {
    let mut whole = DMatrix::zeros(size + 2, size + 2);
    for (block, slots) in blocks {
        let places: Vec<usize> = slots.iter().copied().chain([size, size + 1]).collect();
        for (i, &row) in places.iter().enumerate() {
            for (j, &column) in places.iter().enumerate() {
                whole[(row, column)] += block[(i, j)];
            }
        }
    }
    whole
}

/// A block-diagonal matrix from blocks and their places.
fn place<const P: usize>(blocks: &[SMatrix<f64, P, P>], slots: &[Vec<usize>]) -> DMatrix<f64> {
    let size = blocks.len() * P;
    let mut whole = DMatrix::zeros(size, size);
    for (block, slots) in blocks.iter().zip(slots) {
        for i in 0..P {
            for j in 0..P {
                whole[(slots[i], slots[j])] = block[(i, j)];
            }
        }
    }
    whole
}
