//! `calibrant explain`: what a code means, how it is decided, and what to do.

use crate::console;
use crate::diagnostics::code_named;
use crate::exit::Exit;
use calibrant::diagnostic::Code;
use calibrant::error::Refusal;

/// Explain codes: what each means, how it is decided, and what to do. Without a code: list all.
///
/// A code stands in brackets behind a message, in the verdict, and in summary.csv.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The codes.
    #[arg(value_name = "CODE", value_parser = Explained::parse)]
    codes: Vec<Explained>,
}

/// A code of either kind.
#[derive(Clone, Copy)]
enum Explained {
    Diagnostic(Code),
    Refusal(Refusal),
}

impl crate::run::Run for Arguments {
    fn run(&self) -> calibrant::Result<Exit> {
        let texts: Vec<String> = match self.codes.as_slice() {
            [] => vec![list()],
            codes => codes.iter().map(|code| code.text()).collect(),
        };
        console::print_always(&texts.join("\n"));
        Ok(Exit::DONE)
    }
}

impl Explained {
    fn parse(name: &str) -> Result<Self, String> {
        match Refusal::ALL.iter().find(|refusal| refusal.name() == name) {
            Some(refusal) => Ok(Self::Refusal(*refusal)),
            None => code_named(name, Refusal::ALL.iter().map(|refusal| refusal.name())).map(Self::Diagnostic),
        }
    }

    /// Its name, with what follows from it; and what it means.
    fn head(self) -> (String, &'static str) {
        match self {
            Self::Diagnostic(code) => {
                (format!("{} ({})", code.name(), code.severity().name()), code.entry().meaning)
            }
            Self::Refusal(refusal) => (format!("{} (no result)", refusal.name()), refusal.meaning()),
        }
    }

    fn text(self) -> String {
        let (name, meaning) = self.head();
        let (decided, remedy) = match self {
            Self::Diagnostic(code) => (Some(code.entry().decided), code.entry().remedy),
            Self::Refusal(refusal) => (None, refusal.remedy()),
        };
        let decided = decided.map(|decided| format!("Decided: {decided}"));
        let lines = [Some(meaning.to_owned()), decided, Some(format!("What to do: {remedy}"))];
        format!("{name}\n")
            + &lines
                .iter()
                .flatten()
                .map(|line| console::paragraph(&console::as_flags(line)))
                .collect::<String>()
    }
}

/// All codes with their meanings, the diagnostics first.
fn list() -> String {
    let diagnostics = Code::all().map(Explained::Diagnostic);
    let line = |code: Explained| {
        let (name, meaning) = code.head();
        console::paragraph(&format!("{name}: {meaning}"))
    };
    diagnostics.chain(Refusal::ALL.iter().copied().map(Explained::Refusal)).map(line).collect()
}
