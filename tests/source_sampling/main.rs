//! The adaptively sampled source against Eq. (2): what a point receives from a whole patch, from a patch that is not
//! constant, and from one that is partly hidden.

mod blocked;
mod setup;
mod strips;
mod unhindered;
