//! Solution files that are not what `solve` wrote.

use super::{draft, radiosity, text};
use std::fs;

#[test]
fn a_damaged_solution_is_refused_by_name() {
    let (folder, solved) = draft("geometry");
    let path = solved.join("solution.rad");
    let whole = fs::read(&path).expect("was written");
    let points = folder.path().join("points.csv");
    fs::write(&points, "x,y,z,nx,ny,nz\n").expect("can be written");
    let refused = |bytes: &[u8], words: &[&str]| {
        fs::write(&path, bytes).expect("can be written");
        let words = [&["solution.rad"], words].concat();
        radiosity(&["probe", text(&solved), text(&points)]).assert_refused(3, &words);
        radiosity(&["render", text(&solved)]).assert_refused(3, &words);
    };

    let flipped = |at: usize| {
        let mut bytes = whole.clone();
        bytes[at] ^= 0x10;
        bytes
    };
    refused(&flipped(0), &["not a solution file"]);
    refused(&flipped(8), &["version"]);
    refused(&flipped(13), &["cut short or has grown"]);
    refused(&flipped(20), &["checksum"]);
    for at in [24, whole.len() / 2, whole.len() - 1] {
        refused(&flipped(at), &["checksum"]);
    }
    refused(&whole[..whole.len() / 2], &["cut short"]);
    refused(&whole[..20], &["not a solution file"]);
    refused(&[], &["not a solution file"]);
    refused(&[&whole[..], b"more"].concat(), &["has grown"]);

    fs::write(&path, &whole).expect("can be written");
    radiosity(&["probe", text(&solved), text(&points)]).assert_success();
}
