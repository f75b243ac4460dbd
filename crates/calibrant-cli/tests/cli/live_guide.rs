//! The live guide: a session is a recording, and its result is that of `calibrate`.

use crate::bench::Bench;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

fn guide(bench: &Bench, arguments: &str) -> Child {
    let mut command = Command::new(env!("CARGO_BIN_EXE_calibrant"));
    command.args(arguments.split_whitespace()).current_dir(bench.path(""));
    command
        .stdin(Stdio::piped())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program runs")
}

/// The result of a session is what `calibrate` makes of its recording, to the last byte.
fn is_that_of_calibrate(bench: &Bench, session: &str, experiment: &str) {
    bench.run(&format!("calibrate {experiment} {session}/recording.csv -o again"));
    for file in ["calibration.json", "report.html"] {
        let same = bench.read(&format!("{session}/{file}")) == bench.read(&format!("again/{file}"));
        assert!(same, "{file}");
    }
}

/// 20 holds of an IMU by hand.
fn recorded(bench: &Bench) -> Vec<String> {
    bench.preset("imu", "imu.toml", &[("# hold_s = 5.0", "hold_s = 4.0"), ("# poses = 24 ", "poses = 20 ")]);
    bench.run("simulate imu.toml -o made").done();
    bench.read("made/recording.csv").lines().map(str::to_owned).collect()
}

#[test]
fn the_demonstration_is_good_enough_within_two_dozen_holds() {
    let bench = Bench::new();
    bench.run("init imu -o imu.toml").done();
    let outcome = bench.run("guide imu.toml --from demo@10 --terminal --no-page --stop -o session").done();
    assert!(outcome.printed().contains("Good enough"), "{outcome:?}");
    let holds = outcome.stdout.matches("✓ Got it: ").count();
    assert!((11..24).contains(&holds), "{holds}: {}", outcome.stdout);
    assert!(outcome.stdout.lines().all(|line| line.chars().count() <= 80));
    is_that_of_calibrate(&bench, "session", "imu.toml");
    bench.refuses("guide --demo --no-page --terminal -o session", 2, &["recording.csv is there already"]);
}

#[test]
fn lines_from_standard_input_are_a_recording_whatever_stands_between_them() {
    let bench = Bench::new();
    let rows = recorded(&bench);
    let mut stream = "Hello, board 7\n".to_owned();
    for (number, row) in rows.iter().enumerate() {
        stream.push_str(row);
        stream.push('\n');
        if number % 500 == 499 {
            stream.push_str("0.5,1.0\n\u{fffd}\u{fffd}garbage;;\n");
        }
    }
    bench.write("stream.txt", stream);
    let outcome =
        bench.run_from("stream.txt", "guide imu.toml --from - --terminal --no-page -o session").done();
    assert_eq!(bench.read("session/recording.csv").lines().map(str::to_owned).collect::<Vec<_>>(), rows);
    is_that_of_calibrate(&bench, "session", "imu.toml");
    // as many holds as are found afterwards
    let found = bench.json("session/calibration.json")["holds"]["table"].as_array().map_or(0, Vec::len);
    let live = outcome.stdout.matches("✓ Got it: ").count();
    assert!(live.abs_diff(found) <= 1, "{live} of {found}\n{}", outcome.stdout);
}

#[cfg(unix)]
#[test]
fn what_was_recorded_survives_a_kill() {
    let bench = Bench::new();
    let rows = recorded(&bench);
    for (number, wait_ms) in [1500_u64, 2000, 2500].into_iter().enumerate() {
        let session = format!("session{number}");
        let mut child = guide(&bench, &format!("guide imu.toml --from - --no-page --terminal -o {session}"));
        let mut input = child.stdin.take().expect("piped");
        let begin = std::time::Instant::now();
        let mut sent = 0;
        // ten times as fast as it was recorded
        for block in rows.chunks(50) {
            let text = block.join("\n") + "\n";
            if input.write_all(text.as_bytes()).is_err() || begin.elapsed() > Duration::from_millis(wait_ms) {
                break;
            }
            sent += block.len();
            std::thread::sleep(Duration::from_millis(50));
        }
        child.kill().expect("it runs");
        child.wait().expect("ended");
        let kept = bench.read(&format!("{session}/recording.csv"));
        let whole = kept.rfind('\n').map_or("", |end| &kept[..end]).lines().count();
        // half a second is ten blocks; a machine that is busy may take as long again to come to it
        assert!(whole + 20 * 50 >= sent, "{whole} of {sent}");
        bench.write("nothing", "");
        bench.run_from(
            "nothing",
            &format!("guide imu.toml --from - --no-page --terminal --resume -o {session}"),
        );
        let kept: Vec<String> =
            bench.read(&format!("{session}/recording.csv")).lines().map(str::to_owned).collect();
        assert_eq!(kept, rows[..kept.len()], "a prefix of what was sent");
    }
}

#[test]
fn a_fixture_is_done_when_each_face_was_held() {
    let bench = Bench::new();
    bench.run("init faces -o faces.toml").done();
    let outcome = bench.run("guide faces.toml --from demo@10 --terminal --no-page --stop -o session").done();
    assert_eq!(outcome.stdout.matches("✓ Got it: ").count(), 6, "{}", outcome.stdout);
    assert!(outcome.printed().contains("5 of 6 faces so far"), "{}", outcome.stdout);
    is_that_of_calibrate(&bench, "session", "faces.toml");
    // the faces of an IMU are turned into each other about all axes
    let faces = "[holds]\ndirections = [\"x\", \"-x\", \"y\", \"-y\", \"z\", \"-z\"]\nface_sd_deg = 0.3";
    bench.preset("imu", "imu.toml", &[("[holds]", faces)]);
    let outcome = bench.run("guide imu.toml --from demo@20 --terminal --no-page --stop -o imu").done();
    let holds = outcome.stdout.matches("✓ Got it: ").count();
    assert!((8..=16).contains(&holds), "{holds}: {}", outcome.stdout);
    is_that_of_calibrate(&bench, "imu", "imu.toml");
    let times = "directions = [\"z\", \"-z\"]\nintervals_s = [[0, 3], [5, 8]]\n# was";
    bench.preset("faces", "timed.toml", &[("directions =", times)]);
    bench.refuses(
        "guide timed.toml --from demo --no-page --terminal -o other",
        2,
        &["remove holds.intervals_s"],
    );
}

/// The answer to a request.
fn answer(address: &str, request: &str) -> String {
    let mut stream = TcpStream::connect(address).expect("it listens");
    stream.set_read_timeout(Some(Duration::from_secs(5))).expect("set");
    stream.write_all(request.as_bytes()).expect("sent");
    let mut text = String::new();
    let _ = stream.read_to_string(&mut text);
    text
}

#[test]
fn the_page_acts_for_its_own_token_only() {
    let bench = Bench::new();
    bench.run("init imu -o imu.toml").done();
    let mut child = guide(&bench, "guide imu.toml --from demo@20 --listen 127.0.0.1:0 -o session");
    let mut lines = BufReader::new(child.stderr.take().expect("piped")).lines();
    let url =
        lines.find_map(|line| Some(line.ok()?.split_once("http://")?.1.to_owned())).expect("an address");
    let (address, token) = url.split_once("/?token=").expect("a token");
    let get = |path: &str, host: &str| {
        answer(address, &format!("GET {path} HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\r\n"))
    };
    let page = get("/", address);
    assert!(page.starts_with("HTTP/1.1 200") && page.contains("default-src 'none'"), "{page}");
    assert!(get("/", "evil.example:80").starts_with("HTTP/1.1 403"));
    let post_to = |action: &str, more: &str| {
        let head = format!(
            "POST /{action} HTTP/1.1\r\nHost: {address}\r\nContent-Length: 0\r\nConnection: close\r\n"
        );
        answer(address, &format!("{head}{more}\r\n"))
    };
    let post = |more: &str| post_to("finish", more);
    assert!(post("").starts_with("HTTP/1.1 403"), "no token");
    assert!(post("X-Token: 0123\r\n").starts_with("HTTP/1.1 403"), "a wrong token");
    let foreign = format!("X-Token: {token}\r\nOrigin: http://evil.example\r\n");
    assert!(post(&foreign).starts_with("HTTP/1.1 403"), "another site");
    assert!(child.try_wait().expect("there").is_none(), "it still runs");
    let own = format!("X-Token: {token}\r\nOrigin: http://{address}\r\n");
    // the last hold is taken back: its accelerometer is blank in the file
    let held = || bench.read("session/events.jsonl").contains("Got it");
    (0..100).take_while(|_| !held()).for_each(|_| std::thread::sleep(Duration::from_millis(100)));
    assert!(post_to("undo", &own).starts_with("HTTP/1.1 200"));
    std::thread::sleep(Duration::from_millis(300));
    assert!(post(&own).starts_with("HTTP/1.1 200"));
    child.wait().expect("it finishes");
    let recorded = bench.read("session/recording.csv");
    let blank = recorded.lines().filter(|line| line.contains(",,,")).count();
    assert!(blank > 200, "{blank} of {}", recorded.lines().count());
    assert!(bench.read("session/events.jsonl").contains("\"finish\""));
}

#[test]
fn inputs_that_are_not_there_say_what_to_do() {
    let bench = Bench::new();
    bench.preset("imu", "imu.toml", &[]);
    for (input, says) in [
        ("usb:3", "serial:/dev/ttyUSB0:115200"),
        ("serial:/dev/no-such-port:115200", "is the board plugged in"),
        ("replay:missing.csv", "missing.csv"),
        ("replay:x.csv@fast", "is no speed"),
    ] {
        let outcome = bench.run(&format!("guide imu.toml --from {input} --no-page --terminal -o session"));
        assert_eq!(outcome.status, if input == "replay:missing.csv" { 3 } else { 2 }, "{outcome:?}");
        outcome.says(says);
    }
    bench.preset("stage", "stage.toml", &[]);
    bench.refuses("guide stage.toml --demo -o session2", 2, &["held still", "calibrant init imu"]);
}
