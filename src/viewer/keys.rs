//! Which key means what.

use super::state::Action;
use glam::DVec3;
use winit::keyboard::{Key, NamedKey};

/// Stops by which a key changes the exposure.
const STOPS: f64 = 0.5;
/// Pixels by which a key turns the head.
const TURN: f64 = 40.0;

/// What a key asks for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Wish {
    /// Something of the viewer's.
    Act(Action),
    /// The end.
    Quit,
}

/// What a key asks for, if anything; walking goes five times as far when `fast`.
pub(super) fn wish(key: &Key, fast: bool) -> Option<Wish> {
    let pace = if fast { 5.0 } else { 1.0 };
    let walk = |x: f64, y: f64, z: f64| Action::Walk(pace * DVec3::new(x, y, z));
    let turn = |x: f64| Action::Turn(glam::DVec2::new(x * TURN, 0.0));
    let action = match key {
        Key::Named(NamedKey::Escape) => return Some(Wish::Quit),
        Key::Named(NamedKey::ArrowUp) => walk(0.0, 0.0, 1.0),
        Key::Named(NamedKey::ArrowDown) => walk(0.0, 0.0, -1.0),
        Key::Named(NamedKey::ArrowLeft) => turn(1.0),
        Key::Named(NamedKey::ArrowRight) => turn(-1.0),
        Key::Named(NamedKey::PageUp) => walk(0.0, 1.0, 0.0),
        Key::Named(NamedKey::PageDown) => walk(0.0, -1.0, 0.0),
        Key::Named(NamedKey::Home) => Action::Home,
        Key::Character(character) => match character.to_lowercase().as_str() {
            "q" => return Some(Wish::Quit),
            "w" => walk(0.0, 0.0, 1.0),
            "s" => walk(0.0, 0.0, -1.0),
            "a" => walk(-1.0, 0.0, 0.0),
            "d" => walk(1.0, 0.0, 0.0),
            // On many keyboards the plus is the equals sign with shift.
            "+" | "=" => Action::Expose(STOPS),
            "-" | "_" => Action::Expose(-STOPS),
            "0" => Action::AutoExpose,
            "f" => Action::NextQuantity,
            "e" => Action::Elements,
            "c" => Action::NextCamera,
            _ => return None,
        },
        _ => return None,
    };
    Some(Wish::Act(action))
}
