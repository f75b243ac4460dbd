//! The tables of a calibration on a machine on stdout.

use super::table::table;
use calibrant::machine::estimate::{
    MachineCalibration, MachineQuantity, MachineValidation, ReferenceNoise, SensorResidual, Source,
};
use calibrant::pipeline::MachineOutcome;
use calibrant::report::{
    machine_unit, machine_validation_heading, machine_validation_rows, machine_validation_sentences,
    mounting_in_words, number_format,
};
use calibrant::sensor::SensorKind;
use nalgebra::Vector3;

/// How the estimation ended, the sensor's parameters, what was found of the machine, and where the uncertainty is from.
pub(crate) fn on_machine(outcome: &MachineOutcome) -> String {
    let calibration = &outcome.calibration;
    let of_imu = |quantity: &MachineQuantity| matches!(quantity, MachineQuantity::Imu(_));
    let of_joints = |quantity: &MachineQuantity| {
        matches!(quantity, MachineQuantity::Zero(_) | MachineQuantity::Geometry(..))
    };
    let mut text = format!("  {}\n\n", verdict(calibration));
    text.push_str(&parameters(outcome));
    let others = |quantity: &MachineQuantity| !of_imu(quantity) && !of_joints(quantity);
    text.push_str(&format!("\n{}", machine(outcome, others)));
    if let Some(line) = largest_correction(outcome) {
        text.push_str(&format!("  {line}\n"));
    }
    text.push_str(&format!("\n{}\n", budget(calibration)));
    if let Some(sentence) = mounting_in_words(calibration, &outcome.setup) {
        text.push_str(&format!("  {sentence}\n"));
    }
    let noise = calibration.noise.iter().map(sensor_noise(calibration));
    let lines = noise.chain(log_noise(&calibration.reference_noise)).chain([knots(calibration)]);
    lines.for_each(|line| text.push_str(&format!("  {line}\n")));
    outcome.validations.iter().for_each(|of| text.push_str(&validation(of, calibration)));
    text
}

/// A table and a verdict for each sensor.
fn validation(validation: &MachineValidation, calibration: &MachineCalibration) -> String {
    let (header, rows) = machine_validation_rows(validation, calibration);
    let rows: Vec<Vec<String>> = rows.into_iter().map(Vec::from).collect();
    let heading = machine_validation_heading(validation);
    let mut text = format!("\n  Validation: {heading}\n\n{}", table(&header, &rows));
    for sentence in machine_validation_sentences(validation) {
        text.push_str(&format!("  {sentence}\n"));
    }
    text
}

/// The status, χ² where it tests something, and how much of the recording was used.
fn verdict(calibration: &MachineCalibration) -> String {
    let fit = &calibration.fit;
    let chi2 = match fit.p_value {
        Some(p) => format!(
            "χ² {} with {} degrees of freedom, p-value {}",
            number_format::significant(fit.chi2, 5),
            number_format::count(fit.degrees_of_freedom),
            number_format::probability(p)
        ),
        None => "noise from the residuals".to_owned(),
    };
    format!(
        "{} after {}; {chi2}; {} of the samples used",
        calibration.status.name(),
        number_format::counted(calibration.iterations, "iteration"),
        share(calibration.used_share)
    )
}

fn share(part: f64) -> String {
    format!("{} %", number_format::significant(100.0 * part, 3))
}

/// The parameters of the sensors.
fn parameters(outcome: &MachineOutcome) -> String {
    rows_of(outcome, &["parameter", "estimate ± sd", "unit"], |quantity, _| {
        matches!(quantity, MachineQuantity::Imu(_)).then(Vec::new)
    })
}

/// What was found of mount, gravity and clocks, beside what was known.
fn machine(outcome: &MachineOutcome, wanted: impl Fn(&MachineQuantity) -> bool) -> String {
    rows_of(outcome, &["machine", "estimate ± sd", "unit", "known ±"], |quantity, factor| {
        let sd = factor * prior_sd(outcome, quantity);
        wanted(&quantity).then(|| vec![number_format::significant(sd, 3)])
    })
}

/// A row for each quantity that has further cells, which are made of it and of the factor of its unit.
fn rows_of(
    outcome: &MachineOutcome,
    header: &[&str],
    further: impl Fn(MachineQuantity, f64) -> Option<Vec<String>>,
) -> String {
    let calibration = &outcome.calibration;
    let (names, sd) = (calibration.names(), calibration.sd());
    let row = |k: usize| {
        let quantity = calibration.quantities[k];
        let (factor, unit) = machine_unit(calibration, quantity);
        let value = number_format::with_sd(factor * calibration.values[k], factor * sd[k]);
        Some([vec![names[k].clone(), value, unit.to_owned()], further(quantity, factor)?].concat())
    };
    let rows: Vec<Vec<String>> = (0..names.len()).filter_map(row).collect();
    table(header, &rows)
}

fn prior_sd(outcome: &MachineOutcome, quantity: MachineQuantity) -> f64 {
    outcome.setup.prior_sd(quantity, outcome.calibration.noise.len())
}

/// The joint whose correction is the farthest from what its file says, in what was known of it.
fn largest_correction(outcome: &MachineOutcome) -> Option<String> {
    let calibration = &outcome.calibration;
    let of_joint = |k: &usize| {
        matches!(calibration.quantities[*k], MachineQuantity::Zero(_) | MachineQuantity::Geometry(..))
    };
    let deviation = |k: usize| calibration.values[k].abs() / prior_sd(outcome, calibration.quantities[k]);
    let places: Vec<usize> = (0..calibration.quantities.len()).filter(of_joint).collect();
    let most = places.iter().copied().max_by(|one, other| deviation(*one).total_cmp(&deviation(*other)))?;
    Some(format!(
        "geometry: {} corrections of the joints, the largest {} standard deviations of what is known ({})",
        places.len(),
        number_format::significant(deviation(most), 2),
        calibration.names()[most]
    ))
}

/// Where the variance of each parameter is from, in percent.
fn budget(calibration: &MachineCalibration) -> String {
    let used: Vec<usize> = (0..Source::ALL.len())
        .filter(|source| calibration.budget.iter().any(|row| row.parts[*source] > 0.0))
        .collect();
    let mut header = vec!["variance from, %".to_owned()];
    header.extend(used.iter().map(|source| Source::ALL[*source].name().replace('_', " ")));
    let rows: Vec<Vec<String>> = calibration
        .budget
        .iter()
        .map(|row| {
            let percent = |source: &usize| format!("{:.0}", 100.0 * row.parts[*source] / row.variance);
            std::iter::once(row.quantity.name()).chain(used.iter().map(percent)).collect()
        })
        .collect();
    table(&header.iter().map(String::as_str).collect::<Vec<_>>(), &rows)
}

fn sensor_noise(calibration: &MachineCalibration) -> impl Fn(&SensorResidual) -> String {
    let units = calibration.units;
    move |residual: &SensorResidual| {
        let SensorResidual { sensor, noise, growth, .. } = residual;
        let unit = units[usize::from(*sensor != SensorKind::Accelerometer)];
        format!(
            "noise of a sample of the {sensor} {} {}{}",
            list(noise),
            unit.unwrap_or(sensor.stimulus_unit()).symbol(),
            if growth.is_some() { " at rest; it grows with motion" } else { "" }
        )
    }
}

fn list(noise: &Vector3<f64>) -> String {
    noise.iter().map(|noise| number_format::significant(*noise, 3)).collect::<Vec<_>>().join(", ")
}

/// The noise of the log: the largest of each unit.
fn log_noise(noise: &[ReferenceNoise]) -> Vec<String> {
    ["m", "rad"]
        .into_iter()
        .filter_map(|unit| {
            let of_unit = noise.iter().filter(|noise| noise.unit == unit);
            let most = of_unit.clone().max_by(|one, other| one.sd.total_cmp(&other.sd))?;
            let outliers: usize = of_unit.map(|noise| noise.outliers).sum();
            let outliers = match outliers {
                0 => String::new(),
                count => format!("; {} left out", number_format::counted(count, "outlier")),
            };
            Some(format!(
                "noise of a sample of the log at most {} {unit} ({}){}{outliers}",
                number_format::significant(most.sd, 3),
                most.name,
                if most.growth.is_some() { " at rest; it grows with motion" } else { "" }
            ))
        })
        .collect()
}

fn knots(calibration: &MachineCalibration) -> String {
    let knots = calibration.motion.knots();
    format!(
        "motion as splines of degree {} with a knot every {} s",
        knots.degree.number(),
        number_format::significant(knots.step_s, 3)
    )
}
