//! What `--help` shows after the flags: examples, and what the presets choose.

use crate::solver::Preset;
use serde_json::Value;
use std::fmt::Write;

pub(super) const ALL: &str = "\
Examples:
  radiosity solve scenes/cornell-box -o out        a folder with a scene.toml
  radiosity solve room.glb -o out --preset draft   glTF as Blender exports it
  radiosity export out -o room.vtu                 for ParaView
  radiosity probe out --grid y=0.8m                illuminance on a plane of work

Exit codes:
  0    success
  1    failure while running or writing
  2    wrong usage
  3    unusable input
  130  interrupted (solve writes the solution so far, form-factors nothing)

Warnings, errors and progress go to standard error, results to standard output. Colours are for terminals only, and not if
NO_COLOR is set.";

pub(super) const RESUME: &str = "\
Examples:
  radiosity resume out                             after Ctrl-C, or from the last checkpoint
  radiosity resume out --tolerance 0.0005          the same, further";

pub(super) const RENDER: &str = "\
Examples:
  radiosity render out                             the scene's cameras once more
  radiosity render out --eye 278,273,-800 --look-at 278,273,0 --exposure 1 -o pictures";

pub(super) const VIEW: &str = "\
Examples:
  radiosity view out                               from the scene's first camera
  radiosity view out --camera door --width 1280 --height 800
  radiosity view out/solution.ply                  without names and cameras

Mouse and keys:
  left drag        circle what is in the middle    wheel            closer, farther
  right drag       turn the head                   click            read the light there (in the title, on standard output)
  W A S D, up, down        walk (shift: faster)    left, right      turn
  page up, page down       rise, sink              Home             back to the camera
  + -              brighter, darker; in false colours a shorter or longer scale
  0                exposure as the program chooses it
  F                light, illuminance (lx), radiosity (W/m2)
  E                the elements                    C                the next camera
  Q, Escape        the end";

pub(super) const PROBE: &str = "\
Examples:
  radiosity probe out points.csv -o lit.csv        points on surfaces
  radiosity probe out --grid y=0.8m                0.25 m apart over the whole scene, to standard output
  radiosity probe out --grid y=0.8m --spacing 10cm --region 0,0,4,3 -o lux.csv --picture lux.png

Illuminance in lux is the weighted sum of the irradiance, 0.2126 red + 0.7152 green + 0.0722 blue in W/m², times the efficacy.";

pub(super) const EXPORT: &str = "\
Examples:
  radiosity export out -o lit.glb --exposure 2     brighter colours
  radiosity export out -o lit.vtu --efficacy 1     emitters were given in lumens";

pub(super) const INFO: &str = "\
Examples:
  radiosity info room.glb";

pub(super) const FORM_FACTORS: &str = "\
Examples:
  radiosity form-factors oven -o F.csv             a square matrix as a table
  radiosity form-factors oven -o F.npz --by group";

/// Examples of a solve, and what the presets choose for each option that is not given.
pub(super) fn solve() -> String {
    let mut text = "\
Examples:
  radiosity solve room.glb -o out
  radiosity solve room.obj -o out --target-error 1% --time-limit 10m
  radiosity solve room.obj -o out --progress json | jq -r .unshot
  radiosity solve room.obj -o out --quiet --no-pictures --formats ply

What the presets choose:
"
    .to_owned();
    let presets = [Preset::Draft, Preset::Standard, Preset::Accurate];
    let columns = presets.map(|preset| values(&preset.options()));
    let _ = writeln!(
        text,
        "  {:<26} {:>12} {:>12} {:>12}",
        "", "draft", "standard", "accurate"
    );
    for (place, (name, draft)) in columns[0].iter().enumerate() {
        let [standard, accurate] = [1, 2].map(|column| &columns[column][place].1);
        let _ = writeln!(
            text,
            "  {name:<26} {draft:>12} {standard:>12} {accurate:>12}"
        );
    }
    text
}

/// Names and values of options as reports show them.
fn values(options: &impl serde::Serialize) -> Vec<(String, String)> {
    let mut flat = Vec::new();
    flatten(
        &serde_json::to_value(options).unwrap_or_default(),
        &mut flat,
    );
    flat
}

fn flatten(value: &Value, flat: &mut Vec<(String, String)>) {
    for (name, value) in value.as_object().into_iter().flatten() {
        match value {
            Value::Object(_) => flatten(value, flat),
            Value::Null => flat.push((name.clone(), "none".into())),
            Value::Number(number) => {
                let number = number.as_f64().unwrap_or_default();
                flat.push((name.clone(), format!("{}", (number * 1e6).round() / 1e6)));
            }
            other => flat.push((name.clone(), other.to_string().replace('"', ""))),
        }
    }
}
