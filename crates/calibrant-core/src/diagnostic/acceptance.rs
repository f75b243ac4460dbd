//! Checks of a result beside the limits of `[accept]`.

use super::check::checks;
use super::parts::{Part, Parts};
use std::fmt;

checks! {
    /// A limit of `[accept]` is broken.
    LimitBroken "limit-broken" Error {
        /// The limit.
        limit: LimitMiss,
    }
    decided "The value lies beyond the limit by more than 1.645 of its standard deviations, or a standard deviation \
        exceeds the largest that is accepted."
    remedy "Do not ship the sensor. Where the standard deviation is too large, record more."
    says format!("{limit}: it is broken.");

    /// A value is too close to a limit of `[accept]` to decide.
    LimitTooClose "limit-too-close" Warning {
        /// The limit.
        limit: LimitMiss,
    }
    decided "The value lies within 1.645 of its standard deviations of the limit, on either side (ISO 14253-1)."
    remedy "Record more, so that the standard deviation becomes smaller."
    says format!(
        "{limit}: they are too close to decide. Record more, so that the standard deviation becomes smaller."
    );

    /// A limit of `[accept]` is not checked, since the result does not have the value.
    LimitNotChecked "limit-not-checked" Warning {
        /// Its name.
        name: String,
    }
    decided "The calibration does not estimate it, or no validation gives it."
    remedy "Take the limit out, estimate the parameter, or give option `validate`."
    says format!("the limit of {name} is not checked: the result does not have this value.");
}

/// A value that does not keep a limit of `[accept]`, or does so too narrowly.
#[derive(Debug, Clone, PartialEq)]
pub struct LimitMiss {
    /// Its name: `accelerometer.bias.x`, `axis_angle_deg`; with ` sd` where its standard deviation is limited.
    pub name: String,
    /// Its value.
    pub value: f64,
    /// The standard deviation of the value; 0 where it has none.
    pub sd: f64,
    /// The limit that is nearest to the value.
    pub limit: f64,
}

impl fmt::Display for LimitMiss {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, value, sd, limit } = self;
        let sd = if *sd > 0.0 { format!(" ± {sd:.1e}") } else { String::new() };
        write!(f, "{name} is {value:.6}{sd}, and the limit is {limit:?}")
    }
}

impl Part for LimitMiss {
    fn add_to(&self, parts: &mut Parts, _: &'static str) {
        parts.subject.push(self.name.clone());
        parts.numbers.extend([("value", self.value), ("sd", self.sd), ("limit", self.limit)]);
    }
}
