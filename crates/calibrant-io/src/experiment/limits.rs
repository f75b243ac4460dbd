//! `[limits]`: the limits of the arm. Sections that vary a motion have the same keys.

use super::number::PerAxis;
use super::ranges::{Acceleration, Displacement, Jerk, SignedAcceleration, Velocity};
use super::sensor::per_axis;
use calibrant_core::error::Result;
use calibrant_core::motion::{Limits, Rest};
use serde::{Deserialize, Serialize};

/// A section with keys of its own and those of limits.
macro_rules! section_with_limits {
    ($(#[$doc:meta])* pub struct $name:ident { $($own:tt)* }) => {
        $(#[$doc])*
        #[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
        #[serde(deny_unknown_fields)]
        pub struct $name {
            $($own)*
            /// Largest acceleration at the nodes.
            pub acceleration_mps2: Option<PerAxis<Acceleration>>,
            /// Largest jerk.
            pub jerk_mps3: Option<PerAxis<Jerk>>,
            /// Bound on the line of each interval, extended to t = 0.
            pub intercept_mps2: Option<PerAxis<Acceleration>>,
            /// Largest velocity.
            pub velocity_mps: Option<PerAxis<Velocity>>,
            /// Largest displacement.
            pub displacement_m: Option<PerAxis<Displacement>>,
            /// Where the velocity is zero.
            pub rest: Option<Rest>,
            /// Prescribed acceleration at the start.
            pub start_acceleration_mps2: Option<PerAxis<SignedAcceleration>>,
            /// Prescribed acceleration at the end.
            pub end_acceleration_mps2: Option<PerAxis<SignedAcceleration>>,
        }

        impl $name {
            /// The limits; `None` where there are none. `section` is its name in errors.
            pub(super) fn limits(&self, section: &str, axes: usize) -> Result<Option<Limits>> {
                macro_rules! of {
                    ($key:ident) => {
                        per_axis(&format!("{section}.{}", stringify!($key)), self.$key.as_ref(), axes)?
                    };
                }
                let limits = Limits {
                    acceleration_mps2: of!(acceleration_mps2),
                    jerk_mps3: of!(jerk_mps3),
                    intercept_mps2: of!(intercept_mps2),
                    velocity_mps: of!(velocity_mps),
                    displacement_m: of!(displacement_m),
                    rest: self.rest.unwrap_or_default(),
                    start_acceleration_mps2: of!(start_acceleration_mps2),
                    end_acceleration_mps2: of!(end_acceleration_mps2),
                };
                Ok((self.rest.is_some() || limits != Limits::default()).then_some(limits))
            }
        }
    };
}
pub(super) use section_with_limits;

section_with_limits! {
    /// `[limits]`: symmetric limits of the arm; a number, or one for each axis.
    pub struct LimitsSection {}
}
