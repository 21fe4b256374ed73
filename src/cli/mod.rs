//! The command line: one file a subcommand. The only user of clap, indicatif and ctrlc; may import everything public.

mod error;
mod examples;
mod export;
mod flags;
mod form_factors;
mod grid;
mod heat;
mod info;
mod memory;
mod meshes;
mod names;
mod pictures;
mod probe;
mod profile;
mod progress;
mod render;
mod results;
mod resume;
mod say;
mod session;
mod shell;
mod solve;
mod table;
mod values;
mod view;
mod viewpoint;
#[cfg(feature = "viewer")]
mod window;

use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};
use error::CliError;
pub use memory::{load_scene, peak_memory};
use std::ffi::OsString;
use std::process::ExitCode;

/// Progressive radiosity: the view-independent diffuse light of polygonal scenes.
#[derive(Debug, Parser)]
#[command(version, about, long_about = None, after_help = examples::ALL)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Solve a scene: writes the solution, a lit mesh, pictures and a report.
    #[command(after_long_help = examples::solve())]
    Solve(solve::Arguments),
    /// Go on with a solve: from a checkpoint, with stricter options, or with other emitters.
    #[command(after_help = examples::RESUME)]
    Resume(resume::Arguments),
    /// Draw pictures of a solution.
    #[command(after_help = examples::RENDER)]
    Render(render::Arguments),
    /// Walk through a solution in a window, and read its light.
    #[command(after_help = examples::VIEW)]
    View(view::Arguments),
    /// Read the light at points of a solution.
    #[command(after_help = examples::PROBE)]
    Probe(probe::Arguments),
    /// Write the lit mesh of a solution for another program: glTF, PLY, OBJ or VTK.
    #[command(after_help = examples::EXPORT)]
    Export(export::Arguments),
    /// Compute the form factors between all surfaces, with occlusion.
    #[command(after_help = examples::FORM_FACTORS)]
    FormFactors(form_factors::Arguments),
    /// Say what a scene holds, without solving it.
    #[command(after_help = examples::INFO)]
    Info(info::Arguments),
    /// Print a script that completes commands and flags in a shell.
    Completions(shell::Completions),
    /// Write man pages.
    Man(shell::Pages),
}

/// Runs the command line of this process.
pub fn main() -> ExitCode {
    run(std::env::args_os())
}

/// The same commands, but a negative number after a flag is its value: one that is not allowed is then said to be none of the flag's, rather
/// than to be an unknown flag.
fn understanding_numbers(command: clap::Command) -> clap::Command {
    let understanding = |arg: clap::Arg| {
        let is_flag_with_value = arg.get_action().takes_values() && !arg.is_positional();
        match is_flag_with_value {
            true => arg.allow_negative_numbers(true),
            false => arg,
        }
    };
    command.mut_subcommands(|subcommand| subcommand.mut_args(understanding))
}

/// Runs a command line, the name of the program first.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> ExitCode {
    let matches = understanding_numbers(Cli::command()).try_get_matches_from(arguments);
    let cli = match matches.and_then(|matches| Cli::from_arg_matches(&matches)) {
        Ok(cli) => cli,
        Err(error) => error.exit(),
    };
    let result = match cli.command {
        Command::Solve(arguments) => solve::run(&arguments),
        Command::Resume(arguments) => resume::run(&arguments),
        Command::Render(arguments) => render::run(&arguments),
        Command::View(arguments) => view::run(&arguments),
        Command::Probe(arguments) => probe::run(&arguments),
        Command::Export(arguments) => export::run(&arguments),
        Command::FormFactors(arguments) => form_factors::run(&arguments),
        Command::Info(arguments) => info::run(&arguments),
        Command::Completions(arguments) => shell::completions(&arguments, Cli::command()),
        Command::Man(arguments) => shell::pages(&arguments, Cli::command()),
    };
    match result {
        Ok(code) => code.into(),
        Err(error) => {
            say::error(&error.to_string());
            error.code().into()
        }
    }
}
