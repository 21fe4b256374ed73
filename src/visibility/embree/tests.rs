use super::*;

/// The solver shares one engine between its threads; the compiler must agree.
#[test]
fn committed_scenes_are_send_and_sync() {
    fn check<T: Send + Sync>() {}
    check::<Embree>();
    check::<CommittedScene>();
    check::<Device>();
}
