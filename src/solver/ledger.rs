//! Where the power went.

use super::escape::Lost;
use super::light::Light;
use super::sums::in_order;
use crate::mesh::Mesh;
use crate::radiometry::Power;

/// The balance of a solve, W per channel: emitted = absorbed + escaped + unshot + residual.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Ledger {
    /// Given by all emitters.
    pub emitted: Power,
    /// Kept by the sides that received it: Σ (1 - ρ) ∫ E.
    pub absorbed: Power,
    /// Gone to the open or onto sides that do not radiate, measured by its own cosine-distributed rays.
    pub escaped: Power,
    /// The part of it that ended on sides that do not radiate.
    pub onto_backs: Power,
    /// Not yet shot.
    pub unshot: Power,
}

impl Ledger {
    /// What the other terms leave over: the discretisation error, plus the sampling error of `escaped`.
    pub fn residual(&self) -> Power {
        self.emitted - self.absorbed - self.escaped - self.unshot
    }

    /// Takes the balance of a mesh. Areas of the frame become m² through `square_metres`, the area in m² of a frame unit squared.
    pub(super) fn balance(mesh: &Mesh, light: &Light, lost: &Lost, square_metres: f64) -> Self {
        let mut ledger = Self {
            escaped: lost.all * square_metres,
            onto_backs: lost.onto_backs * square_metres,
            ..Self::default()
        };
        let of_patch = |number: usize| {
            let patch = mesh.patches.at(number);
            let received: Power = mesh
                .vertices_of(number as u32)
                .map(|v| light.irradiance[v as usize].as_dvec3() * mesh.weights[v as usize])
                .sum();
            let emitted = patch.exitance.as_dvec3() * patch.area;
            let absorbed = (Power::ONE - patch.reflectance.as_dvec3()) * received;
            (emitted, absorbed, light.unshot_by_sign(mesh, number))
        };
        let add = |(emitted, absorbed, [positive, negative]): (Power, Power, [Power; 2])| {
            ledger.emitted += emitted * square_metres;
            ledger.absorbed += absorbed * square_metres;
            ledger.unshot += positive * square_metres;
            ledger.unshot -= negative * square_metres;
        };
        in_order(mesh.patches.len(), of_patch, add);
        ledger
    }
}
