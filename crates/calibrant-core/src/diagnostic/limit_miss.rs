//! A value beside a limit that it breaks, or comes too close to.

use crate::diagnostic::parts::{Part, Parts};
use std::fmt;

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
