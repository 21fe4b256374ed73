//! The command `radiosity`; see `radiosity --help`.

fn main() -> std::process::ExitCode {
    radiosity::cli::main()
}
