//! Tests of campaigns over temperature: design, simulation, calibration, exports.

use crate::bench::Bench;
use std::fmt::Write;

fn bench(edits: &[(&str, &str)]) -> Bench {
    let bench = Bench::new();
    bench.preset("campaign", "campaign.toml", edits);
    bench
}

/// The block of the reference cases.
const FACES: (&str, &str) = ("poses = \"corners\" ", "poses = \"faces\" ");

#[test]
fn a_campaign_has_a_timetable_a_bound_and_what_is_usual_beside_it() {
    let bench = bench(&[FACES]);
    let outcome = bench.run("design campaign.toml -o plan").done();
    for word in
        ["34 soaks in", "above the bound", "every 10 °C there and back", "from above", "plan/campaign.csv"]
    {
        assert!(outcome.printed().contains(word), "{word}\n{}", outcome.stdout);
    }
    let design = bench.json("plan/design.json");
    assert_eq!(design["kind"], "campaign");
    let number = |pointer: &str| design.pointer(pointer).and_then(|of| of.as_f64()).expect("a number");
    assert!(number("/certificate/lower_bound_anywhere") <= number("/certificate/lower_bound"));
    assert!(number("/certificate/lower_bound") <= number("/value"));
    let table = bench.read("plan/campaign.csv");
    assert!(table.starts_with("soak,temperature_c,direction,wait_min,blocks,begin_min,end_min\n"), "{table}");
    let last =
        table.lines().last().and_then(|row| row.rsplit(',').next()).and_then(|end| end.parse::<f64>().ok());
    assert!(last.expect("a time") <= 360.0);
    assert!(bench.read("plan/report.html").contains("Standard deviation over temperature"));
    // machine output is the file
    let json = bench.run("design campaign.toml --json -o again").done();
    assert_eq!(json.stdout.trim_end(), bench.read("plan/design.json").trim_end());
}

/// Time for one soak or two, and a room outside the range.
#[test]
fn short_campaigns_and_other_rooms_fit_their_time() {
    for edits in [
        [FACES, ("budget_min = 360.0", "budget_min = 83.0"), ("# cycles = 1 ", "cycles = 1 ")],
        [FACES, ("budget_min = 360.0", "budget_min = 88.0"), ("# cycles = 1 ", "cycles = 1 ")],
        [FACES, ("range_c = [-20.0, 60.0]", "range_c = [40.0, 90.0]"), ("# cycles = 1 ", "cycles = 3 ")],
    ] {
        let bench = bench(&edits);
        bench.run("design campaign.toml -o plan").done();
        let table = bench.read("plan/campaign.csv");
        let last: Vec<f64> =
            table.lines().last().expect("a soak").split(',').filter_map(|of| of.parse().ok()).collect();
        let [.., temperature_c, _, _, _, end_min] = last[..] else { panic!("{table}") };
        let budget_min = bench
            .read("campaign.toml")
            .lines()
            .find_map(|line| line.strip_prefix("budget_min = ")?.split(' ').next()?.parse::<f64>().ok());
        // and home again
        let home_min = end_min + (temperature_c - 25.0).abs() / 2.0;
        assert!(home_min <= budget_min.expect("there") + 1e-6, "{home_min}: {table}");
    }
}

#[test]
fn what_cannot_be_designed_is_refused_with_what_to_do() {
    for (edit, status, says) in [
        (("budget_min = 360.0", "budget_min = 80.0"), 4, "give at least 82 min"),
        (("range_c = [-20.0, 60.0]", "range_c = [60.0, -20.0]"), 2, "range_c = [-20.0, 60.0]"),
        (("ramp_k_per_min = 2.0 ", "ramp_k_per_min = 0.0 "), 2, "above 0 K/min"),
        (("# spacing_c = 5.0 ", "spacing_c = 100.0 "), 2, "give a smaller spacing"),
        (("# criterion = \"I\"", "criterion = \"c\"\n# "), 2, "at_c = 25.0"),
        (("# at_c = 25.0 ", "at_c = 125.0 "), 2, "within range_c"),
    ] {
        bench(&[FACES, edit]).refuses("design campaign.toml -o plan", status, &[says]);
    }
    bench(&[]).refuses(
        "design campaign.toml --sweep duration=5,10 -o plan",
        2,
        &["--sweep budget=120,240,480"],
    );
}

/// Poses of a file: those of a cube's faces are the same block, and others are refused with what they leave open.
#[test]
fn a_block_may_be_poses_of_a_file() {
    let from_file = bench(&[("poses = \"corners\" ", "poses = \"own.csv\" "), SHORT[0], SHORT[1]]);
    let rows = |of: &[&str]| format!("pose,up_x,up_y,up_z\n{}\n", of.join("\n"));
    let faces = ["1,0,0,1", "2,0,0,-1", "3,0,2,0", "4,0,-1,0", "5,1,0,0", "6,-1,0,0"];
    // beside the experiment file, wherever the command runs
    from_file.write("own.csv", rows(&faces));
    from_file.run("design campaign.toml -o plan").done();
    let of_cube = bench(&[FACES, SHORT[0], SHORT[1]]);
    of_cube.run("design campaign.toml -o plan").done();
    assert_eq!(from_file.read("plan/campaign.csv"), of_cube.read("plan/campaign.csv"));
    from_file.write("one.csv", "soak,temperature_c,direction,wait_min,blocks\n1,20.0,up,10.0,1\n");
    from_file.run("simulate campaign.toml --campaign one.csv -o sim").done();
    // six holds of 10 s and the moves between them
    let seconds = from_file.read("sim/soak_01.csv").lines().count() as f64 / 100.0;
    assert!((80.0..125.0).contains(&seconds), "{seconds}");
    from_file.write("own.csv", rows(&faces[2..]));
    let says = ["accelerometer.bias.z, accelerometer.scale.z", "hold more orientations"];
    from_file.refuses("design campaign.toml -o other", 2, &says);
    from_file.write("own.csv", "pose,up_x,up_y\n1,0,0\n");
    from_file.refuses("design campaign.toml -o other", 2, &["own.csv", "there is no column `up_z`"]);
}

/// Short holds: a campaign that a test can simulate.
const SHORT: [(&str, &str); 5] = [
    ("budget_min = 360.0", "budget_min = 110.0"),
    ("range_c = [-20.0, 60.0]", "range_c = [0.0, 40.0]"),
    ("# hold_s = 10.0 ", "hold_s = 2.5 "),
    ("# move_s = 5.0 ", "move_s = 1.5 "),
    ("# rate_hz = 100.0 ", "rate_hz = 50.0 "),
];

/// The recording with another bias of the accelerometer's y axis.
fn with_bias(text: &str, bias_mps2: f64) -> String {
    let moved = |line: &str| {
        let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
        if let Ok(value) = cells[2].parse::<f64>() {
            cells[2] = (value + bias_mps2).to_string();
        }
        cells.join(",")
    };
    text.lines().map(moved).collect::<Vec<_>>().join("\n")
}

/// Design, simulation, one calibration over all soaks, and its exports.
/// The truth lies within the stated standard deviations.
fn finds_the_truth(bench: &Bench, truth: &str, result: &str) {
    let compared = bench.run(&format!("compare {truth} {result}/calibration.json --json")).json();
    let off = compared["quantities"].as_array().expect("a list").iter();
    let off: Vec<f64> = off.filter_map(|of| of["difference_in_sd"].as_f64()).collect();
    assert!(off.len() > 20 && off.iter().all(|off| off.abs() < 4.5), "{off:?}");
}

/// Six faces determine no angle between axes; two soaks with corners do, and the others count with what they measured.
#[test]
fn soaks_on_six_faces_are_fitted_together_with_those_that_determine_all() {
    let bench = bench(&SHORT);
    bench.run("design campaign.toml -o plan").done();
    bench.preset("campaign", "faces.toml", &[&SHORT[..], &[FACES]].concat());
    bench.run("simulate campaign.toml --campaign plan/campaign.csv --seed 3 -o all").done();
    bench.run("simulate faces.toml --campaign plan/campaign.csv --seed 3 -o faces").done();
    let soaks = bench.read("plan/campaign.csv").lines().count() - 1;
    let of = |soak: usize| if soak == 2 || soak == soaks { "all" } else { "faces" };
    let recordings: Vec<String> =
        (1..=soaks).map(|soak| format!("{}/soak_{soak:02}.csv", of(soak))).collect();
    let run = |file: &str, recordings: &[String], output: &str| {
        bench.run(&format!("calibrate {file} {} --no-report -o {output}", recordings.join(" ")))
    };
    let outcome = run("faces.toml", &recordings, "result").done();
    assert!(outcome.stderr.contains("[soaks-together]"), "{}", outcome.stderr);
    let found = bench.json("result/calibration.json");
    assert_eq!(found["soaks"].as_array().map(Vec::len), Some(soaks));
    finds_the_truth(&bench, "all/truth.json", "result");
    // their own files say on what they rest, so that nothing counts twice
    let files: Vec<String> =
        (1..=soaks).map(|soak| format!("result/soak_{soak:02}/calibration.json")).collect();
    run("faces.toml", &files, "again").done();
    assert_eq!(bench.json("again/calibration.json")["covariance"], found["covariance"]);
    // without one that determines all, nothing says the angles
    let faces: Vec<String> = (1..=soaks).map(|soak| format!("faces/soak_{soak:02}.csv")).collect();
    let refused = run("faces.toml", &faces, "none");
    assert!(refused.stderr.matches("[not-identifiable]").count() == 1, "{}", refused.stderr);
}

/// A published gyroscope changes by 8.5 mrad/s in each kelvin, ten times the spread of its kind: within a soak that is no scatter of its holds.
#[test]
fn a_sensor_far_steeper_than_usual_is_calibrated_by_its_own_slopes() {
    let bench = bench(&SHORT);
    // over this range; what is not stated is scaled to it
    let steep = [
        (
            "# \"accelerometer.bias\" = { spread = [0.07, 0.03, 0.02], beyond_sd = [0.008, 0.004],",
            "\"accelerometer.bias\" = { spread = [0.25, 7e-3, 2e-3], beyond_sd = [5e-4, 1e-4],",
        ),
        (
            "# \"gyroscope.bias\" = { spread = [6e-3, 2e-3, 1.5e-3], beyond_sd = [6e-4, 3e-4],",
            "\"gyroscope.bias\" = { spread = [0.1, 5e-4, 2e-4], beyond_sd = [4e-5, 1e-5],",
        ),
    ];
    bench.preset("campaign", "steep.toml", &[&SHORT[..], &steep].concat());
    bench.run("design campaign.toml -o plan").done();
    bench.run("simulate steep.toml --campaign plan/campaign.csv --seed 3 -o sim").done();
    let soaks = bench.read("plan/campaign.csv").lines().count() - 1;
    let recordings: Vec<String> = (1..=soaks).map(|soak| format!("sim/soak_{soak:02}.csv")).collect();
    bench.run(&format!("calibrate campaign.toml {} --no-report -o result", recordings.join(" "))).done();
    for soak in 1..=soaks {
        let found = bench.json(&format!("result/soak_{soak:02}/calibration.json"));
        let scatter = found["still_gyroscope"]["between_holds_sd_radps"][0].as_f64().expect("there");
        assert!(scatter < 5e-4, "{soak}: {scatter}");
    }
    finds_the_truth(&bench, "sim/truth.json", "result");
}

/// A ramp up and one down: a block of six faces every 4 K, in one recording, or in one each.
#[test]
fn a_ramp_in_several_poses_is_cut_into_soaks() {
    let of_axes =
        ("model = \"full\"               # bias, scale factors and n", "model = \"scale-bias\" # n");
    let bench = bench(&[
        FACES,
        of_axes,
        ("model = \"full\"               # bias, scale factors, m", "model = \"scale-bias\" # m"),
    ]);
    let mut plan = "soak,temperature_c,direction,wait_min,blocks,begin_min,end_min\n".to_owned();
    let up = (0..21).map(|k| (-20 + 4 * k, "up"));
    let down = (0..20).map(|k| (56 - 4 * k, "down"));
    for (k, (temperature_c, direction)) in up.chain(down).enumerate() {
        let begin_min = 2.0 + 3.5 * k as f64;
        writeln!(plan, "{},{temperature_c},{direction},0,1,{begin_min},{}", k + 1, begin_min + 1.5)
            .expect("written");
    }
    bench.write("ramp.csv", &plan);
    bench.run("simulate campaign.toml --campaign ramp.csv --seed 3 -o blocks").done();
    let joined = |name: &str, blocks: std::ops::RangeInclusive<usize>| {
        let mut all = String::new();
        for (k, block) in blocks.enumerate() {
            let text = bench.read(&format!("blocks/soak_{block:02}.csv"));
            let (header, rows) = text.split_once('\n').expect("a header");
            if k == 0 {
                writeln!(all, "{header}").expect("written");
            }
            for row in rows.lines() {
                let (time, rest) = row.split_once(',').expect("a time");
                let time_s = time.parse::<f64>().expect("a time") + 150.0 * k as f64;
                writeln!(all, "{time_s:.2},{rest}").expect("written");
            }
        }
        bench.write(name, &all);
    };
    joined("up.csv", 1..=21);
    joined("down.csv", 22..=41);
    joined("both.csv", 1..=41);
    for (recordings, cuts) in [("up.csv down.csv", 2), ("both.csv", 1)] {
        let outcome =
            bench.run(&format!("calibrate campaign.toml {recordings} --no-report -o result")).done();
        assert_eq!(outcome.stderr.matches("[ramp-cut]").count(), cuts, "{}", outcome.stderr);
        let found = bench.json("result/calibration.json");
        assert!(found["soaks"].as_array().is_some_and(|soaks| soaks.len() > 24), "{}", found["soaks"]);
        finds_the_truth(&bench, "blocks/truth.json", "result");
    }
}

#[test]
fn a_campaign_is_rehearsed_from_its_design_to_the_firmware() {
    let bench = bench(&SHORT);
    bench.run("design campaign.toml -o plan").done();
    bench.run("simulate campaign.toml --campaign plan/campaign.csv --seed 3 -o sim").done();
    let soaks = bench.read("plan/campaign.csv").lines().count() - 1;
    let recordings: Vec<String> = (1..=soaks).map(|soak| format!("sim/soak_{soak:02}.csv")).collect();
    let outcome = bench.run(&format!("calibrate campaign.toml {} -o result", recordings.join(" "))).done();
    assert!(
        outcome.printed().contains("Over temperature") && outcome.printed().contains("soak_01"),
        "{outcome:?}"
    );
    let found = bench.json("result/calibration.json");
    assert_eq!(found["kind"], "campaign-calibration");
    assert_eq!(found["soaks"].as_array().map(Vec::len), Some(soaks));
    finds_the_truth(&bench, "sim/truth.json", "result");
    // from the calibrations of the soaks, the same
    let files: Vec<String> =
        (1..=soaks).map(|soak| format!("result/soak_{soak:02}/calibration.json")).collect();
    bench.run(&format!("calibrate campaign.toml {} --no-report -o again", files.join(" "))).done();
    let again = bench.json("again/calibration.json");
    assert_eq!(again["covariance"], found["covariance"]);
    assert_eq!(again["parameters"], found["parameters"]);
    // one soak is held out: its errors are as predicted, and those of a sensor that has changed are not
    let others = recordings[..soaks - 1].join(" ");
    let held_out = |file: &str| {
        let arguments =
            format!("calibrate campaign.toml {others} --validate {file} --no-report --json -o held");
        let kinds = bench.run(&arguments).json()["validations"][0].clone();
        ["magnitude", "rate", "rotation"]
            .map(|kind| kinds[kind]["factor_interval_99"][0].as_f64().expect("judged"))
    };
    let last = recordings[soaks - 1].as_str();
    assert!(held_out(last).iter().all(|low| *low < 1.0));
    bench.write("changed.csv", with_bias(&bench.read(last), 0.05));
    assert!(held_out("changed.csv")[0] > 1.0);
    bench.refuses(
        &format!("calibrate campaign.toml {} --validate {last} -o held", recordings.join(" ")),
        2,
        &["is among the soaks", "leave it out of the soaks"],
    );
    // what to add
    bench.run("design campaign.toml --from result/calibration.json --add-min 60 -o more").done();
    let value = |file: &str, pointer: &str| {
        bench.json(file).pointer(pointer).and_then(|of| of.as_f64()).expect("there")
    };
    assert!(value("more/design.json", "/value") < value("plan/design.json", "/value"));
    bench.run("design campaign.toml --sweep budget=90,150 -o sweep").done();
    assert!(
        value("sweep/sweep.json", "/campaigns/1/value") < value("sweep/sweep.json", "/campaigns/0/value")
    );
    // how well it does beside what is usual
    let study = bench.run("study campaign.toml --sensors 4 -o study").done();
    assert!(
        study.printed().contains("this campaign") && study.printed().contains("coverage"),
        "{}",
        study.stdout
    );
    let coverage = value("study/study.json", "/campaigns/0/quantities/0/coverage");
    assert!((0.6..=1.0).contains(&coverage), "{coverage}");
    // the firmware
    bench.run("convert result/calibration.json imu.h").done();
    assert!(bench.read("imu.h").contains("calibrant_accelerometer_bias_per_k3[3]"));
    bench
        .run("convert result/calibration.json imu.params --drop cross-axis,gyroscope-matrix,gain-temperature")
        .done();
    assert!(bench.read("imu.params").contains("TC_A0_X3_2"));
    let printed = bench.run("convert result/calibration.json table.csv --table 5").done();
    assert!(printed.printed().contains("lines between the rows err by up to"), "{}", printed.stdout);
    let table = bench.read("table.csv");
    let rows: Vec<&str> = table.lines().filter(|line| !line.starts_with('#')).collect();
    assert!(rows[0].starts_with("temperature_c,accelerometer.bias.x_mps2,"), "{table}");
    assert_eq!(rows.len(), 10);
    bench.run("convert result/calibration.json table.h --table 5").done();
    assert!(bench.read("table.h").contains("#define CALIBRANT_TABLE_ROWS 9"));
    // one soak is no campaign, and soaks without a temperature are none
    bench.refuses(
        &format!("calibrate campaign.toml {} {} -o one", files[0], files[1]),
        4,
        &["lower the orders in [temperature] to 1"],
    );
}

/// An accelerometer alone: the loop of an IMU, without a gyroscope. Waits are short, so that its temperature changes within a soak.
#[test]
fn an_accelerometer_alone_goes_from_its_design_to_the_firmware() {
    let text = |bench: &Bench| bench.read("campaign.toml");
    let bench = bench(&[&SHORT[..], &[("kind = \"imu\" ", "kind = \"accelerometer\" ")]].concat());
    let whole = text(&bench);
    let [from, to] = ["\n[gyroscope]", "\n[holds]"].map(|section| whole.find(section).expect("there"));
    let alone = format!("{}{}", &whole[..from], &whole[to..]);
    bench.write("campaign.toml", format!("{alone}\n[temperature]\naccelerometer_bias = 2\n"));
    bench.run("design campaign.toml -o plan").done();
    let mut plan = "soak,temperature_c,direction,wait_min,blocks\n".to_owned();
    for (soak, (celsius, direction)) in
        [(20, "up"), (30, "up"), (40, "up"), (30, "down"), (15, "down"), (0, "down"), (10, "up")]
            .iter()
            .enumerate()
    {
        let _ = writeln!(plan, "{},{celsius},{direction},0,1", soak + 1);
    }
    bench.write("short.csv", plan);
    bench.run("simulate campaign.toml --campaign short.csv --seed 3 -o sim").done();
    assert!(bench.read("sim/soak_01.csv").starts_with("t_s,ax_mps2,ay_mps2,az_mps2,temp_c\n"));
    let recordings: Vec<String> = (1..=7).map(|soak| format!("sim/soak_{soak:02}.csv")).collect();
    bench.run(&format!("calibrate campaign.toml {} -o result", recordings.join(" "))).done();
    let found = bench.json("result/calibration.json");
    let names: Vec<_> =
        found["channels"].as_array().expect("a list").iter().map(|of| of["order"].clone()).collect();
    assert_eq!(names, [2, 2], "{found}");
    finds_the_truth(&bench, "sim/truth.json", "result");
    // its holds are taken to one temperature: what it changes by in a soak is no scatter of them
    let scatter = |soak: usize| {
        bench.json(&format!("result/soak_{soak:02}/calibration.json"))["holds"]["between_holds_sd_mps2"]
            .as_f64()
    };
    assert!((1..=7).all(|soak| scatter(soak).expect("there") < 1e-3), "{:?}", [1, 4, 7].map(scatter));
    // on six faces it leaves parameters open
    bench.write("faces.toml", text(&bench).replace("poses = \"corners\" ", "poses = \"faces\" "));
    bench.run("simulate faces.toml --campaign short.csv --seed 3 -o faces").done();
    let mixed = [1, 7].map(|soak| format!("sim/soak_{soak:02}.csv")).into_iter();
    let mixed: Vec<String> = mixed.chain((2..7).map(|soak| format!("faces/soak_{soak:02}.csv"))).collect();
    let outcome = bench.run(&format!("calibrate faces.toml {} --no-report -o mixed", mixed.join(" "))).done();
    assert!(outcome.stderr.contains("[soaks-together]"), "{}", outcome.stderr);
    assert_eq!(bench.json("mixed/calibration.json")["soaks"].as_array().map(Vec::len), Some(7));
    finds_the_truth(&bench, "sim/truth.json", "mixed");
    // another soak tries it, and one of a sensor that has changed
    let held_out = |file: &str| {
        let others = recordings[..6].join(" ");
        let arguments =
            format!("calibrate campaign.toml {others} --validate {file} --no-report --json -o held");
        bench.run(&arguments).json()["validations"][0]["magnitude"]["factor_interval_99"][0]
            .as_f64()
            .expect("judged")
    };
    assert!(held_out(&recordings[6]) < 1.0);
    bench.write("changed.csv", with_bias(&bench.read(&recordings[6]), 0.05));
    assert!(held_out("changed.csv") > 1.0);
    bench.run("study campaign.toml --sensors 4 -o study").done();
    bench.run("convert result/calibration.json accelerometer.h").done();
    assert!(bench.read("accelerometer.h").contains("calibrant_accelerometer_bias_per_k2[3]"));
    bench.run("convert result/calibration.json table.csv --table 5").done();
    let table = bench.read("table.csv");
    assert!(table.contains("accelerometer.bias.z_mps2") && !table.contains("gyroscope"), "{table}");
    bench.write("campaign.toml", text(&bench).replace("accelerometer_bias = 2", "gyroscope_bias = 2"));
    bench.refuses("design campaign.toml -o other", 2, &["temperature.gyroscope_bias", "take this key out"]);
}

/// A board that lies on its desk while it warms up: what autopilots record.
#[test]
fn a_warm_up_in_one_pose_gives_the_biases_over_temperature() {
    let bench = Bench::new();
    let orders = [
        ("# accelerometer_bias = 1", "accelerometer_bias = 2"),
        ("# gyroscope_bias = 1", "gyroscope_bias = 2"),
    ];
    bench.preset("imu", "imu.toml", &orders);
    let mut text = "t_s,ax_mps2,ay_mps2,az_mps2,gx_radps,gy_radps,gz_radps,temp_c\n".to_owned();
    let mut noise = 1_u64;
    let mut noise = |size: f64| {
        noise = noise.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        size * ((noise >> 33) as f64 / f64::from(u32::MAX >> 1) - 1.0)
    };
    for k in 0..30_000 {
        let time_s = f64::from(k) * 0.05;
        let celsius = 44.0 - 40.0 * (-time_s / 500.0).exp();
        let tau = celsius - 25.0;
        let bias = [2e-3 * tau, 1e-3 * tau - 5e-5 * tau * tau, 4e-3 * tau];
        let rate = [1e-4 * tau, 0.01 - 2e-4 * tau, 2e-6 * tau * tau];
        let _ = writeln!(
            text,
            "{time_s:.2},{:.6},{:.6},{:.6},{:.7},{:.7},{:.7},{celsius:.2}",
            0.2 + bias[0] + noise(0.03),
            -0.1 + bias[1] + noise(0.03),
            9.7 + bias[2] + noise(0.03),
            rate[0] + noise(2e-3),
            rate[1] + noise(2e-3),
            rate[2] + noise(2e-3)
        );
    }
    bench.write("warm.csv", text);
    let outcome = bench.run("calibrate imu.toml warm.csv -o result").done();
    outcome.says("what temperature does to the bias of z contains what it does to its gain");
    let found = bench.json("result/calibration.json");
    assert_eq!(found["with_gain"], "z");
    let parameter = |name: &str| {
        let all = found["parameters"].as_array().expect("a list");
        let of = all.iter().find(|of| of["name"] == name).unwrap_or_else(|| panic!("{name}"));
        [of["value"].as_f64().expect("a number"), of["sd"].as_f64().expect("a number")]
    };
    for (name, truth) in [
        ("accelerometer.bias_per_k.x", 2e-3),
        ("accelerometer.bias_per_k.z", 4e-3),
        ("accelerometer.bias_per_k2.y", -5e-5),
        ("gyroscope.bias.y", 0.01),
        ("gyroscope.bias_per_k.y", -2e-4),
        ("gyroscope.bias_per_k2.z", 2e-6),
    ] {
        let [value, sd] = parameter(name);
        assert!((value - truth).abs() < 4.0 * sd, "{name}: {value} ± {sd}, {truth}");
    }
    assert!(!bench.read("result/calibration.json").contains("\"accelerometer.bias.x\""));
    // PX4 takes the polynomial alone, and keeps its own offset
    bench.run("convert result/calibration.json imu.params --drop gain-temperature").done();
    let params = bench.read("imu.params");
    assert!(params.contains("TC_A0_X1_0") && !params.contains("CAL_ACC0_XOFF"), "{params}");
}
