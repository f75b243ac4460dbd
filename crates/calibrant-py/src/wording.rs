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
    let named = |text: String, option: &TaskOption| {
        text.replace(&option.to_string(), &format!("`{}=`", option.name()))
    };
    TaskOption::ALL.iter().fold(text.to_owned(), named)
}
