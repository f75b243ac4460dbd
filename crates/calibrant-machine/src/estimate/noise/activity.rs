//! How much the machine moves at a time: what noise that grows with motion is compared with.

use crate::estimate::least_squares::model::{Model, State};

/// Time between the values, s.
const STEP_S: f64 = 0.05;
/// The activity is averaged over this time to either side, s.
const ABOUT_S: f64 = 0.25;

/// Mean square of rate and of specific force, each in parts of its mean square over the recording; 0 at rest.
pub(crate) struct Activity {
    start_s: f64,
    values: Vec<f64>,
}

impl Activity {
    pub(crate) fn along(model: &Model<'_>, state: &State) -> Self {
        let knots = state.motion.knots();
        let carrier = model.carrier(state);
        let mut joints = Default::default();
        let count = ((knots.end_s() - knots.start_s) / STEP_S) as usize + 1;
        let gravity = state.parameters.gravity_mps2;
        let (mut rates, mut forces) = (vec![0.0; count], vec![0.0; count]);
        for k in 0..count {
            let weights = knots.weights(knots.start_s + k as f64 * STEP_S);
            if model.covered[weights.interval] {
                let at = state.motion.sensor(&weights, &carrier, &mut joints);
                rates[k] = at.rate.norm_squared();
                forces[k] = (at.specific_force.norm() - gravity).powi(2);
            }
        }
        let mean = |values: &[f64]| (values.iter().sum::<f64>() / count as f64).max(f64::MIN_POSITIVE);
        let (of_rate, of_force) = (mean(&rates), mean(&forces));
        let each: Vec<f64> =
            rates.iter().zip(&forces).map(|(r, f)| 0.5 * (r / of_rate + f / of_force)).collect();
        let about = (ABOUT_S / STEP_S) as usize;
        let smooth = |k: usize| {
            let near = &each[k.saturating_sub(about)..(k + about + 1).min(count)];
            near.iter().sum::<f64>() / near.len() as f64
        };
        Self { start_s: knots.start_s, values: (0..count).map(smooth).collect() }
    }

    /// The activity at a time.
    pub(crate) fn at(&self, time_s: f64) -> f64 {
        let place = ((time_s - self.start_s) / STEP_S).max(0.0) as usize;
        self.values[place.min(self.values.len() - 1)]
    }
}

/// The factor `κ` of `σ² (1 + κ a)` by which the variance grows with the activity `a`, from squared whitened residuals. `None` where growth is not significant.
///
/// Two equations: the mean square of the quieter half of the samples, and that of the livelier half.
pub(crate) fn growth(pairs: &mut [(f64, f64)]) -> Option<f64> {
    /// Fewest samples.
    const FEWEST: usize = 400;
    /// The livelier half must be this many times noisier.
    const LEAST: f64 = 1.3;
    if pairs.len() < FEWEST {
        return None;
    }
    let middle = pairs.len() / 2;
    pairs.select_nth_unstable_by(middle, |one, other| one.0.total_cmp(&other.0));
    let mean = |part: &[(f64, f64)]| {
        let n = part.len() as f64;
        part.iter().fold((0.0, 0.0), |(a, r), pair| (a + pair.0 / n, r + pair.1 / n))
    };
    let ((a0, v0), (a1, v1)) = (mean(&pairs[..middle]), mean(&pairs[middle..]));
    if v1 < LEAST * v0 || a1 <= a0 {
        return None;
    }
    // v = s (1 + κ a)
    let slope = (v1 - v0) / (a1 - a0);
    let at_rest = (v0 - slope * a0).max(0.05 * v0);
    Some(slope / at_rest)
}
