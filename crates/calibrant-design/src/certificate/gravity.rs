//! Bounds on the variances of biases where gravity acts on the sensor.
//!
//! Let `F` be the information on the readings at rest `r` and the matrix `S` ([`GravityMarginal`]), `F⁺` its block of
//! the readings at rest for a motion at rest, where it is largest, `N` the share of the tilt, and `M₀` the information that is
//! there already. With `S` known,
//!
//! `C_bb ⪰ B = ((F⁺⁻¹ + N)⁻¹ + M₀_bb)⁻¹`
//!
//! `S` is not known, and gravity takes its error into the bias: `b_i = r_i − Σ_k S_ik γ_k`. Without `M₀`,
//!
//! `C_ii ≥ B_ii + max_k (|γ_k| − |w_k|)₊² C(S_ik)`, `w = F_rr⁻¹ F_rS`
//!
//! `w` is the mean of the motion as the estimate weighs it, and is bounded: for a known motion by the limits
//! (the velocity at the end is the integral of the acceleration). Else it is bounded by Cauchy and Schwarz,
//! `w_k² ≤ (F_rr⁻¹)_ii F_kk`, with the most process noise in `F_rr`. Where the start is known and noisy
//! increments follow, `w_k = a_0 + w'_k`: `F_kk` is then the information of the increments. A motion whose limits let it
//! start in free fall has a bias that gravity does not touch, and no second term.
//!
//! For D, `det C = det C_SS det C_b|S`, and `C_b|S ⪰ B`: the second term of the variances has no part in it.

use super::AxisChain;
use super::bounds::StateBounds;
use crate::DesignProblem;
use calibrant_core::information::{GravityMarginal, MotionInformation, covariance};
use calibrant_core::motion::{InputNoise, JerkControlledMotion, KnownEnds, Trust};
use nalgebra::{DMatrix, Vector3};

/// Relative amount by which rounding may have made a bound too large.
const ROUNDING: f64 = 1e-12;

/// What gravity brings into the bounds.
pub(super) struct GravityBound {
    /// The information that is there already, on the readings at rest and `S`.
    pub(super) prior: DMatrix<f64>,
    /// The part of the covariance that no motion changes.
    pub(super) floor: DMatrix<f64>,
    /// `B`.
    pub(super) biases: DMatrix<f64>,
    /// `γ`.
    pub(super) force: Vector3<f64>,
    /// Diagonal of `F_rr⁻¹` with the most process noise; infinite where nothing bounds it.
    pub(super) least_known: Vec<f64>,
}

impl GravityBound {
    /// `None` without gravity.
    pub(super) fn of(
        problem: &DesignProblem<'_>,
        setting: &MotionInformation,
        rest: &JerkControlledMotion,
        still: &DMatrix<f64>,
    ) -> Option<Self> {
        let gravity = problem.gravity?;
        let marginal = problem.gravity_marginal()?;
        let axes = problem.sensor.axes;
        let tilt = GravityMarginal::new(&problem.sensor.parameter_list(), &problem.at, &gravity, None).floor;
        let block = |of: &DMatrix<f64>| of.view((0, 0), (axes, axes)).into_owned();
        let mut biases = covariance(&block(still))? + block(&tilt);
        if let Some(prior) = &problem.prior {
            biases = covariance(&(covariance(&biases)? + block(prior)))?;
        }
        let mut least_known = vec![f64::INFINITY; axes];
        let noisiest = match problem.trust {
            Trust::Noisy(input) => noisiest(problem, input).map(Trust::Noisy),
            other => Some(other),
        };
        if let Some(trust) = noisiest {
            let information = MotionInformation { trust, ..setting.clone() }.information(rest).ok()?;
            if let Some(c) = covariance(&block(&information)) {
                least_known = c.diagonal().iter().copied().collect();
            }
        }
        Some(Self {
            prior: marginal.prior,
            floor: marginal.floor,
            biases: biases * (1.0 - ROUNDING),
            force: gravity.force_mps2,
            least_known,
        })
    }
}

/// Process noise as it is at the largest jerk. `None` where nothing bounds the jerk.
fn noisiest(problem: &DesignProblem<'_>, input: InputNoise) -> Option<InputNoise> {
    let limits = problem.effective_limits();
    let jerk = (0..problem.sensor.axes).try_fold(0.0_f64, |most, k| {
        let axis = limits.axis(k);
        let by_acceleration = axis.acceleration.map(|a| 2.0 * a / problem.interval_s);
        let largest = axis.jerk.into_iter().chain(by_acceleration).reduce(f64::min)?;
        Some(most.max(largest))
    })?;
    Some(InputNoise { floor_mps3: input.floor_mps3 + input.ratio * jerk, ratio: 0.0 })
}

/// What bounds the weighted mean `w` of one axis' motion in one reading.
pub(super) struct MeanFacts {
    pub(super) trust: Trust,
    pub(super) known_ends: KnownEnds,
    pub(super) rate_hz: f64,
    /// Diagonal entry of `F_rr⁻¹` with the most process noise.
    pub(super) least_known: f64,
    /// Variance of a sample.
    pub(super) noise: f64,
    /// Largest information of noisy increments on the entry of `S`.
    pub(super) increments: f64,
    /// `F_rr`, and the information on the entry of `S` for a line from −1 to 1, where only the ends are known.
    pub(super) ends: Option<(f64, f64)>,
}

/// Largest `|w|` of a motion within these limits; infinite where nothing bounds it.
pub(super) fn largest_mean(chain: &AxisChain, facts: &MeanFacts) -> f64 {
    let (n, bounds) = (chain.sums.len(), StateBounds::of(chain));
    let samples: f64 = chain.sums.iter().map(|sum| sum.samples).sum();
    let squares = bounds.sum_of_squares(chain, 0..n);
    match (facts.trust, facts.known_ends) {
        (Trust::Known, _) => (squares / samples)
            .sqrt()
            .min(bounds.sum[n] / samples)
            .min(by_velocity(chain, &bounds, facts.rate_hz) / samples),
        // about the acceleration at the start, which is known: what follows is increments
        (Trust::Noisy(_), KnownEnds::Start) => bounds.a[0] + (facts.least_known * facts.increments).sqrt(),
        (Trust::Noisy(_), KnownEnds::Both) => (facts.least_known * squares / facts.noise).sqrt(),
        // F is a form W of the two ends alone, tr W = (F_rr + F_kk of the line)/2
        (Trust::Unknown, _) => facts.ends.map_or(f64::INFINITY, |(at_rest, sloped)| {
            (0.5 * (at_rest + sloped) * (bounds.a[0].powi(2) + bounds.a[n].powi(2)) / at_rest).sqrt()
        }),
    }
}

/// Largest `|Σ α|` by the limits of velocity. `Σ α` of the samples is `f_s ∫ α dt`, which is the velocity at the
/// end, and a remainder that is linear in the nodes.
fn by_velocity(chain: &AxisChain, bounds: &StateBounds, rate_hz: f64) -> f64 {
    let (sums, n) = (&chain.sums, chain.sums.len());
    let by_time = 0.5 * rate_hz * chain.interval_s;
    let mut remainder = vec![0.0; n + 1];
    for (i, sum) in sums.iter().enumerate() {
        remainder[i] += sum.s0 - by_time;
        remainder[i + 1] += sum.s1 - by_time;
    }
    let rest: f64 = remainder.iter().zip(&bounds.a).map(|(c, a)| c.abs() * a).sum();
    rate_hz * bounds.v[n] + rest
}
