//! A line as names and fields: a header, a row of numbers, `name:value` pairs as for a serial plotter, or a JSON object.

use serde_json::Value;

/// What a line is.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Fields {
    /// Names of columns.
    Names(Vec<String>),
    /// Values of the columns in their order.
    Row(Vec<String>),
    /// Values with the names of their columns.
    Named(Vec<(String, String)>),
    /// Something else.
    Other,
}

/// A recording has time and three axes at least; without its own clock three.
const FEWEST: usize = 3;

impl Fields {
    pub(crate) fn of(line: &str) -> Self {
        let line = line.trim();
        if line.contains(char::REPLACEMENT_CHARACTER) {
            return Self::Other;
        }
        if line.starts_with('{') {
            let mut named = Vec::new();
            return match serde_json::from_str::<Value>(line) {
                Ok(value) => {
                    flatten("", &value, &mut named);
                    named.iter_mut().for_each(|(name, _)| *name = name.replace([',', '"', '\n', '\r'], " "));
                    if named.len() < FEWEST { Self::Other } else { Self::Named(named) }
                }
                Err(_) => Self::Other,
            };
        }
        let fields = split(line);
        // a line may end with a separator; whether a row does is for its header to say
        let ends = usize::from(fields.last().is_some_and(|last| last.is_empty()));
        let named = &fields[..fields.len() - ends];
        if named.len() < FEWEST {
            return Self::Other;
        }
        let pair = |field: &&str| {
            let (name, value) = field.split_once([':', '='])?;
            is_number(value).then(|| (name.trim().to_owned(), value.trim().to_owned()))
        };
        if let Some(named) = named.iter().map(pair).collect::<Option<Vec<_>>>() {
            return Self::Named(named);
        }
        let numbers = fields.iter().filter(|field| is_number(&with_point(field)) || field.is_empty()).count();
        let owned = |fields: &[&str]| fields.iter().map(|field| with_point(field)).collect();
        match numbers {
            // a time of day, or a word such as the name of a sensor
            _ if numbers + 1 >= fields.len() && numbers >= FEWEST => Self::Row(owned(&fields)),
            0..=2 if named.iter().all(|field| field.chars().any(char::is_alphabetic)) => {
                Self::Names(owned(named))
            }
            _ => Self::Other,
        }
    }
}

/// A number with a decimal comma, as a spreadsheet of some countries writes it between semicolons, with a point.
fn with_point(field: &str) -> String {
    let pointed = field.replacen(',', ".", 1);
    if field.contains(',') && is_number(&pointed) { pointed } else { field.replace([',', '"'], " ") }
}

fn is_number(field: &str) -> bool {
    field.trim().parse::<f64>().is_ok_and(f64::is_finite)
}

fn split(line: &str) -> Vec<&str> {
    for delimiter in [';', '\t', ','] {
        if line.contains(delimiter) {
            return line.split(delimiter).map(str::trim).collect();
        }
    }
    line.split_whitespace().collect()
}

/// Endings of names that are units.
const UNITS: [&str; 7] = ["mps2", "g", "mg", "radps", "dps", "mdps", "counts"];

/// The numbers of a JSON value, with the path to each: `accel.x`, and `accel_x` of a list of three.
fn flatten(path: &str, value: &Value, into: &mut Vec<(String, String)>) {
    let under = |key: &str| if path.is_empty() { key.to_owned() } else { format!("{path}_{key}") };
    match value {
        Value::Number(number) => into.push((path.to_owned(), number.to_string())),
        Value::Object(fields) => fields.iter().for_each(|(key, value)| flatten(&under(key), value, into)),
        Value::Array(list) if list.len() == 3 => {
            // an axis stands before the unit: `accel_x_mps2`
            let (name, unit) =
                path.rsplit_once('_').filter(|(_, unit)| UNITS.contains(unit)).unwrap_or((path, ""));
            for (key, value) in ["x", "y", "z"].into_iter().zip(list) {
                let ending = if unit.is_empty() { String::new() } else { format!("_{unit}") };
                flatten(&format!("{name}_{key}{ending}"), value, into);
            }
        }
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_form_is_known() {
        let texts = |of: &[&str]| of.iter().map(|one| (*one).to_owned()).collect::<Vec<_>>();
        assert_eq!(Fields::of("t_s, ax,ay,az"), Fields::Names(texts(&["t_s", "ax", "ay", "az"])));
        assert_eq!(Fields::of("1,2.5,-3,"), Fields::Row(texts(&["1", "2.5", "-3", ""])));
        assert_eq!(Fields::of("0,5;-2,25;3"), Fields::Row(texts(&["0.5", "-2.25", "3"])));
        assert_eq!(Fields::of("1\t2\t3"), Fields::Row(texts(&["1", "2", "3"])));
        let named = |of: &[(&str, &str)]| {
            Fields::Named(of.iter().map(|(name, value)| ((*name).to_owned(), (*value).to_owned())).collect())
        };
        assert_eq!(Fields::of("ax:1 ay:2 az:-3"), named(&[("ax", "1"), ("ay", "2"), ("az", "-3")]));
        let json = r#"{"t": 5, "accel": [1, 2, 3], "gyro": {"x": 0.5}}"#;
        let found =
            named(&[("t", "5"), ("accel_x", "1"), ("accel_y", "2"), ("accel_z", "3"), ("gyro_x", "0.5")]);
        assert_eq!(Fields::of(json), found);
        for other in ["", "Booting...", "{\"t\": 5", "1,2,x,y"] {
            assert_eq!(Fields::of(other), Fields::Other, "{other}");
        }
    }
}
