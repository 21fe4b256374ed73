//! Any table of points is probed or refused.
#![no_main]

mod files;

use libfuzzer_sys::fuzz_target;
use std::path::PathBuf;
use std::sync::LazyLock;

/// A solution to probe.
static SOLVED: LazyLock<PathBuf> = LazyLock::new(|| {
    let path = files::FOLDER.path().join("solution.rad");
    let solution = include_bytes!("../../data/format-1/solution.rad");
    std::fs::write(path, solution).expect("can be written");
    files::FOLDER.path().to_path_buf()
});

fuzz_target!(|data: &[u8]| {
    let points = SOLVED.join("points.csv");
    std::fs::write(&points, data).expect("can be written");
    let output = SOLVED.join("light.csv");
    let arguments = ["radiosity", "probe"].map(Into::into);
    let paths = [SOLVED.as_os_str(), points.as_os_str(), "-o".as_ref(), output.as_os_str()];
    let paths = paths.map(ToOwned::to_owned);
    let _ = radiosity::cli::run(arguments.into_iter().chain(paths));
});
