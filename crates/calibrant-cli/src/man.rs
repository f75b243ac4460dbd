//! `calibrant man`: the manual pages, one for each command.

use crate::console;
use crate::exit::Exit;
use calibrant::io::{ResultPlaces, write_atomically};
use clap::Command;
use clap_mangen::Man;
use std::path::PathBuf;

/// Write the manual pages: calibrant.1, and one for each command.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The directory, such as ~/.local/share/man/man1.
    #[arg(value_name = "DIR")]
    directory: PathBuf,
    /// The definition of the command line.
    #[arg(skip)]
    pub(crate) program: Box<Command>,
}

impl crate::run::Run for Arguments {
    fn places(&self) -> ResultPlaces {
        ResultPlaces {
            directory: Some(self.directory.clone()),
            results: self.pages().iter().map(|page| self.place(page)).collect(),
            ..ResultPlaces::default()
        }
    }

    fn run(&self) -> calibrant::Result<Exit> {
        let pages = self.pages();
        for page in &pages {
            let man = Man::new(page.clone()).source(calibrant::io::program());
            write_atomically(&self.place(page), |out| man.render(out))?;
        }
        console::print(&format!(
            "{} pages: {}\n",
            pages.len(),
            console::name(&self.directory.join("calibrant.1"))
        ));
        Ok(Exit::DONE)
    }
}

impl Arguments {
    fn place(&self, page: &Command) -> PathBuf {
        self.directory.join(format!("{}.1", title(page)))
    }

    /// The commands that have a page: the program, and each of its commands.
    fn pages(&self) -> Vec<Command> {
        let mut program = self.program.as_ref().clone().disable_help_subcommand(true);
        program.build();
        let mut pages = vec![program];
        let mut next = 0;
        while let Some(page) = pages.get(next) {
            let further: Vec<Command> = page.get_subcommands().cloned().collect();
            pages.extend(further);
            next += 1;
        }
        pages
    }
}

/// The name of a page: `calibrant`, or that of a command, such as `calibrant-design`.
fn title(page: &Command) -> &str {
    page.get_display_name().unwrap_or_else(|| page.get_name())
}
