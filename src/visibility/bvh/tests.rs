use super::*;

#[test]
fn is_send_and_sync() {
    fn check<T: Send + Sync>() {}
    check::<Obvhs>();
}
