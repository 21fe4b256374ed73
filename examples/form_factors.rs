//! Form factors between the materials of a scene, with occlusion.
//!
//! ```text
//! cargo run --release --example form_factors -- scenes/cornell-box
//! ```

use radiosity::matrix::{By, Enclosure, Options};
use radiosity::scene::NamedScene;
use std::error::Error;
use std::path::PathBuf;

fn main() -> Result<(), Box<dyn Error>> {
    let scene = std::env::args_os().nth(1).map(PathBuf::from);
    let named = NamedScene::load(&scene.unwrap_or_else(|| "scenes/cornell-box".into()))?;
    let options = Options {
        by: By::Material,
        tolerance: 1e-3,
        ..Options::standard()
    };
    let matrix = Enclosure::new(&named, &options)?.matrix();
    for (number, row) in matrix.rows.iter().enumerate() {
        let factors = matrix.row(number);
        let text: Vec<String> = factors.iter().map(|f| format!("{f:.4}")).collect();
        let sum: f64 = factors.iter().sum();
        println!("{:16} {}  sum {sum:.4}", row.label, text.join(" "));
    }
    Ok(())
}
