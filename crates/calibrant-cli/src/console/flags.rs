//! The options that messages of the library name, as flags of the command line.

use calibrant::error::TaskOption;

/// The text with flags in place of options: ``option `rate_hz` `` becomes `--rate-hz`.
pub(crate) fn as_flags(text: &str) -> String {
    let flag = |option: &TaskOption| format!("--{}", option.name().replace('_', "-"));
    TaskOption::ALL
        .iter()
        .fold(text.to_owned(), |text, option| text.replace(&option.to_string(), &flag(option)))
}
