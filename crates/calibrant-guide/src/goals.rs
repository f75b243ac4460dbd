//! How well each parameter shall be known.

use calibrant_core::acceptance::AcceptanceLimit;
use calibrant_core::sensor::{ImuParameters, ImuQuantity, Quantity, ReadingUnit, SensorKind};

/// The largest standard deviations: those of `[accept]`, or usual ones; on known faces, of the gyroscope's biases and gains only: each face shall be held.
#[derive(Debug, Clone)]
pub(crate) enum Goals {
    Accept(Vec<AcceptanceLimit>),
    Usual,
    EachFace,
}

/// Usual ones: a bias of 1 mg, gains and axes of 0.1 % and 0.06°; a bias of 0.06 °/s, gains and axes of 0.3 %.
const USUAL: [(SensorKind, f64, f64); 2] =
    [(SensorKind::Accelerometer, 0.01, 1e-3), (SensorKind::Gyroscope, 1e-3, 3e-3)];

impl Goals {
    /// Those of these limits that are of standard deviations.
    pub(crate) fn of_limits(limits: &[AcceptanceLimit], on_faces: bool) -> Self {
        let accept: Vec<_> = limits.iter().filter(|limit| limit.sd.is_some()).cloned().collect();
        match (accept.is_empty(), on_faces) {
            (false, _) => Self::Accept(accept),
            (true, true) => Self::EachFace,
            (true, false) => Self::Usual,
        }
    }

    /// What a sentence says of them.
    pub(crate) fn said(&self) -> &'static str {
        match self {
            Self::Accept(_) => "",
            Self::Usual => " The goals are usual ones; [accept] of the experiment sets yours.",
            Self::EachFace => {
                " Each face was held; [accept] of the experiment sets goals for standard deviations."
            }
        }
    }

    /// That of a parameter, in its unit; `unit`: of the readings. `floor`: what gravity that is not exactly known leaves, which no hold makes less; a usual goal is beside it.
    pub(crate) fn of(
        &self,
        quantity: ImuQuantity,
        imu: &ImuParameters,
        unit: ReadingUnit,
        floor: f64,
    ) -> Option<f64> {
        match self {
            Self::Usual => {}
            // how level and square the faces are decides what is known of axes
            Self::EachFace => {
                let is_own = matches!(
                    quantity,
                    ImuQuantity::Of(SensorKind::Gyroscope, Quantity::Bias(_) | Quantity::Scale(_))
                );
                if !is_own {
                    return None;
                }
            }
            Self::Accept(limits) => {
                let name = quantity.name();
                let of_it = limits.iter().filter(|limit| limit.names(&name));
                return of_it.filter_map(|limit| limit.sd).reduce(f64::min);
            }
        }
        let ImuQuantity::Of(kind, of) = quantity else { return None };
        let (_, bias, share) = USUAL.into_iter().find(|(of, ..)| *of == kind)?;
        let gain = match unit {
            ReadingUnit::Counts => imu.sensor(kind).matrix.row(of.axis().index()).norm(),
            _ => 1.0,
        };
        let own = match of {
            Quantity::Bias(_) => bias * gain,
            Quantity::Scale(_) | Quantity::CrossAxis(..) | Quantity::Symmetric(..) => share * gain,
            Quantity::Nonlinear(..) => return None,
        };
        Some(own.hypot(floor))
    }
}
