//! `radiosity completions` and `radiosity man`: what packagers and shells want.

use super::error::Code;
use super::solve::prepare;
use super::{CliError, say};
use crate::output::write_atomically;
use clap::{Args, Command};
use clap_complete::Shell;
use clap_mangen::Man;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(super) struct Completions {
    /// Which shell
    #[arg(value_enum)]
    shell: Shell,
}

#[derive(Debug, Args)]
pub(super) struct Pages {
    /// Folder for radiosity.1 and a page for each command; made if it is not there
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
}

/// Prints the completions of `command`.
pub(super) fn completions(arguments: &Completions, mut command: Command) -> Result<Code, CliError> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut command, "radiosity", &mut script);
    say::result(&script)?;
    Ok(Code::Success)
}

/// Writes the man pages of `command` and of what is below it.
pub(super) fn pages(arguments: &Pages, mut command: Command) -> Result<Code, CliError> {
    prepare(&arguments.output)?;
    command.build();
    let below: Vec<Command> = command.get_subcommands().cloned().collect();
    for page in std::iter::once(command).chain(below) {
        let name = page.get_display_name().unwrap_or("radiosity").to_owned();
        let path = arguments.output.join(format!("{name}.1"));
        let man = Man::new(page);
        write_atomically(&path, |out| man.render(out))?;
    }
    Ok(Code::Success)
}
