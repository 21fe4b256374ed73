//! What the surfaces of a solution are called.

use crate::scene::{NamedScene, Names};
use crate::solution::Solution;

/// What the scene's file calls its polygons, if it is still where it was and still says the same; a solution does not keep it.
pub(super) fn names_of(solution: &Solution) -> Names {
    let file = solution.report.scene_file.as_deref();
    let named = file.and_then(|file| NamedScene::load_lit(file).ok());
    let known = solution.continuation.as_ref().map(|known| &known.scene);
    let same = named.filter(|named| known == Some(&named.scene));
    same.map(|named| named.names).unwrap_or_default()
}
