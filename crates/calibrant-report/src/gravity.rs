//! How well gravity is known, and what would make it better known.

use crate::number_format::percent;
use calibrant_core::motion::Gravity;

/// Its relative standard uncertainty: `0.19 %`.
pub(crate) fn known_to(gravity: &Gravity) -> String {
    percent(gravity.sd_mps2 / gravity.magnitude_mps2)
}

/// What makes it smaller: a latitude, with the height.
pub(crate) fn advice(gravity: &Gravity) -> String {
    let latitude = Gravity::at_latitude(0.0);
    let place = Gravity::from_latitude(0.0, 0.0);
    let is_better = |better: &Gravity| better.sd_mps2 < 0.9 * gravity.sd_mps2;
    match (is_better(&latitude), is_better(&place)) {
        (true, _) => format!(
            "holds.latitude_deg makes this {}, with holds.height_m {}",
            known_to(&latitude),
            known_to(&place)
        ),
        (false, true) => format!("holds.latitude_deg and holds.height_m make this {}", known_to(&place)),
        (false, false) => "gravity measured at the place makes this less".into(),
    }
}
