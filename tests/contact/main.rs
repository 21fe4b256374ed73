//! Surfaces are split along the lines in which others cross or touch them, or end close in front of them, and nowhere else.

#[path = "../common/mod.rs"]
mod common;

mod contacts;
mod gaps;
mod leaks;
mod none;
mod overlaps;
mod random;
mod regions;
mod setup;
