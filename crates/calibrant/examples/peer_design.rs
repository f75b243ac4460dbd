//! Writes design problems with calibrant's answers and times as JSON:
//! `cargo run --release -p calibrant --features programs --example peer_design -- FILE`. Other programs solve the same problems in another
//! way. `peers/casadi/design.py` is one of them; `scripts/peers` runs both. A second file gives the problems
//! (`peers/casadi/random_designs.py` makes some), which come back with answers.
//!
//! The problems are the reference cases D1 to D4 with one axis and three, every criterion on a scale-bias and
//! on a full sensor, and a stage with limits on velocity and displacement. Times are of the whole `design()`
//! call with 20 starts on one thread. They exclude the certificate, whose time is measured by itself.

use calibrant::design::{Design, DesignProblem, DesignSettings, design};
use calibrant::information::Criterion;
use calibrant::information::criterion::{
    AOptimality, COptimality, DOptimality, EOptimality, IOptimality, MOptimality,
};
use calibrant::motion::{InputNoise, KnownEnds, Limits, MotionClock, MotionGravity, Rest, Trust};
use calibrant::sensor::{Sensor, SensorModel, SensorParameters};
use nalgebra::{DVector, Matrix3, Vector3};
use serde_json::{Value, json};
use std::time::Instant;

/// Number of starts of each design.
const STARTS: usize = 20;
/// A value counts as reached when it is this close.
const REACHED: f64 = 1e-6;

type Failure = Box<dyn std::error::Error>;

fn main() -> Result<(), Failure> {
    let mut arguments = std::env::args().skip(1);
    let file = arguments.next().ok_or("usage: peer_design FILE [PROBLEMS]")?;
    let mut problems: Vec<Value> = match arguments.next() {
        Some(path) => serde_json::from_str(&std::fs::read_to_string(path)?)?,
        None => cases(),
    };
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global()?;
    for problem in &mut problems {
        let answer = answer(problem).map_err(|error| format!("{}: {error}", problem["name"]))?;
        problem["calibrant"] = answer;
    }
    std::fs::write(&file, serde_json::to_string(&problems)?)?;
    Ok(())
}

/// The reference cases, then the other criteria. Their best known values are of the peer with 80 starts, limits kept for all t.
fn cases() -> Vec<Value> {
    let d =
        [("D1", 3.965_463_8e-10), ("D2", 3.973_324_1e-10), ("D3", 3.990_285_1e-10), ("D4", 1.103_671_6e-5)];
    let mut cases = Vec::new();
    for axes in [1_usize, 3] {
        for (name, reference) in d {
            let mut case = case(name, axes, "scale-bias", "A");
            case["reference_value"] = json!(reference * axes as f64);
            cases.push(case);
        }
    }
    for name in ["D1", "D2", "D3"] {
        cases.push(case(name, 1, "scale-bias", "c"));
    }
    for letter in ["D", "E", "M", "I"] {
        cases.push(case("D3", 3, "scale-bias", letter));
    }
    for letter in ["A", "D", "E", "M", "c", "I"] {
        cases.push(case("D1", 3, "full", letter));
    }
    cases.push(case("D4", 3, "full", "A"));
    // the references of the first three are the best of 20, 6 and 3 of the peer's starts
    cases.push(stage("scale-bias", false, 20, 3.0 * 4.117_6e-10));
    cases.push(stage("full", false, 20, 1.340_7e-9));
    cases.push(stage("full", true, 20, 1.881_5e-5));
    cases.push(stage("scale-bias", true, 100, 3.324_9e-6));
    cases.push(under_gravity("A", 0.0));
    cases.push(under_gravity("D", MotionGravity::USUAL_TILT_SD_DEG.to_radians()));
    cases
}

/// A full sensor under gravity, on a stage that lifts it. With criterion A the axes are exactly level: the share of a
/// tilt would hide that of the motion.
fn under_gravity(letter: &str, tilt_sd_rad: f64) -> Value {
    let mut case = case("D3", 3, "full", letter);
    case["name"] = json!("under gravity, full");
    case["limits"]["acceleration_mps2"] = json!(10.0);
    case["limits"]["velocity_mps"] = json!(2.0);
    case["limits"]["displacement_m"] = json!(0.5);
    let gravity = MotionGravity { tilt_sd_rad, ..MotionGravity::of_force(Vector3::new(0.0, 0.0, 9.806_65)) };
    let covariance: Vec<Vec<f64>> =
        gravity.offset_covariance().row_iter().map(|row| row.iter().copied().collect()).collect();
    case["gravity"] = json!({
        "force_mps2": gravity.force_mps2.as_slice(),
        "tilt_sd_rad": tilt_sd_rad,
        "offset_covariance": covariance,
    });
    case
}

/// A stage with limits on velocity and displacement, for 10 s: what a user types first.
fn stage(model: &str, noisy: bool, intervals: usize, reference: f64) -> Value {
    let mut case = case(if noisy { "D4" } else { "D3" }, 3, model, "A");
    case["name"] =
        json!(format!("stage, {}, {model}, N = {intervals}", if noisy { "noisy" } else { "known" }));
    case["intervals"] = json!(intervals);
    case["interval_s"] = json!(10.0 / intervals as f64);
    case["reference_value"] = json!(reference);
    case["limits"] = json!({
        "acceleration_mps2": 10.0,
        "jerk_mps3": 30.0,
        "intercept_mps2": null,
        "velocity_mps": 2.0,
        "displacement_m": 0.5,
        "rest": "both",
    });
    case
}

/// Limits and trust of a reference case. Criterion A is of plain parameters; D, E and M are of parameters
/// over their datasheet spread.
fn case(name: &str, axes: usize, model: &str, letter: &str) -> Value {
    let limit = |on: bool, value: f64| if on { json!(value) } else { Value::Null };
    let (d2, d3, d4) = (name == "D2", name == "D3", name == "D4");
    let parameters = if model == "full" { axes + axes * axes } else { 2 * axes };
    let scale: Vec<f64> = (0..parameters)
        .map(|place| match letter {
            "A" | "c" | "I" => 1.0,
            _ if place < axes => 0.1,
            _ => 0.005,
        })
        .collect();
    let identity: Vec<Vec<f64>> =
        (0..axes).map(|i| (0..axes).map(|j| f64::from(u8::from(i == j))).collect()).collect();
    json!({
        "name": format!("{name}, {axes} {}, {model}", if axes == 1 { "axis" } else { "axes" }),
        "axes": axes,
        "model": model,
        "intervals": 10,
        "interval_s": 1.0,
        "rate_hz": 10.0,
        "noise_mps2": 2e-4,
        "trust": if d4 { "noisy" } else { "known" },
        "input_noise": if d4 { json!({ "floor_mps3": 0.01, "ratio": 0.01 }) } else { Value::Null },
        "known_ends": "start",
        "limits": {
            "acceleration_mps2": limit(!d2, if d4 { 20.0 } else { 30.0 }),
            "jerk_mps3": if d4 { 20.0 } else { 30.0 },
            "intercept_mps2": limit(d2, 30.0),
            "velocity_mps": limit(d3, 10.0),
            "displacement_m": limit(d3, 10.0),
            "rest": if d3 { "both" } else { "none" },
        },
        "criterion": {
            "letter": letter,
            "weights": { "scale.x": 1.0 },
            "range_mps2": limit(letter == "I", 20.0),
            "scale": scale,
        },
        "nominal": { "bias": vec![0.0; axes], "matrix": identity },
        "reference_value": null,
    })
}

/// The answer of calibrant to a problem.
fn answer(case: &Value) -> Result<Value, Failure> {
    let sensor = sensor(case)?;
    let limits = limits(&case["limits"])?;
    let at = nominal(&case["nominal"])?;
    let trust = match &case["input_noise"] {
        Value::Null => Trust::Known,
        noise => Trust::Noisy(InputNoise {
            floor_mps3: number(&noise["floor_mps3"])?,
            ratio: number(&noise["ratio"])?,
        }),
    };
    let problem = DesignProblem {
        sensor: &sensor,
        at,
        intervals: count(&case["intervals"])?,
        interval_s: number(&case["interval_s"])?,
        rate_hz: number(&case["rate_hz"])?,
        trust,
        known_ends: if case["known_ends"] == "both" { KnownEnds::Both } else { KnownEnds::Start },
        gravity: gravity(&case["gravity"])?,
        clock: MotionClock::default(),
        limits: &limits,
        criterion: criterion(&case["criterion"], &sensor, &at)?,
        prior: None,
    };
    let (best, seconds) = timed(&problem, STARTS)?;
    let until = case["reference_value"]
        .as_f64()
        .map(|reference| until_reference(&problem, reference))
        .transpose()?
        .flatten();
    let certified = design(&problem, &settings(STARTS, true), &|_| ())?;
    let nodes = best.optimal.motion.acceleration_mps2();
    let rows: Vec<Vec<f64>> = nodes.iter().map(|a| a.iter().take(sensor.axes).copied().collect()).collect();
    Ok(json!({
        "value": best.optimal.value,
        "acceleration_mps2": rows,
        "seconds": seconds,
        "seconds_to_reference": until,
        "lower_bound": certified.certificate.map(|certificate| certificate.lower_bound),
        "status": best.status.name(),
    }))
}

fn settings(starts: usize, certificate: bool) -> DesignSettings {
    DesignSettings { starts, certificate, ..DesignSettings::default() }
}

/// The design, and the fastest of three wall times: the fastest suffers least from other work on the machine.
fn timed(problem: &DesignProblem<'_>, starts: usize) -> Result<(Design, f64), Failure> {
    let mut fastest = f64::INFINITY;
    let mut best = None;
    for _ in 0..3 {
        let begin = Instant::now();
        best = Some(design(problem, &settings(starts, false), &|_| ())?);
        fastest = fastest.min(begin.elapsed().as_secs_f64());
    }
    Ok((best.ok_or("no design")?, fastest))
}

/// Time of the design with the fewest starts that reach the reference, up to 20.
fn until_reference(problem: &DesignProblem<'_>, reference: f64) -> Result<Option<f64>, Failure> {
    for starts in 1..=STARTS {
        let (best, seconds) = timed(problem, starts)?;
        if problem.criterion.gap(best.optimal.value, reference) <= REACHED {
            return Ok(Some(seconds));
        }
    }
    Ok(None)
}

fn sensor(case: &Value) -> Result<Sensor, Failure> {
    let model = if case["model"] == "full" { SensorModel::Full } else { SensorModel::ScaleBias };
    Ok(Sensor {
        axes: count(&case["axes"])?,
        noise_mps2: Some(Vector3::repeat(number(&case["noise_mps2"])?)),
        ..Sensor::triaxial(model)
    })
}

fn limits(value: &Value) -> Result<Limits, Failure> {
    let of = |key: &str| -> Result<Option<Vector3<f64>>, Failure> {
        if value[key].is_null() { Ok(None) } else { Ok(Some(Vector3::repeat(number(&value[key])?))) }
    };
    Ok(Limits {
        acceleration_mps2: of("acceleration_mps2")?,
        jerk_mps3: of("jerk_mps3")?,
        intercept_mps2: of("intercept_mps2")?,
        velocity_mps: of("velocity_mps")?,
        displacement_m: of("displacement_m")?,
        rest: match value["rest"].as_str() {
            Some("both") => Rest::Both,
            Some("start") => Rest::Start,
            _ => Rest::None,
        },
        ..Limits::default()
    })
}

fn gravity(value: &Value) -> Result<Option<MotionGravity>, Failure> {
    if value.is_null() {
        return Ok(None);
    }
    let force: Vec<f64> = list(&value["force_mps2"])?.iter().map(number).collect::<Result<_, _>>()?;
    let force = Vector3::from_column_slice(&force);
    Ok(Some(MotionGravity { tilt_sd_rad: number(&value["tilt_sd_rad"])?, ..MotionGravity::of_force(force) }))
}

/// Bias and matrix. Axes that the sensor does not have are perfect.
fn nominal(value: &Value) -> Result<SensorParameters, Failure> {
    let mut at = SensorParameters {
        bias: Vector3::zeros(),
        matrix: Matrix3::identity(),
        ..SensorParameters::identity()
    };
    for (row, bias) in list(&value["bias"])?.iter().enumerate() {
        at.bias[row] = number(bias)?;
        for (column, entry) in list(&value["matrix"][row])?.iter().enumerate() {
            at.matrix[(row, column)] = number(entry)?;
        }
    }
    Ok(at)
}

fn criterion(value: &Value, sensor: &Sensor, at: &SensorParameters) -> Result<Criterion, Failure> {
    let list_of_parameters = sensor.parameter_list();
    let scale: Vec<f64> = list(&value["scale"])?.iter().map(number).collect::<Result<_, _>>()?;
    let scale = DVector::from_vec(scale);
    Ok(match value["letter"].as_str() {
        Some("A") => Criterion::A(AOptimality { scale }),
        Some("D") => Criterion::D(DOptimality { scale }),
        Some("E") => Criterion::E(EOptimality { scale }),
        Some("M") => Criterion::M(MOptimality { scale }),
        Some("c") => {
            let names = list_of_parameters.names();
            let weights = names.iter().zip(&scale).map(|(name, s)| {
                let weight = value["weights"][name.as_str()].as_f64().unwrap_or(0.0);
                weight / (s * s)
            });
            Criterion::C(COptimality { weights: DVector::from_iterator(names.len(), weights) })
        }
        Some("I") => {
            let range = number(&value["range_mps2"])?;
            let criterion = IOptimality::new(&list_of_parameters, at, range);
            Criterion::I(criterion.ok_or("the nominal matrix is singular")?)
        }
        other => return Err(format!("no criterion {other:?}").into()),
    })
}

fn number(value: &Value) -> Result<f64, Failure> {
    value.as_f64().ok_or_else(|| format!("expected a number, found {value}").into())
}

fn count(value: &Value) -> Result<usize, Failure> {
    value
        .as_u64()
        .and_then(|count| usize::try_from(count).ok())
        .ok_or_else(|| format!("expected a count, found {value}").into())
}

fn list(value: &Value) -> Result<&Vec<Value>, Failure> {
    value.as_array().ok_or_else(|| format!("expected a list, found {value}").into())
}
