//! Tests of what is installed beside the program: completions and manual pages.

use crate::bench::Bench;

#[test]
fn each_shell_completes_every_command() {
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let script = Bench::new().run(&format!("completions {shell}")).done().stdout;
        for word in ["calibrate", "design", "no-certificate"] {
            assert!(script.contains(word), "{shell}: {word}");
        }
    }
    Bench::new().refuses("completions tcsh", 2, &["possible values: bash, elvish, fish, powershell, zsh"]);
}

#[test]
fn each_command_has_a_manual_page() {
    let bench = Bench::new();
    let help = bench.run("help").done().stdout;
    let commands = help.lines().skip_while(|line| *line != "Commands:").skip(1);
    let commands: Vec<&str> = commands
        .take_while(|line| !line.is_empty())
        .filter_map(|line| line.strip_prefix("  ")?.split(' ').next())
        .filter(|name| !name.is_empty() && *name != "help")
        .collect();
    assert!(commands.len() >= 12, "{help}");
    bench.run("man pages").done();
    assert!(bench.read("pages/calibrant.1").contains("Exit status"));
    for command in &commands {
        let page = bench.read(&format!("pages/calibrant-{command}.1"));
        assert!(page.contains(&format!(".SH NAME\ncalibrant\\-{command}")), "{command}\n{page}");
    }
    let of_records = ["add", "drift", "export", "fleet", "import", "list", "remove", "show"];
    for command in of_records {
        let page = bench.read(&format!("pages/calibrant-records-{command}.1"));
        assert!(page.contains(&format!("calibrant\\-records\\-{command}")), "{command}\n{page}");
    }
    let pages = commands.len() + of_records.len();
    assert_eq!(bench.files().len(), pages + 3, "a directory, its manifest, calibrant.1 and the commands");
    // pages of an earlier version are replaced, others' are not
    bench.run("man pages").done();
    bench.write("pages/calibrant.1", "mine");
    bench.refuses("man pages", 2, &["pages/calibrant.1: this file is there already", "--force"]);
}
