//! Step 1 of sampling a source: the cells for one point, found without rays.

use super::hybrid::{Formula, Receiver, above_horizon};
use super::sampling::{Leaf, Sampler};
use super::siblings::{Four, Sights};
use super::source::{CellIndex, Source, children};
use crate::geometry::polygon::vector_area;
use crate::radiometry::Spectrum;

/// When a cell of the source is split; see the paper, section 4.2.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SourceThresholds {
    /// Split while cell and sub-cells differ by more (ε_fd).
    pub difference: f64,
    /// Split while the estimate exceeds this (ε_fe).
    pub estimate: f64,
    /// Whether the thresholds are form factors, as in the paper, rather than multiples of an irradiance (F · ΔB, largest channel).
    pub raw: bool,
    /// That irradiance.
    pub scale: ToleranceScale,
}

impl SourceThresholds {
    /// Both thresholds multiplied by `factor`.
    pub fn scaled(self, factor: f64) -> Self {
        Self {
            difference: self.difference * factor,
            estimate: self.estimate * factor,
            ..self
        }
    }
}

/// The irradiance that relative thresholds are multiples of: between the scene's reference and what is there,
/// `reference^(1 - share) · local^share`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ToleranceScale {
    /// The scene's reference irradiance.
    pub reference: f64,
    /// 0 for the reference alone, 1 for the local irradiance alone.
    pub local_share: f64,
}

impl ToleranceScale {
    /// The scale where the irradiance is `local`.
    pub fn at(&self, local: f64) -> f64 {
        if self.local_share == 0.0 {
            self.reference
        } else {
            self.reference * (local / self.reference).powf(self.local_share)
        }
    }
}

/// The thresholds in force at one point, in the unit of what they are compared with.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Limits {
    pub(super) difference: f64,
    pub(super) estimate: f64,
}

/// A difference this much below the threshold is not looked for.
const NEGLIGIBLE: f64 = 1.0 / 16.0;

/// A cell that is split, with what the point sees of its parts if that is known already.
pub(super) type Split = (CellIndex, Option<Sights>);

/// What the four parts of a cell give together.
struct Parts {
    contribution: Spectrum,
    /// How far that is from the cell's own estimate, as the thresholds measure it.
    difference: f64,
    /// What the point sees of them, if it was looked at for this.
    sights: Option<Sights>,
}

/// One source and one point, before any ray.
#[derive(Clone, Copy)]
pub(super) struct Pairing<'a> {
    pub source: &'a Source,
    pub receiver: Receiver,
    pub formula: Formula,
    pub limits: Limits,
    /// Whether thresholds are form factors.
    pub raw: bool,
}

impl Sampler<'_> {
    /// A source and a point with the thresholds there: they follow what the point has, or what the source would give it if that is more.
    #[inline(always)]
    pub(super) fn pairing<'a>(&self, source: &'a Source, receiver: Receiver) -> Pairing<'a> {
        let SourceThresholds {
            difference,
            estimate,
            raw,
            scale,
        } = self.thresholds;
        let unit = if raw {
            1.0
        } else {
            let siblings = source.parts(0);
            let disks = siblings.disks(receiver, source.normal());
            let given: f64 = (0..4).map(|i| siblings.strongest(i) * disks[i]).sum();
            scale.at(given.max(f64::from(receiver.irradiance)))
        };
        Pairing {
            source,
            receiver,
            formula: self.formula,
            limits: Limits {
                difference: difference * unit,
                estimate: estimate * unit,
            },
            raw,
        }
    }
}

impl Pairing<'_> {
    /// Step 1: the cells for one point, found without rays.
    #[inline(always)]
    pub fn partition(&self, pending: &mut Vec<Split>, leaves: &mut Vec<Leaf>) {
        pending.clear();
        pending.push((0, None));
        while let Some((parent, known)) = pending.pop() {
            let sights = match known {
                Some(sights) => sights,
                None => self.sights(parent),
            };
            for (i, cell) in children(parent).enumerate() {
                if sights.form_factor[i] <= 0.0 {
                    continue;
                }
                let mut leaf = self.leaf(cell, &sights, i);
                if self.source.has_children(cell) {
                    if f64::from(leaf.measure) > self.limits.estimate {
                        pending.push((cell, None));
                        continue;
                    }
                    if let Some(parts) = self.finer(&leaf, &sights, i) {
                        if parts.difference > self.limits.difference {
                            pending.push((cell, parts.sights));
                            continue;
                        }
                        let change = parts.contribution - leaf.contribution;
                        let beyond = self.source.extrapolation(cell);
                        leaf.contribution =
                            (leaf.contribution + change * beyond).max(Spectrum::ZERO);
                    }
                }
                leaves.push(leaf);
            }
        }
    }

    /// What the point sees of the parts of a cell.
    #[inline(always)]
    pub fn sights(&self, parent: CellIndex) -> Sights {
        let parts = self.source.parts(parent);
        parts.sights(self.formula, self.receiver, self.source.normal())
    }

    /// A part of a cell that is not split.
    #[inline(always)]
    pub fn leaf(&self, cell: CellIndex, sights: &Sights, i: usize) -> Leaf {
        let of = self.source.cell(cell);
        let form_factor = sights.form_factor[i] as f32;
        let contribution = of.radiosity * form_factor;
        let measure = if self.raw {
            form_factor
        } else {
            contribution.max_element()
        };
        let area = if sights.is_cut[i] {
            vector_area(above_horizon(self.receiver, of.outline()).corners()).length()
        } else {
            of.area
        };
        Leaf {
            cell,
            contribution,
            measure,
            area: area as f32,
            cut: sights.is_cut[i],
            seen: false,
            place: [0.0; 2],
        }
    }

    /// The estimate from the four parts of a leaf; `None` where a bound shows that it is the leaf's own.
    #[inline(always)]
    fn finer(&self, leaf: &Leaf, sights: &Sights, i: usize) -> Option<Parts> {
        let (whole, uncertainty) = (sights.form_factor[i], sights.uncertainty[i]);
        let variation = if self.raw {
            0.0
        } else {
            f64::from(self.source.cell(leaf.cell).variation) * whole
        };
        let bound = f64::from(leaf.measure) * uncertainty + variation;
        if bound <= NEGLIGIBLE * self.limits.difference {
            return None;
        }
        let parts = self.source.parts(leaf.cell);
        let (form_factors, sights) = if uncertainty > 0.0 {
            let sights = self.sights(leaf.cell);
            (sights.form_factor, Some(sights))
        } else {
            // Eq. (2) has the whole right already; how the parts share it, their centres tell well enough.
            let disks = parts.disks(self.receiver, self.source.normal());
            (scaled_to(disks, whole), None)
        };
        let contribution = parts.irradiance(&form_factors);
        let difference = if self.raw {
            (form_factors.iter().sum::<f64>() - whole).abs()
        } else {
            f64::from((contribution - leaf.contribution).abs().max_element())
        };
        Some(Parts {
            contribution,
            difference,
            sights,
        })
    }
}

/// Numbers multiplied so that they add up to `whole`, if they are not all 0.
#[inline(always)]
fn scaled_to(mut numbers: Four, whole: f64) -> Four {
    let sum: f64 = numbers.iter().sum();
    if sum > 0.0 {
        for number in &mut numbers {
            *number *= whole / sum;
        }
    }
    numbers
}
