//! `calibrant completions`: the script with which a shell completes commands, options and files.

use crate::console;
use crate::exit::Exit;
use clap_complete::Shell;

/// Print the completions for a shell.
///
/// For bash: calibrant completions bash > ~/.local/share/bash-completion/completions/calibrant
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The shell.
    shell: Shell,
    /// The definition of the command line.
    #[arg(skip)]
    pub(crate) program: Box<clap::Command>,
}

impl crate::run::Run for Arguments {
    fn run(&self) -> calibrant::Result<Exit> {
        let mut script = Vec::new();
        clap_complete::generate(self.shell, &mut (*self.program).clone(), "calibrant", &mut script);
        console::print_always(&String::from_utf8_lossy(&script));
        Ok(Exit::DONE)
    }
}
