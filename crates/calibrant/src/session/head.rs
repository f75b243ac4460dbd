//! The head of a report, as that of a calibration certificate: what was calibrated, when, where and how. What nobody stated is said to be so.

use super::calibrated::Calibrated;
use super::outcome::Outcome;
use calibrant_core::estimate::Recovered;
use calibrant_core::motion::Gravity;
use calibrant_core::sensor::Temperatures;
use calibrant_io::HashedFile;
use calibrant_report::number_format::{significant, with_sd_or_exact};

/// What stands where nobody said it.
const NOT_STATED: &str = "not stated";
/// So many signs of a checksum name a result.
const NAMED_BY: usize = 16;

impl Outcome {
    /// Labels and facts, in the order of ISO/IEC 17025, 7.8.2: identification, object, date, place, method, conditions, uncertainty, program.
    pub(super) fn head(&self) -> Vec<(String, String)> {
        let stated = |text: Option<String>| text.unwrap_or_else(|| NOT_STATED.to_owned());
        let sha256 = HashedFile::of_bytes("calibration.json", self.json().as_bytes()).sha256;
        let kinds = self.calibration().sensor_kinds();
        let kinds: Vec<&str> = kinds.iter().map(|kind| kind.name()).collect();
        let facts = [
            ("Sensor", stated(self.origin.sensor.clone()) + ", " + &kinds.join(" and ")),
            ("Recorded", stated(self.origin.recorded.map(|time| time.to_string()))),
            ("Station", stated(self.origin.station.clone())),
            ("Gravity", stated(self.gravity())),
            ("Method", self.method()),
            ("Temperature", stated(self.temperature())),
            ("Uncertainty", "± 1 standard deviation, k = 1".to_owned()),
            ("Program", format!("calibrant {}", env!("CARGO_PKG_VERSION"))),
            ("Result", format!("SHA-256 of calibration.json: {}…", &sha256[..NAMED_BY])),
        ];
        facts.into_iter().map(|(label, fact)| (label.to_owned(), fact)).collect()
    }

    fn gravity(&self) -> Option<String> {
        let (magnitude_mps2, sd_mps2) = match (&self.calibrated, &self.calibration().recovered) {
            (Calibrated::OnMachine(machine), _) => {
                (machine.setup.gravity_mps2, machine.setup.gravity_sd_mps2)
            }
            (_, Recovered::Holds(holds)) => (holds.gravity.magnitude_mps2, holds.gravity.sd_mps2),
            (_, Recovered::Motion(motion)) => {
                let gravity = &motion.gravity?.gravity;
                (gravity.force_mps2.norm(), gravity.sd_mps2)
            }
            (_, Recovered::OnMachine(_)) => return None,
        };
        let gravity = Gravity { magnitude_mps2, sd_mps2 };
        let value = with_sd_or_exact(magnitude_mps2, sd_mps2);
        Some(match gravity == Gravity::SOMEWHERE {
            true => format!("{NOT_STATED}; {value} m/s², as on the Earth’s surface"),
            false => format!("{value} m/s²"),
        })
    }

    fn method(&self) -> String {
        match &self.calibration().recovered {
            Recovered::Holds(holds) => {
                format!("{} holds at rest, against gravity", holds.used().count())
            }
            Recovered::Motion(motion) => format!("a commanded motion, trust {}", motion.trust),
            Recovered::OnMachine(_) => "on a machine, against its log".to_owned(),
        }
    }

    /// The least and the largest temperature of the recording.
    fn temperature(&self) -> Option<String> {
        let [low, high] = Temperatures::of(&self.recording).ok().flatten()?.range_c()?;
        Some(format!("{} to {} °C", significant(low, 3), significant(high, 3)))
    }
}
