//! `calibrant schema`: the JSON Schema of a file.

use crate::{Exit, console};
use calibrant::FileKind;
use calibrant::io::to_json;
use clap::builder::PossibleValuesParser;

/// Print the JSON Schema of a kind of file. Without a kind: list them.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The kind of file.
    #[arg(value_name = "KIND", value_parser = PossibleValuesParser::new(FileKind::ALL.iter().map(|kind| kind.name)))]
    kind: Option<String>,
}

impl crate::run::Run for Arguments {
    fn run(&self) -> calibrant::Result<Exit> {
        match self.kind.as_deref().and_then(FileKind::named) {
            Some(kind) => console::print_always(&to_json(&kind.schema())),
            None => {
                let rows = FileKind::ALL.iter().map(|kind| format!("{:18}{}\n", kind.name, kind.file));
                console::print_always(&rows.collect::<String>());
            }
        }
        Ok(Exit::DONE)
    }
}
