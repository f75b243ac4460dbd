//! The fit of the noise coefficients to the Allan deviation of one axis.

use super::allan_regression::MISFIT;
use super::model_selection::choose;
use super::series::Series;
use super::vibration::{Lines, Vibration};
use super::{Drift, Moments, NoiseModel, PowerLaw};
use crate::error::{Error, InputError, Refusal, Result};

/// Fewest samples: six cluster times.
const FEWEST: usize = 96;

/// The noise of one axis, as its Allan deviation shows it.
#[derive(Debug, Clone, PartialEq)]
pub struct NoiseFit {
    /// The coefficients.
    pub model: NoiseModel,
    /// A linear drift beside the noise. It was subtracted before the coefficients were estimated.
    pub drift: Drift,
    /// Shortest cluster time that was fitted, s. No sum of the processes explains shorter ones.
    pub shortest_tau_s: f64,
    /// Do the samples show a filter? Its share of the Allan variance, `−3 D τ₀²/τ²`, was then fitted beside
    /// the processes, in the place of quantisation.
    pub filtered: bool,
    /// Longest cluster time that was fitted, s.
    pub longest_tau_s: f64,
    /// Where the flicker noise has its largest share of the fitted Allan variance, s; `None` where B is not determined.
    pub flat_tau_s: Option<f64>,
    /// χ² of the fitted Allan variances.
    pub chi2: f64,
    /// Cluster times less coefficients.
    pub degrees_of_freedom: usize,
    /// Probability of a χ² at least as large; `None` without degrees of freedom.
    pub p_value: Option<f64>,
    /// Lines in the spectrum that are large enough to report: a vibration, a hum. The coefficients are those
    /// of the noise beside them.
    pub vibration: Option<Vibration>,
}

impl NoiseFit {
    /// Fits readings at equal intervals; `moments` are those of their number.
    ///
    /// # Errors
    /// [`Error::Recording`] for fewer than 96 samples, and where readings never change.
    ///
    /// # Panics
    /// If `moments` are those of another number of samples.
    ///
    /// # Examples
    /// ```
    /// use calibrant_core::noise::{Moments, NoiseFit, PowerLaw};
    /// use calibrant_core::simulate::{Purpose, simulate_noise, stream};
    ///
    /// // white noise of N = 0.02 u/√Hz at 100 Hz: 0.2 u per sample
    /// let readings = simulate_noise(PowerLaw::White, 0.02, 0.01, 5000, &mut stream(1, Purpose::Sensor, 0));
    /// let fit = NoiseFit::of(&readings, 0.01, &Moments::of(5000))?;
    /// let n = fit.model.random_walk.estimate().expect("determined");
    /// assert!(n.low < 0.02 && 0.02 < n.high && n.sd < 5e-4);
    /// assert!(fit.model.rate_random_walk.estimate().is_none());
    /// # Ok::<(), calibrant_core::Error>(())
    /// ```
    pub fn of(readings: &[f64], interval_s: f64, moments: &Moments) -> Result<Self> {
        Self::of_series(&Series::of(readings.to_vec()), interval_s, moments)
    }

    /// The same for the series of the readings.
    pub(super) fn of_series(series: &Series, interval_s: f64, moments: &Moments) -> Result<Self> {
        let n = series.values.len();
        assert_eq!(n, moments.samples(), "the moments are those of the readings");
        if n < FEWEST {
            return Err(Error::recording(InputError::new(
                Refusal::NoiseUndetermined,
                format!("{n} samples of one hold do not determine its noise"),
                format!("it takes {FEWEST} samples at least; record the sensor at rest for minutes"),
            )));
        }
        let observed = moments.observe(&series.phase);
        if observed.iter().any(|v| !v.is_finite() || *v <= 0.0) {
            return Err(Error::recording(InputError::new(
                Refusal::AxisConstant,
                "the readings do not change: there is no noise to be seen",
                "is the axis connected? its resolution may be coarser than its noise",
            )));
        }
        let lines = Lines::of(series, moments.scales(), moments.fourier());
        let without = lines.as_ref().map(|lines| lines.taken_off(&observed));
        let regression = choose(moments, without.as_ref().unwrap_or(&observed));
        let vibration = lines.and_then(|lines| lines.vibration(&observed, &regression, interval_s));
        let mut model = regression.model(interval_s);
        model.random_walk = series.steps.widen(model.random_walk);
        let drift = Drift::of(&series.values, interval_s, &model);
        let scales = &moments.scales()[regression.first..];
        let tau = |m: Option<&usize>| m.map_or(0.0, |&m| m as f64 * interval_s);
        let share = |tau: f64| model.share(PowerLaw::Flicker, tau) / model.deviation(tau);
        let flat_tau_s = model.bias_instability.value().and_then(|_| {
            let (low, high) = (tau(scales.first()).ln(), tau(scales.last()).ln());
            let taus = (0..=200).map(|k| (low + (high - low) * f64::from(k) / 200.0).exp());
            taus.max_by(|&a, &b| share(a).total_cmp(&share(b)))
        });
        let degrees_of_freedom = scales.len() - regression.active.len();
        let p_value = regression.p_value();
        Ok(Self {
            drift,
            shortest_tau_s: tau(scales.first()),
            longest_tau_s: tau(scales.last()),
            flat_tau_s,
            chi2: regression.chi2,
            degrees_of_freedom,
            p_value,
            filtered: regression.filtered,
            model,
            vibration,
        })
    }

    /// Do the processes explain the Allan deviation?
    #[must_use]
    pub fn explains(&self) -> bool {
        self.p_value.is_none_or(|p| p >= MISFIT)
    }
}
