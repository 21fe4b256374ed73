//! Step 1 of sampling a source: the cells for one point, found without rays.

use super::disk::point_to_disk;
use super::hybrid::{Receiver, Sight, above_horizon};
use super::sampling::{Leaf, Sampler};
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

/// What the four parts of a cell give together.
struct Parts {
    contribution: Spectrum,
    /// How far that is from the cell's own estimate, as the thresholds measure it.
    difference: f64,
}

impl Sampler<'_> {
    /// The thresholds at one point: they follow what it has, or what the source would give it if that is more.
    pub(super) fn limits(&self, source: &Source, receiver: Receiver) -> Limits {
        let SourceThresholds {
            difference,
            estimate,
            raw,
            scale,
        } = self.thresholds;
        if raw {
            return Limits {
                difference,
                estimate,
            };
        }
        let from = |cell| {
            let of = source.cell(cell);
            let factor = point_to_disk(
                receiver.normal,
                of.centroid - receiver.point,
                source.normal(),
                of.area,
            );
            f64::from(of.radiosity.max_element()) * factor
        };
        let unit = scale.at(children(0)
            .map(from)
            .sum::<f64>()
            .max(f64::from(receiver.irradiance)));
        Limits {
            difference: difference * unit,
            estimate: estimate * unit,
        }
    }

    /// Step 1: the cells for one point, found without rays.
    pub(super) fn partition(
        &self,
        source: &Source,
        receiver: Receiver,
        limits: Limits,
        pending: &mut Vec<CellIndex>,
        leaves: &mut Vec<Leaf>,
    ) {
        pending.clear();
        pending.extend((1..=4).rev());
        while let Some(cell) = pending.pop() {
            let sight = self
                .formula
                .sight(receiver, source.cell(cell), source.normal());
            if sight.form_factor <= 0.0 {
                continue;
            }
            let mut leaf = self.leaf(source, receiver, cell, &sight);
            if source.has_children(cell) {
                if f64::from(leaf.measure) > limits.estimate {
                    pending.extend(children(cell).rev());
                    continue;
                }
                if let Some(parts) = self.parts(source, receiver, limits, &leaf, &sight) {
                    if parts.difference > limits.difference {
                        pending.extend(children(cell).rev());
                        continue;
                    }
                    // The finer estimate is at hand, and a third of the difference is left of its second-order error.
                    let change = parts.contribution - leaf.contribution;
                    leaf.contribution =
                        (leaf.contribution + change * (4.0 / 3.0)).max(Spectrum::ZERO);
                }
            }
            leaves.push(leaf);
        }
    }

    pub(super) fn leaf(
        &self,
        source: &Source,
        receiver: Receiver,
        cell: CellIndex,
        sight: &Sight,
    ) -> Leaf {
        let of = source.cell(cell);
        let contribution = of.radiosity * sight.form_factor as f32;
        let measure = if self.thresholds.raw {
            sight.form_factor as f32
        } else {
            contribution.max_element()
        };
        let area = if sight.cut {
            vector_area(above_horizon(receiver, of.outline()).corners()).length()
        } else {
            of.area
        };
        Leaf {
            cell,
            contribution,
            measure,
            area: area as f32,
            cut: sight.cut,
            seen: false,
        }
    }

    /// The estimate from the four parts of a cell; `None` where a bound shows that it is the cell's own.
    fn parts(
        &self,
        source: &Source,
        receiver: Receiver,
        limits: Limits,
        leaf: &Leaf,
        sight: &Sight,
    ) -> Option<Parts> {
        let cell = source.cell(leaf.cell);
        let variation = if self.thresholds.raw {
            0.0
        } else {
            f64::from(cell.variation) * sight.form_factor
        };
        if f64::from(leaf.measure) * sight.uncertainty + variation <= NEGLIGIBLE * limits.difference
        {
            return None;
        }
        let (mut contribution, mut sum) = (Spectrum::ZERO, 0.0);
        for child in children(leaf.cell) {
            let part = source.cell(child);
            // Eq. (2) has the whole right already; how the parts share it, their centres tell well enough.
            let factor = if sight.uncertainty > 0.0 {
                self.formula
                    .sight(receiver, part, source.normal())
                    .form_factor
            } else {
                point_to_disk(
                    receiver.normal,
                    part.centroid - receiver.point,
                    source.normal(),
                    part.area,
                )
            };
            contribution += part.radiosity * factor as f32;
            sum += factor;
        }
        if sight.uncertainty == 0.0 && sum > 0.0 {
            contribution *= (sight.form_factor / sum) as f32;
            sum = sight.form_factor;
        }
        let difference = if self.thresholds.raw {
            (sum - sight.form_factor).abs()
        } else {
            f64::from((contribution - leaf.contribution).abs().max_element())
        };
        Some(Parts {
            contribution,
            difference,
        })
    }
}
