//! Tests of data sets: a row gives its record back, and a data set is taken up once.

use super::tests::place;
use super::*;
use calibrant_core::error::Refusal;
use parquet::column::writer::ColumnWriter;
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::parser::parse_message_type;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The text of a `calibration.json` of a sensor.
fn text(sensor: &str, recording: &str) -> String {
    json!({
        "schema": 2, "kind": "calibration", "program": "calibrant 1.0.0", "sensor": sensor, "recorded": "2026-05-01", "station": null,
        "experiment": {"file": "e.toml", "sha256": "e"}, "verdict": {"usability": "doubtful", "codes": ["coarse-steps"]}, "status": "converged",
        "direction": "true to raw", "frame": "the sensor's", "gauge": "lower", "fit": {"chi2": 7.5, "degrees_of_freedom": 8.0, "p_value": null},
        "accelerometer": {"reading_unit": "m/s²", "bias_mps2": [0.1, 0.0, -0.3], "matrix": [[1.25, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]},
        "parameters": [
            {"name": "accelerometer.bias.z", "unit": "m/s²", "value": -0.3, "sd": 0.02},
            {"name": "accelerometer.scale.x", "unit": "1", "value": 1.25, "sd": 0.01},
        ],
        "covariance_of": "", "covariance": [[4e-4, 1e-5], [1e-5, 1e-4]],
        "covariance_degrees_of_freedom": {"accelerometer": 21.0, "gyroscope_at_rest": null, "gyroscope_matrix": 7.0},
        "shared_errors": {"sources": ["gravity 9.80665 ± 0.019 m/s²", "wrist ± 1e-3"], "root": [[0.0, 1e-3], [2e-3, 4e-3]]},
        "inputs": [{"file": format!("{sensor}.csv"), "sha256": recording, "samples": 9, "rate_hz": 1.0}],
    })
    .to_string()
}

/// The row of a sensor in a part.
fn row(sensor: &str, recording: &str) -> Value {
    let mut row = json!(DatasetRow::parse(&text(sensor, recording)).expect("a calibration"));
    row["file"] = json!(format!("line/{sensor}.csv"));
    row["key"] = json!(recording);
    row
}

/// The row of an item that could not be calibrated.
fn without(file: &str) -> Value {
    let columns = row("A", "a");
    let nulls = columns.as_object().expect("an object").keys().map(|name| (name.clone(), Value::Null));
    let mut row = Value::Object(nulls.collect());
    (row["file"], row["verdict"]) = (json!(file), json!("none"));
    row
}

/// Writes a part as pyarrow does: optional columns, and lists of optional elements.
fn write(path: &Path, rows: &[Value]) {
    let (texts, lists) = (
        ["codes", "names", "units", "shared_sources"],
        ["values", "sd", "covariance", "covariance_degrees", "range_c", "shared_root"],
    );
    let numbers = ["chi2", "degrees_of_freedom", "p_value", "rate_hz", "reference_c"];
    let columns = row("A", "a");
    let columns = columns.as_object().expect("an object");
    let list = |name: &str, element: &str| {
        format!("optional group {name} (LIST) {{ repeated group list {{ optional {element}; }} }}")
    };
    let fields = columns.keys().map(|name| match name.as_str() {
        name if texts.contains(&name) => list(name, "binary element (UTF8)"),
        name if lists.contains(&name) => list(name, "double element"),
        name if numbers.contains(&name) => format!("optional double {name};"),
        "samples" => "optional int64 samples;".to_owned(),
        name => format!("optional binary {name} (UTF8);"),
    });
    let schema = format!("message schema {{ {} }}", fields.collect::<Vec<_>>().join(" "));
    let schema = Arc::new(parse_message_type(&schema).expect("a schema"));
    let file = std::fs::File::create(path).expect("made");
    let mut file =
        SerializedFileWriter::new(file, schema, Arc::new(WriterProperties::default())).expect("begun");
    let mut group = file.next_row_group().expect("begun");
    for name in columns.keys() {
        let entries: Vec<Value> = rows.iter().map(|row| row[name].clone()).collect();
        column(&mut group, &entries, texts.contains(&name.as_str()) || lists.contains(&name.as_str()));
    }
    group.close().expect("written");
    file.close().expect("written");
}

/// How much of an entry is there (of a list its elements, itself, or nothing), whether it goes on in the same row, and the value.
fn levels(entry: &Value) -> Vec<(i16, i16, Option<Value>)> {
    let of_element = |(k, element): (usize, &Value)| match element {
        Value::Null => (2, i16::from(k > 0), None),
        value => (3, i16::from(k > 0), Some(value.clone())),
    };
    match entry {
        Value::Null => vec![(0, 0, None)],
        Value::Array(elements) if elements.is_empty() => vec![(1, 0, None)],
        Value::Array(elements) => elements.iter().enumerate().map(of_element).collect(),
        value => vec![(1, 0, Some(value.clone()))],
    }
}

/// Writes the next column.
fn column(group: &mut SerializedRowGroupWriter<'_, std::fs::File>, entries: &[Value], is_list: bool) {
    let mut writer = group.next_column().expect("begun").expect("there");
    let entries: Vec<_> = entries.iter().flat_map(levels).collect();
    let there: Vec<i16> = entries.iter().map(|(there, ..)| *there).collect();
    let repeated: Vec<i16> = entries.iter().map(|(_, repeated, _)| *repeated).collect();
    let repeated = is_list.then_some(repeated.as_slice());
    let values = entries.into_iter().filter_map(|(.., value)| value);
    match writer.untyped() {
        ColumnWriter::DoubleColumnWriter(_) => {
            let values: Vec<f64> = values.map(|value| value.as_f64().expect("a number")).collect();
            writer.typed::<DoubleType>().write_batch(&values, Some(&there), repeated)
        }
        ColumnWriter::Int64ColumnWriter(_) => {
            let values: Vec<i64> = values.map(|value| value.as_i64().expect("whole")).collect();
            writer.typed::<Int64Type>().write_batch(&values, Some(&there), repeated)
        }
        _ => {
            let values: Vec<_> =
                values.map(|value| ByteArray::from(value.as_str().expect("a text"))).collect();
            writer.typed::<ByteArrayType>().write_batch(&values, Some(&there), repeated)
        }
    }
    .expect("written");
    writer.close().expect("written");
}

fn folder() -> (tempfile::TempDir, PathBuf) {
    let (directory, _) = place();
    let folder = directory.path().join("set");
    std::fs::create_dir(&folder).expect("made");
    (directory, folder)
}

#[test]
fn a_row_gives_its_record_back() {
    let text = text("A", "a");
    let row = DatasetRow::parse(&text).expect("a calibration");
    assert_eq!(row.covariance.as_deref(), Some(&[4e-4, 1e-5, 1e-4][..]), "the lower triangle by rows");
    assert_eq!((row.values.as_slice(), row.chi2, row.samples), (&[-0.3, 1.25][..], Some(7.5), Some(9)));
    let as_json: DatasetRow = serde_json::from_value(json!(row)).expect("read");
    let expected = Record::parse(&text).expect("a calibration");
    assert_eq!(as_json.into_record().expect("a record"), expected);
    assert!(expected.imu.degrees_of_freedom.expect("there").gyroscope_at_rest.is_infinite());
    assert_eq!(row.shared_root.as_deref(), Some(&[0.0, 1e-3, 2e-3, 4e-3][..]), "by rows");
    assert_eq!(expected.imu.shared.expect("there").root[(1, 0)], 2e-3);
}

#[test]
fn shared_errors_of_a_row_fit_or_are_not_there() {
    let row = json!(DatasetRow::parse(&text("A", "a")).expect("a calibration"));
    let without = |names: &[&str]| {
        let mut row = row.clone();
        names.iter().for_each(|name| drop(row.as_object_mut().expect("an object").remove(*name)));
        serde_json::from_value::<DatasetRow>(row).expect("read").into_record()
    };
    // as data sets of earlier versions
    assert_eq!(without(&["shared_sources", "shared_root"]).expect("a record").imu.shared, None);
    let error = without(&["shared_sources"]).expect_err("refused");
    assert!(error.to_string().contains("`shared_root` does not fit"), "{error}");
}

#[test]
fn a_data_set_is_taken_up_once() {
    let (directory, folder) = folder();
    write(&folder.join("part-1.parquet"), &[row("A", "a"), without("line/none.csv"), row("B", "b")]);
    write(&folder.join("part-2.parquet"), &[row("C", "c")]);
    std::fs::write(folder.join(".part-3.ab.tmp"), "unfinished").expect("written");
    let mut records = Records::open(&directory.path().join("r.db")).expect("made");
    for (new, replaced) in [(3, 0), (0, 3)] {
        let imported = records.import(&DataSet::read(&folder).expect("read")).expect("imported");
        assert_eq!(imported, Imported { new, replaced, without_calibration: 1, copies: Vec::new() });
    }
    let kept = records.get(2).expect("read").expect("there");
    assert_eq!(kept.record, Record::parse(&text("B", "b")).expect("a calibration"));
    // a part is a data set, too
    let one = DataSet::read(&folder.join("part-2.parquet")).expect("read");
    assert_eq!(records.import(&one).expect("imported").replaced, 1);
}

#[test]
fn copies_under_several_names_are_left_out() {
    let (directory, folder) = folder();
    write(&folder.join("part-1.parquet"), &[row("A", "a"), row("B", "b")]);
    write(&folder.join("part-2.parquet"), &[row("C", "a"), row("D", "a")]);
    let mut records = Records::open(&directory.path().join("r.db")).expect("made");
    let imported = records.import(&DataSet::read(&folder).expect("read")).expect("imported");
    let copies = ["A", "C", "D"].map(|sensor| format!("line/{sensor}.csv")).to_vec();
    assert_eq!((imported.new, imported.copies), (1, vec![copies]));
    // a recording that the records have of another sensor is refused
    let (_other, folder) = self::folder();
    write(&folder.join("part-1.parquet"), &[row("E", "b")]);
    let error = records.import(&DataSet::read(&folder).expect("read")).expect_err("refused");
    assert_eq!((error.code(), records.count().expect("read")), (Refusal::RecordingRepeated, 1));
}

#[test]
fn what_is_no_data_set_is_named() {
    let (_directory, folder) = folder();
    let refused = |path: &Path| DataSet::read(path).expect_err("refused").to_string();
    assert!(
        refused(&folder).contains("set: there is no file of Parquet in this folder"),
        "{}",
        refused(&folder)
    );
    assert!(refused(&folder.join("none")).contains("none: cannot read the data set"));
    let part = folder.join("part-1.parquet");
    let fails = |change: &dyn Fn(&mut Value), says: &str| {
        let mut changed = row("B", "b");
        change(&mut changed);
        write(&part, &[row("A", "a"), changed]);
        let message = refused(&folder);
        assert!(message.contains("part-1.parquet: row 2: ") && message.contains(says), "{message}");
    };
    fails(&|row| row["sensor"] = Value::Null, "invalid type: null, expected a string");
    fails(&|row| row["verdict"] = json!("fine"), "`fine` is none of `ok`, `doubtful`, `bad`");
    fails(&|row| row["model"] = json!("{}"), "`model` cannot be read");
    fails(&|row| row["names"] = json!(["x", "y"]), "accelerometer.bias.z is in `model` and not in `names`");
    fails(&|row| row["values"] = json!([1.0]), "2 `names` do not fit `values` and `covariance`");
    fails(&|row| row["covariance"] = json!([1.0, 2.0]), "2 `names` do not fit");
    // cut at each of many places
    write(&part, &[row("A", "a"), row("B", "b")]);
    let whole = std::fs::read(&part).expect("read");
    for length in (0..whole.len()).step_by(97) {
        std::fs::write(&part, &whole[..length]).expect("written");
        assert!(refused(&folder).contains("part-1.parquet: "), "{length}");
    }
}
