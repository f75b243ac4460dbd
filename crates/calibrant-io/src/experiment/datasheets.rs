//! The datasheets of common sensors, and a preset with their numbers.

use calibrant_core::number_format::plain;

/// What the datasheet of a sensor states as typical: noise densities, and the ranges with their sensitivity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Datasheet {
    /// Its name, for `calibrant init`.
    pub name: &'static str,
    /// The document, its revision or date.
    pub source: &'static str,
    /// Noise density of the accelerometer, µg/√Hz; of the noisiest axis.
    pub noise_ug_per_rthz: f64,
    /// Noise density of the gyroscope, mdps/√Hz; `None` of an accelerometer alone.
    pub noise_mdps_per_rthz: Option<f64>,
    /// Ranges of the accelerometer, g, each with its sensitivity, LSB/g. The first is the one after a reset. A sensor that reports m/s² has no sensitivity, 0.
    pub ranges_g: &'static [(f64, f64)],
    /// Ranges of the gyroscope, deg/s, each with its sensitivity, LSB/(deg/s).
    pub ranges_dps: &'static [(f64, f64)],
}

impl Datasheet {
    /// The datasheet of this name, in any case, with hyphens or without; the beginning of a name will do, where it is that of one alone.
    #[must_use]
    pub fn of(name: &str) -> Option<&'static Self> {
        let plain = |name: &str| name.to_lowercase().replace(['-', '_', ' '], "");
        let begins = |of: &&Self| plain(of.name).starts_with(&plain(name));
        let mut found = DATASHEETS.iter().filter(begins);
        found.next().filter(|_| found.next().is_none() && plain(name).len() > 3)
    }

    /// Does it give counts, by a sensitivity?
    #[must_use]
    pub fn has_counts(&self) -> bool {
        self.ranges_g.iter().all(|(_, counts)| *counts > 0.0)
    }

    /// The text of an experiment file with the noise and the ranges of this sensor. The sensitivities stand in `[columns]`: as comments, unless the
    /// experiment is one of counts, which are then those of the sensitivities.
    ///
    /// # Examples
    /// ```
    /// use calibrant_io::{Datasheet, Experiment, preset};
    /// let sensor = Datasheet::of("bmi088").expect("known");
    /// let text = sensor.in_experiment(preset("imu").expect("known"));
    /// let noise_mps2 = Experiment::parse(&text, None)?.sensor.noise_mps2.expect("by its density");
    /// assert!((noise_mps2.x - sensor.noise_ug_per_rthz * 9.80665e-6 * 50_f64.sqrt()).abs() < 1e-12);
    /// # Ok::<(), calibrant_core::Error>(())
    /// ```
    #[must_use]
    pub fn in_experiment(&self, text: &str) -> String {
        let Self { name, source, .. } = self;
        let mut text = Sections(text.lines().map(str::to_owned).collect());
        let bandwidth =
            "noise_bandwidth_hz = 50.0  # half of the sample rate, or the noise bandwidth of the filter";
        let range = |ranges: &[(f64, f64)]| ranges.first().map_or(0.0, |(range, _)| *range);
        let g = range(self.ranges_g);
        // counts are those of the sensitivity then
        let is_of_counts = text.takes("sensor", "unit = \"counts\"");
        text.remove("sensor", "noise_mps2");
        text.set(
            "sensor",
            "noise_ug_per_rthz",
            &format!(
                "noise_ug_per_rthz = {:?}  # noise density of the {name} ({source})",
                self.noise_ug_per_rthz
            ),
        );
        text.set("sensor", "noise_bandwidth_hz", bandwidth);
        text.set(
            "sensor",
            "range_mps2",
            &format!("range_mps2 = {:.2}  # ±{g} g; the sensor has ±{} g", g * 9.80665, list(self.ranges_g)),
        );
        text.sensitivity(is_of_counts, "accelerometer_lsb_per_g", "g", self.ranges_g);
        if let Some(noise) = self.noise_mdps_per_rthz.filter(|_| text.has("gyroscope")) {
            let dps = range(self.ranges_dps);
            text.takes("gyroscope", "unit = \"counts\"");
            text.remove("gyroscope", "noise_radps");
            text.set(
                "gyroscope",
                "noise_mdps_per_rthz",
                &format!("noise_mdps_per_rthz = {noise:?}  # noise density of the {name}"),
            );
            text.set("gyroscope", "noise_bandwidth_hz", bandwidth);
            text.set(
                "gyroscope",
                "range_degps",
                &format!("range_degps = {dps:?}  # the sensor has ±{} °/s", list(self.ranges_dps)),
            );
            text.sensitivity(is_of_counts, "gyroscope_lsb_per_dps", "°/s", self.ranges_dps);
        }
        text.0.join("\n") + "\n"
    }
}

/// Ranges, each with the sensitivity of a converter of 16 bits.
const fn converter_of_16_bits<const N: usize>(ranges: [f64; N]) -> [(f64, f64); N] {
    let mut of = [(0.0, 0.0); N];
    let mut k = 0;
    while k < N {
        of[k] = (ranges[k], 32768.0 / ranges[k]);
        k += 1;
    }
    of
}

/// The datasheets. All figures are from the makers' documents.
pub const DATASHEETS: &[Datasheet] = &[
    Datasheet {
        name: "BMI088",
        source: "BST-BMI088-DS001-14, revision 1.4",
        noise_ug_per_rthz: 190.0,
        noise_mdps_per_rthz: Some(14.0),
        ranges_g: &[(6.0, 5460.0), (3.0, 10920.0), (12.0, 2730.0), (24.0, 1365.0)],
        ranges_dps: &converter_of_16_bits([2000.0, 125.0, 250.0, 500.0, 1000.0]),
    },
    Datasheet {
        name: "BMI270",
        source: "BST-BMI270-DS000-05, revision 1.3",
        noise_ug_per_rthz: 160.0,
        noise_mdps_per_rthz: Some(7.0),
        ranges_g: &converter_of_16_bits([8.0, 2.0, 4.0, 16.0]),
        ranges_dps: &converter_of_16_bits([2000.0, 125.0, 250.0, 500.0, 1000.0]),
    },
    Datasheet {
        name: "ICM-42688-P",
        source: "DS-000347, revision 1.5",
        noise_ug_per_rthz: 70.0,
        noise_mdps_per_rthz: Some(2.8),
        ranges_g: &converter_of_16_bits([16.0, 2.0, 4.0, 8.0]),
        ranges_dps: &[
            (2000.0, 16.4),
            (15.625, 2097.2),
            (31.25, 1048.6),
            (62.5, 524.3),
            (125.0, 262.0),
            (250.0, 131.0),
            (500.0, 65.5),
            (1000.0, 32.8),
        ],
    },
    Datasheet {
        name: "ICM-20948",
        source: "DS-000189, revision 1.6",
        noise_ug_per_rthz: 230.0,
        noise_mdps_per_rthz: Some(15.0),
        ranges_g: &converter_of_16_bits([2.0, 4.0, 8.0, 16.0]),
        ranges_dps: TDK_DPS,
    },
    Datasheet {
        name: "LSM6DSV16X",
        source: "DS13510, revision 4",
        noise_ug_per_rthz: 60.0,
        noise_mdps_per_rthz: Some(2.8),
        ranges_g: &[
            (2.0, 1.0 / 0.061e-3),
            (4.0, 1.0 / 0.122e-3),
            (8.0, 1.0 / 0.244e-3),
            (16.0, 1.0 / 0.488e-3),
        ],
        ranges_dps: &[
            (125.0, 1.0 / 4.375e-3),
            (250.0, 1.0 / 8.75e-3),
            (500.0, 1.0 / 17.5e-3),
            (1000.0, 1.0 / 35e-3),
            (2000.0, 1.0 / 70e-3),
            (4000.0, 1.0 / 140e-3),
        ],
    },
    Datasheet {
        name: "MPU-6050",
        source: "PS-MPU-6000A-00, revision 3.4",
        noise_ug_per_rthz: 400.0,
        noise_mdps_per_rthz: Some(5.0),
        ranges_g: &converter_of_16_bits([2.0, 4.0, 8.0, 16.0]),
        ranges_dps: TDK_DPS,
    },
    Datasheet {
        name: "MPU-9250",
        source: "PS-MPU-9250A-01, revision 1.0",
        noise_ug_per_rthz: 300.0,
        noise_mdps_per_rthz: Some(10.0),
        ranges_g: &converter_of_16_bits([2.0, 4.0, 8.0, 16.0]),
        ranges_dps: TDK_DPS,
    },
    Datasheet {
        name: "MTi-3",
        source: "MT0512P, revision D of 2016",
        noise_ug_per_rthz: 200.0,
        noise_mdps_per_rthz: Some(10.0),
        ranges_g: &[(16.0, 0.0)],
        ranges_dps: &[(2000.0, 0.0)],
    },
    Datasheet {
        name: "ADXL355",
        source: "ADXL354/ADXL355, revision D",
        noise_ug_per_rthz: 22.5,
        noise_mdps_per_rthz: None,
        ranges_g: &[(2.048, 256_000.0), (4.096, 128_000.0), (8.192, 64_000.0)],
        ranges_dps: &[],
    },
    Datasheet {
        name: "ADIS16470",
        source: "ADIS16470, revision C",
        noise_ug_per_rthz: 100.0,
        noise_mdps_per_rthz: Some(8.0),
        ranges_g: &[(40.0, 800.0)],
        ranges_dps: &[(2000.0, 10.0)],
    },
];

/// The ranges of the gyroscopes of TDK InvenSense.
const TDK_DPS: &[(f64, f64)] = &[(250.0, 131.0), (500.0, 65.5), (1000.0, 32.8), (2000.0, 16.4)];

/// Ranges in words: `3, 6, 12, 24`.
fn list(ranges: &[(f64, f64)]) -> String {
    let mut ranges: Vec<f64> = ranges.iter().map(|(range, _)| *range).collect();
    ranges.sort_by(f64::total_cmp);
    ranges.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")
}

/// The lines of an experiment file.
struct Sections(Vec<String>);

impl Sections {
    /// The lines of a section, without its heading.
    fn lines(&self, section: &str) -> Option<std::ops::Range<usize>> {
        let heading = format!("[{section}]");
        let start = 1 + self.0.iter().position(|line| line.starts_with(&heading))?;
        let end = self.0[start..]
            .iter()
            .position(|line| line.starts_with('['))
            .map_or(self.0.len(), |end| start + end);
        Some(start..end)
    }

    fn has(&self, section: &str) -> bool {
        self.lines(section).is_some()
    }

    /// The line of a key, also one that is a comment.
    fn line(&self, section: &str, key: &str) -> Option<usize> {
        let is_of = |line: &str| {
            line.trim_start_matches(['#', ' ']).split('=').next().is_some_and(|of| of.trim() == key)
        };
        self.lines(section)?.find(|&line| is_of(&self.0[line]))
    }

    /// Makes the line of a key a comment.
    fn remove(&mut self, section: &str, key: &str) {
        if let Some(line) = self.line(section, key).filter(|line| !self.0[*line].starts_with('#')) {
            self.0[line].insert_str(0, "# ");
        }
    }

    /// Makes the line that begins so a comment; was it there?
    fn takes(&mut self, section: &str, begin: &str) -> bool {
        let Some(line) =
            self.lines(section).and_then(|mut of| of.find(|&line| self.0[line].starts_with(begin)))
        else {
            return false;
        };
        self.0[line].insert_str(0, "# ");
        true
    }

    /// Replaces the line of a key, or adds it at the end of its section, which is added where it is missing.
    fn set(&mut self, section: &str, key: &str, text: &str) {
        if let Some(line) = self.line(section, key) {
            self.0[line] = text.to_owned();
            return;
        }
        if !self.has(section) {
            self.0.extend([String::new(), format!("[{section}]")]);
        }
        let Some(lines) = self.lines(section) else { return };
        let last = lines.clone().rev().find(|&line| !self.0[line].trim().is_empty());
        self.0.insert(last.map_or(lines.start, |last| last + 1), text.to_owned());
    }

    /// The sensitivity for counts: as a comment, where the readings need not be counts.
    fn sensitivity(&mut self, is_of_counts: bool, key: &str, unit: &str, ranges: &[(f64, f64)]) {
        let Some((range, counts)) = ranges.first().filter(|(_, counts)| *counts > 0.0) else { return };
        let others =
            ranges[1..].iter().map(|(range, counts)| format!("; {} at ±{range} {unit}", plain(*counts, 6)));
        let text = format!(
            "{}{key} = {}  # of counts at ±{range} {unit}{}",
            if is_of_counts { "" } else { "# " },
            plain(*counts, 6),
            others.collect::<String>()
        );
        self.set("columns", key, &text);
    }
}
