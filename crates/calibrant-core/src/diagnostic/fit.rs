//! Checks of a fit: convergence, χ², residuals and noise.

use super::check::checks;
use crate::number_format::significant;
use crate::sensor::{Axis, SensorKind};

checks! {
    /// The iteration did not converge. The numbers are the best that it found, not the optimum.
    NotConverged "not-converged" Error {
        /// The status.
        status: &'static str,
    }
    decided "The status of the result is not `converged`."
    remedy "Look at the other diagnostics. Record more holds or rotations."
    says format!(
        "the iteration did not converge ({status}). The numbers are the best that it found, not the optimum."
    );

    /// There are as many unknowns as data. No data are left to check the fit.
    NothingToCheck "nothing-to-check" Warning {
        /// Number of holds, where the recording consists of holds.
        holds: Option<usize>,
        /// Number of parameters.
        parameters: usize,
    }
    decided "The fit has no degrees of freedom."
    remedy "Add holds, or record more samples."
    says match holds {
        Some(holds) => format!(
            "{holds} holds for {parameters} parameters leave no data to check the fit. The standard deviations \
             come from the noise within the holds alone, and are too small. Add holds."
        ),
        None => "the model has as many unknowns as there are readings. No data are left to check the fit.".to_owned(),
    };

    /// There are hardly more holds than parameters. The standard deviations themselves are uncertain.
    FewDegreesOfFreedom "few-degrees-of-freedom" Warning {
        /// Their number.
        degrees_of_freedom: usize,
    }
    decided "The fit has fewer than 5 degrees of freedom."
    remedy "Add holds."
    says format!(
        "the recording has only {} than parameters. The standard deviations themselves are uncertain by about \
         {:.0} %. Add holds.",
        match degrees_of_freedom {
            1 => "one hold more".to_owned(),
            more => format!("{more} holds more"),
        },
        100.0 / (2.0 * *degrees_of_freedom as f64).sqrt()
    );

    /// The data contradict a given value. The standard deviations are too small.
    ChiSquaredLarge "chi-squared-large" Warning {
        chi2: f64,
        /// Degrees of freedom.
        degrees_of_freedom: f64,
    }
    decided "χ² exceeds its degrees of freedom by 6 standard deviations."
    remedy "Check terms in [known], directions, turns and noise."
    says format!(
        "χ² is {chi2:.0} with {degrees_of_freedom:.0} degrees of freedom. The data contradict a given value, and \
         the standard deviations are too small. Check fixed terms and priors in [known], directions, turns and noise."
    );

    /// The data refute a given value: the result is of another sensor, or of another procedure.
    GivenRefuted "given-refuted" Error {
        chi2: f64,
        /// Degrees of freedom.
        degrees_of_freedom: f64,
    }
    decided "χ² exceeds a hundred times its degrees of freedom: the residuals are ten times as large as what is given admits."
    remedy "Correct terms in [known], directions, turns or noise."
    says format!(
        "χ² is {chi2:.0} with {degrees_of_freedom:.0} degrees of freedom: the data refute a given value. Correct terms in [known], directions, turns or noise."
    );

    /// The fit is worse than the noise explains. The standard deviations are too small.
    FitWorseThanNoise "fit-worse-than-noise" Warning {
        /// p-value of χ².
        p_value: f64,
        /// Residual noise over the assumed one.
        noise_ratio: f64,
        /// Are the residuals white?
        is_white: bool,
    }
    decided "The p-value of χ² is below 0.001."
    remedy "Check the clocks, the commanded motion, and the noise."
    says format!(
        "the fit is worse than the noise explains (χ² p-value {}, residual noise {noise_ratio:.3} times the assumed noise). {}",
        small(*p_value),
        match is_white {
            true => "The standard deviations are too small by about that factor, or the motion was not the commanded one.",
            false => {
                "The residuals are not white: the error is systematic, and may be far larger than the standard deviations. \
                 Check that both clocks start together and run at one rate. Check that the motion was the commanded one."
            }
        }
    );

    /// The fit is better than the noise explains. The standard deviations are too large.
    FitBetterThanNoise "fit-better-than-noise" Warning {
        /// p-value of χ².
        p_value: f64,
        /// Residual noise over the assumed one.
        noise_ratio: f64,
    }
    decided "The p-value of χ² is above 0.999."
    remedy "Correct the noise in the experiment file."
    says format!(
        "the fit is better than the noise explains (χ² p-value {p_value:.4}, residual noise {noise_ratio:.3} times \
         the assumed noise). The assumed noise is too large, and the standard deviations are too large with it. \
         Correct sensor.noise_mps2."
    );

    /// The residuals of an axis are correlated. The model does not explain all of the signal.
    ResidualsNotWhite "residuals-not-white" Warning {
        axis: Axis,
        /// p-value of the Ljung–Box test.
        p_value: f64,
    }
    decided "The p-value of the Ljung–Box test is below 0.0001."
    remedy "Check clocks and motion."
    says format!(
        "the residuals of axis {axis} are not white (Ljung–Box p-value {}). The model does not explain all of the \
         signal. Check clocks and motion.",
        small(*p_value)
    );

    /// An estimate is biased, since the motion is estimated with it.
    EstimateBiased "estimate-biased" Warning {
        /// The parameter with the largest bias.
        parameter: String,
        /// The bias, in standard deviations.
        deviations: f64,
    }
    decided "The second-order bias exceeds 0.3 standard deviations."
    remedy "Calibrate on a shorter motion, or with less process noise."
    says format!(
        "the estimate of {parameter} is biased by about {deviations:.1} standard deviations. The process noise is \
         large for the number of intervals. Calibrate on a shorter motion, or with less process noise."
    );

    /// The noise within the holds differs from the given noise. That of the recording is used, so the result is sound.
    NoiseNotAsGiven "noise-not-as-given" Note {
        sensor_kind: SensorKind,
        /// The axis with the largest difference.
        axis: Axis,
        /// Noise within the holds over the given noise.
        ratio: f64,
    }
    decided "Their ratio is below 0.5 or above 2."
    remedy "Correct the noise in the experiment file."
    says format!(
        "the noise of the {sensor_kind} within the holds is {} times the noise in the experiment file (axis {axis}). The noise of the recording is used.",
        times(*ratio)
    );

    /// The noise is far larger than the given noise. The sensor, its unit or the given noise is wrong.
    NoiseImplausible "noise-implausible" Error {
        sensor_kind: SensorKind,
        /// The axis with the largest ratio.
        axis: Axis,
        /// The noise that was found over the given noise.
        ratio: f64,
    }
    decided "The residuals of a motion, or neighbouring samples on a machine, scatter by more than ten times the given noise."
    remedy "Check the sensor and the unit of the recording. Correct the noise in the experiment file."
    says format!(
        "the noise of the {sensor_kind} is {} times the given noise (axis {axis}). Check the sensor and the unit of \
         the recording, or correct the noise in the experiment file.",
        significant(*ratio, 3)
    );

    /// The residuals are far larger than the noise, and systematic. The sensor did not do what the model
    /// says.
    ModelContradicted "model-contradicted" Error {
        sensor_kind: SensorKind,
        /// The residuals over the noise, or over what holds may scatter.
        ratio: f64,
    }
    decided "Of a motion, the residuals are more than ten times the given noise, and not white. On a machine, they \
        are more than ten times the noise of neighbouring samples. In holds, the scatter between them exceeds 0.2 \
        m/s²."
    remedy "Check that the motion was the commanded one, both clocks, and the order and direction of the axes."
    says format!(
        "the residuals of the {sensor_kind} are {} times as large as they may be, and systematic. The sensor did not \
         do what the model says. Check the motion, the clocks, and the order and direction of the axes.",
        significant(*ratio, 3)
    );
}

/// A ratio with two decimals, or with two digits where it would read 0.00.
fn times(ratio: f64) -> String {
    if ratio < 0.01 { format!("{ratio:.1e}") } else { format!("{ratio:.2}") }
}

/// A small probability: `1.2e-7`, or `below 1e-300` where the number underflows.
fn small(p: f64) -> String {
    if p < 1e-300 { "below 1e-300".into() } else { format!("{p:.1e}") }
}
