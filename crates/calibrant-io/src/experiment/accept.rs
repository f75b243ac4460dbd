//! Reads `[accept]`: the limits that a result must keep.

use super::known_keys::nearest;
use super::number_range::Bounds;
use super::toml_document::{Entry, Section};
use calibrant_core::acceptance::AcceptanceLimit;
use calibrant_core::error::Result;
use calibrant_core::sensor::{
    Axis, Gauge, HIGHEST_ORDER, ImuQuantity, ParameterList, SensorKind, SensorModel, ThermalPart, ThermalTerm,
};

/// Figures that follow from the parameters, or from the fit.
const DERIVED: [&str; 6] = [
    "axis_angle_deg",
    "norm_rms_mps2",
    "rotation_rms_deg",
    "residual_rms",
    "repeatability_mps2",
    "validation_ratio",
];
/// Range of a limit of a value.
const VALUE: Bounds = Bounds::from(-1e12, 1e12, "");
/// Range of a limit of a standard deviation.
const SD: Bounds = Bounds::above(0.0, 1e12, "");
/// How a limit is written.
const HELP: &str = "for example { range = [-0.05, 0.05], sd = 1e-3 }";

/// Reads `[accept]`.
pub(super) fn read(section: &Section<'_>) -> Result<Vec<AcceptanceLimit>> {
    let known = names();
    section
        .entries()
        .map(|(name, entry)| {
            if !known.iter().any(|known| known == name) {
                let near = nearest(name, known.iter().map(String::as_str));
                let help = near.map_or_else(
                    || format!("a parameter of calibration.json, or one of {}", DERIVED.join(", ")),
                    |near| format!("did you mean `{near}`?"),
                );
                return Err(section.unknown(name, &help));
            }
            limit(name, &entry)
        })
        .collect()
}

fn limit(name: &str, entry: &Entry<'_>) -> Result<AcceptanceLimit> {
    if !entry.is_table() {
        return Err(entry.wrong_type("a table", HELP));
    }
    let section = Section::item(entry, "accept.limit")?;
    let range = section.get("range").map(|entry| range(&entry)).transpose()?;
    let sd = section.get("sd").map(|entry| entry.number(&SD)).transpose()?;
    if range.is_none() && sd.is_none() {
        return Err(entry.reject("this limit limits nothing", HELP));
    }
    Ok(AcceptanceLimit { name: name.to_owned(), range, sd })
}

fn range(entry: &Entry<'_>) -> Result<(f64, f64)> {
    let help = "the least and the largest accepted value: [-0.05, 0.05]";
    let items = entry.items(help)?;
    let [least, most] = items.as_slice() else {
        return Err(entry.reject("two numbers are needed here", help));
    };
    let (least, most) = (least.number(&VALUE)?, most.number(&VALUE)?);
    if least > most {
        return Err(entry.reject(format!("the least value {least:?} is above the largest, {most:?}"), help));
    }
    Ok((least, most))
}

/// The names of all figures, and those of their groups.
fn names() -> Vec<String> {
    let mut names: Vec<String> = DERIVED.map(String::from).to_vec();
    let mut add = |quantity: ImuQuantity| {
        let name = quantity.name();
        let group = name.rsplit_once('.').map(|(group, _)| group.to_owned());
        names.extend(group.into_iter().chain([name]));
    };
    for kind in SensorKind::ALL {
        let lists =
            [ParameterList::new(3, SensorModel::Full), Gauge::Symmetric.parameter_list(SensorModel::Full)];
        lists.iter().flat_map(|list| list.quantities()).for_each(|of| add(ImuQuantity::Of(kind, *of)));
        for (part, order) in [ThermalPart::Bias, ThermalPart::Scale]
            .into_iter()
            .flat_map(|part| (1..=HIGHEST_ORDER).map(move |order| (part, order)))
        {
            let term = |axis| ImuQuantity::Thermal(kind, ThermalTerm { part, axis, order });
            Axis::ALL.into_iter().for_each(|axis| add(term(axis)));
        }
    }
    for row in Axis::ALL {
        Axis::ALL.into_iter().for_each(|column| add(ImuQuantity::GSensitivity(row, column)));
    }
    names
}
