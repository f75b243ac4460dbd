//! A production line: many sensors in one call, and ten of them wrong in ten ways.

use crate::bench::Bench;
use std::collections::BTreeMap;

const SENSORS: usize = 20;

/// A recording: its first lines, and the numbers of each row.
struct Rows {
    head: String,
    rows: Vec<Vec<f64>>,
}

impl Rows {
    fn of(text: &str) -> Self {
        let number = |line: &str| line.split(',').map(str::parse).collect::<Result<Vec<f64>, _>>().ok();
        let rows = text.lines().filter_map(number).collect();
        let head = text.lines().take_while(|line| number(line).is_none()).map(|line| line.to_owned() + "\n");
        Self { head: head.collect(), rows }
    }

    /// The recording with each reading replaced by `of(row, axis, reading)`.
    fn with(&self, of: impl Fn(usize, usize, f64) -> f64) -> String {
        let changed = |(k, row): (usize, &Vec<f64>)| {
            let cells = row.iter().enumerate();
            let cell =
                |(column, &value): (usize, &f64)| if column == 0 { value } else { of(k, column - 1, value) };
            cells.map(cell).map(|value| value.to_string()).collect::<Vec<_>>().join(",") + "\n"
        };
        self.head.clone() + &self.rows.iter().enumerate().map(changed).collect::<String>()
    }

    fn shortened(&self, share: f64) -> String {
        let length = (share * self.rows.len() as f64) as usize;
        Self { head: self.head.clone(), rows: self.rows[..length].to_vec() }.with(|_, _, value| value)
    }
}

/// A bench with the recordings `s01.csv` to `s20.csv`, ten of which are wrong.
fn line() -> (Bench, BTreeMap<&'static str, (&'static str, &'static str)>) {
    let bench = Bench::new();
    bench.preset("report", "line.toml", &[]);
    bench.run("simulate line.toml -o made").done();
    std::fs::copy(bench.path("made/motion.csv"), bench.path("motion.csv")).expect("copied");
    for sensor in 1..=SENSORS {
        bench.run(&format!("simulate line.toml --motion motion.csv --seed {sensor} -o made")).done();
        bench.write(&format!("s{sensor:02}.csv"), bench.read("made/recording.csv"));
    }
    let rows = |name: &str| Rows::of(&bench.read(&format!("{name}.csv")));
    let mut wrong = BTreeMap::new();
    let mut spoil = |name: &'static str, text: String, verdict, code| {
        bench.write(&format!("{name}.csv"), text);
        wrong.insert(name, (verdict, code));
    };
    let reversed = rows("s02").with(|_, axis, value| if axis == 1 { -value } else { value });
    spoil("s02", reversed, "bad", "scale-negative");
    spoil("s04", rows("s04").with(|_, _, value| value / 9.806_65), "bad", "gain-implausible");
    spoil("s05", rows("s05").with(|_, _, value| 1.05 * value), "bad", "parameter-implausible");
    let loose = rows("s07").with(|k, axis, value| if (k, axis) == (60, 0) { value + 55.0 } else { value });
    spoil("s07", loose, "doubtful", "spikes");
    bench.run("simulate line.toml --seed 99 -o other").done();
    spoil("s08", bench.read("other/recording.csv"), "bad", "model-contradicted");
    spoil("s10", rows("s10").shortened(0.4), "doubtful", "motion-not-recorded");
    let of_axis = |axis: usize| rows("s11").rows.iter().map(|row| row[axis + 1].abs()).fold(0.0, f64::max);
    let most = [0, 1, 2].map(|axis| 0.6 * of_axis(axis));
    let saturated = rows("s11").with(|_, axis, value| value.clamp(-most[axis], most[axis]));
    spoil("s11", saturated, "bad", "model-contradicted");
    spoil("s13", bench.read("s12.csv"), "none", "recording-repeated");
    wrong_sensor(&bench, &rows("s16"));
    spoil("s16", bench.read("s16.csv"), "bad", "model-contradicted");
    spoil("s18", bench.read("s18.csv")[..2000].to_owned() + "\n,,,\0\n", "none", "encoding-unknown");
    wrong.insert("s12", ("none", "recording-repeated"));
    (bench, wrong)
}

/// A sensor of another kind, whose readings jump between two levels.
fn wrong_sensor(bench: &Bench, rows: &Rows) {
    let noisy = rows.with(|k, axis, value| value + if (k * 7 + axis * 3) % 5 < 2 { 0.2 } else { -0.13 });
    bench.write("s16.csv", noisy);
}

#[test]
fn each_of_ten_faults_is_named_and_an_interrupted_batch_ends_the_same() {
    let (bench, wrong) = line();
    let all: Vec<String> = (1..=SENSORS).map(|sensor| format!("s{sensor:02}.csv")).collect();
    let command = format!("calibrate line.toml --motion motion.csv {}", all.join(" "));
    let outcome = bench.run(&format!("{command} -o results")).ends_with(5);
    outcome.says("s04: the gain of the accelerometer's axis x is 0.10");
    outcome.says("Readings in g have a gain of 0.102.");
    let (summary, page) = (bench.read("results/summary.csv"), bench.read("results/batch.html"));
    let list = page.split("Sensors that are not ok").nth(2).and_then(|of| of.split("</table>").next());
    let list = list.expect("a table");
    for name in all.iter().map(|file| file.trim_end_matches(".csv")) {
        let row = summary.lines().find(|line| line.starts_with(&format!("{name},"))).expect("a row");
        let (verdict, code) = wrong.get(name).copied().unwrap_or(("ok", ""));
        assert_eq!(row.split(',').nth(2), Some(verdict), "{row}");
        assert!(row.contains(code), "{row}");
        assert_eq!(list.contains(&format!("{name}<")), wrong.contains_key(name), "{name}: {list}");
    }

    // half of the batch, and then all of it
    bench
        .run(&format!("calibrate line.toml --motion motion.csv {} -o halves", all[..10].join(" ")))
        .ends_with(5);
    let outcome = bench.run(&format!("{command} -o halves --resume")).ends_with(5);
    outcome.says("10 of 20 recordings were calibrated before");
    assert_eq!(bench.read("halves/summary.csv"), summary);
    assert_eq!(bench.read("halves/batch.html"), page);
}
