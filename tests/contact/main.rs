//! Surfaces are split along the lines in which others cross or touch them, and nowhere else.

mod contacts;
mod leaks;
mod none;
mod random;
mod regions;
mod setup;
