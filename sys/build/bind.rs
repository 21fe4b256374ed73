//! Steps 2 and 3: find libclang, then translate the installed header.

use crate::{Missing, locate::Embree};
use std::env;
use std::path::PathBuf;

/// The functions that are used; their types come along. The header's `inline` helpers cannot be
/// bound (they have no symbol): the shim stands in for them.
const FUNCTIONS: &str = "rtc(NewDevice|ReleaseDevice|GetDeviceProperty|GetDeviceError\
     |SetDeviceErrorFunction|SetDeviceMemoryMonitorFunction\
     |NewScene|ReleaseScene|SetSceneFlags|SetSceneBuildQuality|CommitScene\
     |NewGeometry|ReleaseGeometry|SetNewGeometryBuffer|CommitGeometry|AttachGeometry)|shim_.*";
/// Constants without a function that mentions them.
const CONSTANTS: &str = "RTC_VERSION|RTC_VERSION_STRING";
/// Enums whose values are combined with `|`.
const FLAGS: &str = "RTCSceneFlags";

/// bindgen panics where libclang is missing, so ask for it first. What is loaded here is what bindgen
/// uses; names with a version (`libclang-14.so.1`, without any `-dev` package) are found too.
pub fn probe_libclang() -> Result<(), Missing> {
    clang_sys::load().map_err(|message| Missing::NotInstalled(format!("no libclang ({message})")))
}

/// Writes `bindings.rs`: constants in newtypes (a C enum may hold any value, a Rust enum may not),
/// with a test of every layout.
pub fn generate(embree: &Embree) -> Result<(), Missing> {
    let target = bindgen::RustTarget::stable(85, 0).unwrap_or_default();
    let bindings = bindgen::Builder::default()
        .header("shim/shim.h")
        .clang_arg(format!("-DEMBREE_MAJOR={}", embree.major))
        .clang_arg(format!("-I{}", embree.include_dir.display()))
        .clang_args(compiler_include_args())
        .allowlist_function(FUNCTIONS)
        .allowlist_var(CONSTANTS)
        .default_enum_style(bindgen::EnumVariation::NewType {
            is_bitfield: false,
            is_global: false,
        })
        .bitfield_enum(FLAGS)
        .derive_default(true)
        .rust_target(target)
        .formatter(bindgen::Formatter::None)
        .parse_callbacks(Box::new(bindgen::CargoCallbacks::new()))
        .generate()
        .map_err(|error| {
            Missing::NotInstalled(format!("bindgen cannot read its header ({error})"))
        })?;
    bindings
        .write_to_file(out_dir().join("bindings.rs"))
        .map_err(|error| Missing::NotInstalled(format!("cannot write the bindings ({error})")))
}

/// libclang alone does not bring `stddef.h`; the C compiler's own serves as a last resort.
fn compiler_include_args() -> Vec<String> {
    let include_dir = || {
        let compiler = cc::Build::new()
            .cargo_metadata(false)
            .cargo_warnings(false)
            .try_get_compiler()
            .ok()?;
        let output = compiler
            .to_command()
            .arg("-print-file-name=include")
            .output()
            .ok()?;
        let path = PathBuf::from(String::from_utf8(output.stdout).ok()?.trim());
        path.is_absolute().then_some(path)
    };
    include_dir().map_or_else(Vec::new, |dir| {
        vec!["-idirafter".into(), dir.display().to_string()]
    })
}

fn out_dir() -> PathBuf {
    PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"))
}
