//! The options that messages of the library name, as arguments of Python.

use calibrant::error::{TaskOption, word_options_as};
use std::sync::Once;

static SET: Once = Once::new();

/// Words options as arguments from now on, unless the command line words them in this process.
pub(crate) fn set() {
    SET.call_once(|| {
        word_options_as(as_arguments);
        // a panic becomes an exception, and nothing is printed
        std::panic::set_hook(Box::new(|_| {}));
    });
}

/// The text with arguments in place of options: ``option `rate_hz` `` becomes `rate_hz=`.
fn as_arguments(text: &str) -> String {
    // one option of the command line, two arguments
    let text = text.replace("its format with option `from`", "its format with `format=`");
    let named = |text: String, option: &TaskOption| {
        text.replace(&option.to_string(), &format!("`{}=`", argument(*option)))
    };
    TaskOption::ALL.iter().fold(text, named)
}

/// The argument that says what an option says.
pub(crate) fn argument(option: TaskOption) -> &'static str {
    match option {
        TaskOption::Add => "poses",
        TaskOption::From => "known",
        TaskOption::Hold => "hold_s",
        TaskOption::Temperature => "temperature_c",
        TaskOption::ValidateMotion => "validate_log",
        option => option.name(),
    }
}
