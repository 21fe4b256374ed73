//! What the surfaces of a solution are called.

use crate::scene::{NamedScene, Names};
use crate::solution::Solution;

/// What the scene's file calls its polygons, if it is still where it was and still says the same; a solution does not keep it.
pub(super) fn names_of(solution: &Solution) -> Names {
    same_names(solution).unwrap_or_default()
}

fn same_names(solution: &Solution) -> Option<Names> {
    let known = &solution.continuation.as_ref()?.scene;
    let file = solution.report.scene_file.as_deref()?;
    let mut named = NamedScene::load_lit(file).ok()?;
    // What was warned of is told with the path as it was given then, which may have been a relative one.
    named.scene.warnings.clone_from(&known.warnings);
    (named.scene == *known).then_some(named.names)
}
