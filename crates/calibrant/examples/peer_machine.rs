//! Calibrates recordings of an IMU on an arm that MuJoCo made, and counts how often the 95 % intervals hold the truth:
//! `cargo run --release -p calibrant --features programs --example peer_machine -- FOLDER URDF [known|noisy] [modelled|exact] [NUMBER] [prior|unknown]`.
//! `peers/mujoco/recordings.py` writes the folder; `scripts/peers` runs both.
//!
//! `exact` takes the geometry of the URDF as it is. Where the arm differs, the residuals must say so.
//! `prior` knows the mounting to 0.5°; with `unknown` the truth is that of the same sensor in the gauge `upper`.

use calibrant::estimate::CalibrationStatus;
use calibrant::io::{ImuReadOptions, ReferenceLogOptions, Urdf, read_imu_recording, read_reference_log};
use calibrant::machine::chain::KinematicChain;
use calibrant::machine::estimate::{
    MachineCalibration, MachineProblem, MachineQuantity, MachineSettings, MachineSetup, MachineTrust,
    MountingPrior, calibrate_on_machine, cross_validate_on_machine,
};
use calibrant::machine::log::ReferenceLog;
use calibrant::sensor::{
    Axis, CalibratedImu, ImuParameters, ImuQuantity, ParameterList, ReadingUnit, SensorKind, SensorModel,
    SensorParameters,
};
use nalgebra::Vector3;
use serde_json::Value;
use std::collections::BTreeMap;
use std::error::Error;
use std::path::Path;
use std::time::Instant;

/// The 97.5 % quantile of the normal distribution.
const TWO_SIDED_95: f64 = 1.959_964;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().collect();
    let word = |k: usize, default: &str| arguments.get(k).cloned().unwrap_or_else(|| default.to_owned());
    let (folder, urdf) = (word(1, "target/peer_machine"), word(2, "ur5e.urdf"));
    let trust = if word(3, "noisy") == "known" { MachineTrust::Known } else { MachineTrust::Noisy };
    let exact = word(4, "modelled") == "exact";
    let number: usize = word(5, "300").parse()?;
    let chain = Urdf::read(Path::new(&urdf))?.chain(None, Some("tool0"))?;
    let mut setup =
        MachineSetup { trust, lever_m: Vector3::new(0.02, -0.03, 0.04), ..MachineSetup::default() };
    setup.knot_step_s = std::env::var("STEP").ok().and_then(|step| step.parse().ok());
    let unknown = word(6, "prior") == "unknown";
    if unknown {
        setup.mounting = MountingPrior::Unknown;
    }
    if exact {
        setup = MachineSetup {
            geometry_translation_sd_m: 0.0,
            geometry_rotation_sd_rad: 0.0,
            zero_sd: 0.0,
            ..setup
        };
    }
    let mut tally = Tally::default();
    for k in 0..number {
        let one = Path::new(&folder).join(format!("{k:03}"));
        if !one.exists() {
            break;
        }
        let clock = Instant::now();
        let calibration = calibrated(&one, &chain, &setup)?;
        tally.add(&calibration, &truth(&one, &calibration, unknown)?, clock.elapsed().as_secs_f64());
    }
    tally.print();
    Ok(())
}

fn calibrated(
    folder: &Path,
    chain: &KinematicChain,
    setup: &MachineSetup,
) -> Result<MachineCalibration, Box<dyn Error>> {
    let file = read_imu_recording(&folder.join("recording.csv"), &ImuReadOptions::default())?;
    let names: Vec<&str> = chain.joints.iter().map(|joint| joint.name.as_str()).collect();
    let log = read_reference_log(&folder.join("joints.csv"), &ReferenceLogOptions::default())?;
    let log = ReferenceLog::Joints(log.joints_in_order(&names)?);
    let list = ParameterList::new(3, SensorModel::Full);
    let quantities: Vec<ImuQuantity> = SensorKind::ALL
        .into_iter()
        .flat_map(|kind| list.quantities().iter().map(move |of| ImuQuantity::Of(kind, *of)))
        .collect();
    let problem = MachineProblem {
        recording: &file.recording,
        log: &log,
        chain: Some(chain),
        setup,
        nominal: &ImuParameters::identity(),
        quantities: &quantities,
    };
    let calibration = calibrate_on_machine(&problem, &MachineSettings::default())?;
    if let Some(folds) = std::env::var("FOLDS").ok().and_then(|folds| folds.parse().ok()) {
        for of in
            cross_validate_on_machine(&problem, &calibration, &MachineSettings::default(), folds)?.shifts
        {
            let (low, high) = of.factor_interval;
            println!("folds: {} {:.2} ({low:.2} to {high:.2}) {}", of.sensor, of.factor, of.verdict.name());
        }
    }
    if std::env::var("SHOW").is_ok() {
        println!(
            "{:?} {} {:?}",
            calibration.sensors.status,
            calibration.sensors.iterations,
            calibration.motion.knots()
        );
        for of in &calibration.noise {
            println!(
                "{} {:?} white {:?} {:?}",
                of.sensor,
                of.noise.as_slice(),
                of.white_noise.as_slice(),
                of.growth
            );
        }
        for warning in &calibration.sensors.warnings {
            println!("{:?}", warning.code());
        }
        for of in &calibration.reference_noise {
            println!("{} {:.2e} {:?} {}", of.name, of.sd, of.growth, of.outliers);
        }
    }
    Ok(calibration)
}

/// The true value of each quantity; NaN where it has none.
fn truth(folder: &Path, calibration: &MachineCalibration, unknown: bool) -> Result<Vec<f64>, Box<dyn Error>> {
    let json: Value = serde_json::from_str(&std::fs::read_to_string(folder.join("truth.json"))?)?;
    let imu = true_sensor(&json["parameters"], unknown)?;
    let number = |of: &Value| of.as_f64().ok_or("truth.json lacks a value");
    let of = |quantity: &MachineQuantity| -> Result<f64, Box<dyn Error>> {
        Ok(match *quantity {
            MachineQuantity::Imu(of) => of.value(&imu),
            MachineQuantity::Lever(axis) => number(&json["lever_m"][axis.index()])?,
            // it counts from the start of the search
            MachineQuantity::Mounting(_) if unknown => f64::NAN,
            MachineQuantity::Mounting(axis) => number(&json["tip_from_sensor"]["error_rad"][axis.index()])?,
            MachineQuantity::Tilt(k) => number(&json["tilt_rad"][k])?,
            MachineQuantity::Delay(sensor) => number(&json["delays_at_middle_s"][sensor.to_string()])?,
            MachineQuantity::ClockRate => number(&json["clock_rate"])?,
            MachineQuantity::Zero(j) => number(&json["zeros"][j])?,
            MachineQuantity::Geometry(j, k) => number(&json["geometry"][j][k])?,
            MachineQuantity::Gravity => return Err("gravity is not estimated".into()),
        })
    };
    calibration.quantities.iter().map(of).collect()
}

/// The sensor that was simulated, in the gauge `upper` where its mounting is unknown.
fn true_sensor(parameters: &Value, in_gauge: bool) -> Result<ImuParameters, Box<dyn Error>> {
    let number = |name: String| parameters[&name].as_f64().ok_or(format!("truth.json lacks {name}"));
    let sensor = |kind: SensorKind| -> Result<SensorParameters, Box<dyn Error>> {
        let mut of = SensorParameters::identity();
        for row in Axis::ALL {
            of.bias[row.index()] = number(format!("{kind}.bias.{row}"))?;
            for column in Axis::ALL {
                of.matrix[(row.index(), column.index())] = number(format!("{kind}.matrix.{row}{column}"))?;
            }
        }
        Ok(of)
    };
    let parameters = ImuParameters {
        sensors: [sensor(SensorKind::Accelerometer)?, sensor(SensorKind::Gyroscope)?].into(),
        ..ImuParameters::identity()
    };
    let units = [Some(ReadingUnit::MetrePerSecondSquared), Some(ReadingUnit::RadianPerSecond)];
    let quantities = ImuQuantity::full_list(true, true, false);
    let imu = CalibratedImu::new(parameters, units, quantities, "that of MuJoCo");
    Ok(if in_gauge { imu.in_gauge(MountingPrior::GAUGE)?.parameters } else { parameters })
}

/// Errors over many recordings.
#[derive(Default)]
struct Tally {
    /// Number, squares of errors in standard deviations, and intervals that hold, for each quantity.
    quantities: BTreeMap<String, (usize, f64, usize)>,
    order: Vec<String>,
    converged: usize,
    recordings: usize,
    seconds: Vec<f64>,
    noise: Vec<f64>,
    inflated: usize,
    warned: usize,
}

impl Tally {
    fn add(&mut self, calibration: &MachineCalibration, truth: &[f64], seconds: f64) {
        self.order = calibration.names();
        self.recordings += 1;
        self.converged += usize::from(calibration.sensors.status == CalibrationStatus::Converged);
        self.seconds.push(seconds);
        self.inflated += usize::from(calibration.inflation.iter().any(|factor| *factor > 1.0));
        self.warned += usize::from(!calibration.sensors.warnings.is_empty());
        self.noise.extend(calibration.noise.iter().map(|of| of.noise.mean() / of.white_noise.mean()));
        for ((name, value), (sd, truth)) in
            self.order.iter().zip(&calibration.values).zip(calibration.sd().iter().zip(truth))
        {
            let z = (value - truth) / sd;
            if z.is_nan() {
                continue;
            }
            let of = self.quantities.entry(name.clone()).or_default();
            of.0 += 1;
            of.1 += z * z;
            of.2 += usize::from(z.abs() < TWO_SIDED_95);
        }
    }

    fn print(&mut self) {
        self.seconds.sort_by(f64::total_cmp);
        self.noise.sort_by(f64::total_cmp);
        println!(
            "{} recordings, {} converged, {} with wider intervals, {} with warnings; median time {:.2} s; median noise {:.3} of the white noise",
            self.recordings,
            self.converged,
            self.inflated,
            self.warned,
            self.seconds.get(self.recordings / 2).copied().unwrap_or(0.0),
            self.noise.get(self.noise.len() / 2).copied().unwrap_or(0.0),
        );
        let (mut all, mut held) = (0, 0);
        for name in &self.order {
            let Some(&(count, squares, inside)) = self.quantities.get(name) else { continue };
            if name.starts_with("acc") || name.starts_with("gyr") {
                all += count;
                held += inside;
            }
            let n = count as f64;
            println!("{name:32} z² {:6.2}  covered {:5.1} %", squares / n, 100.0 * inside as f64 / n);
        }
        println!("parameters of the sensor: {:.1} % covered", 100.0 * held as f64 / all as f64);
    }
}
