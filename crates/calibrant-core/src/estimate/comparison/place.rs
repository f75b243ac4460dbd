//! The place of two calibrations.

/// Were two calibrations made at one place? What is not known of the place is then one error of both.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place {
    /// They were.
    One,
    /// They were made at two.
    Two,
    /// Nobody says it.
    Unknown,
}

impl Place {
    /// By the names of their stations.
    #[must_use]
    pub fn of_stations(one: Option<&str>, other: Option<&str>) -> Self {
        match (one, other) {
            (Some(one), Some(other)) if one == other => Self::One,
            (Some(_), Some(_)) => Self::Two,
            _ => Self::Unknown,
        }
    }
}
