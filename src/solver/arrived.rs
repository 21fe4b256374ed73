//! What a shot or a wave has given to each vertex so far.
//!
//! After a shot of emitters elements are tested for what their vertices see of it. Of what all reflect together nobody asks that, so
//! a wave of this, with which a large scene takes the most memory, keeps irradiance alone.

use crate::form_factor::Gather;
use crate::mesh::Mesh;
use crate::radiometry::Spectrum;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// What has arrived, by vertex. Files have it as a list of [`Gather`]s.
#[derive(Debug, Clone)]
pub(super) struct Arrived {
    pub irradiance: Vec<Spectrum>,
    /// Empty if nobody will ask for it.
    sight: Vec<Sight>,
}

/// What a vertex sees of the source, in as little as the tests ask for; see [`Gather`].
#[derive(Debug, Clone, Copy)]
struct Sight {
    /// Of the strongest channel.
    unoccluded: f32,
    /// NaN where nothing of the source is above the horizon.
    visibility: f32,
}

impl Arrived {
    /// Nothing, with what is seen.
    pub fn nothing(mesh: &Mesh) -> Self {
        Self {
            irradiance: mesh.by_vertex(Spectrum::ZERO),
            sight: mesh.by_vertex(Sight::NOTHING),
        }
    }

    /// Nothing; what is seen will not be kept.
    pub fn nothing_unseen(mesh: &Mesh) -> Self {
        Self {
            irradiance: mesh.by_vertex(Spectrum::ZERO),
            sight: Vec::new(),
        }
    }

    pub fn len(&self) -> usize {
        self.irradiance.len()
    }

    /// Nothing has arrived at the vertices that are new.
    pub fn grow(&mut self, vertices: usize) {
        self.irradiance.resize(vertices, Spectrum::ZERO);
        if !self.sight.is_empty() {
            self.sight.resize(vertices, Sight::NOTHING);
        }
    }

    /// What has arrived at a vertex.
    pub fn at(&self, vertex: u32) -> Gather {
        let irradiance = self.irradiance[vertex as usize];
        let sight = self.sight.get(vertex as usize);
        sight.unwrap_or(&Sight::NOTHING).with(irradiance)
    }

    /// A vertex receives.
    pub fn set(&mut self, vertex: u32, gather: Gather) {
        self.irradiance[vertex as usize] = gather.irradiance;
        if let Some(sight) = self.sight.get_mut(vertex as usize) {
            *sight = Sight::of(&gather);
        }
    }

    /// Vertices that receive for others give to these.
    pub fn share(&mut self, mesh: &Mesh) {
        let mean = |of: &[Spectrum]| of.iter().sum::<Spectrum>() / of.len() as f32;
        mesh.share(&mut self.irradiance, mean);
        if !self.sight.is_empty() {
            mesh.share(&mut self.sight, Sight::mean);
        }
    }

    /// Light is continued to buried vertices, from `first` on.
    pub fn continue_to_buried(&mut self, mesh: &Mesh, first: u32) {
        mesh.continue_to_buried(&mut self.irradiance, |e| e, first);
    }
}

impl Sight {
    const NOTHING: Self = Self {
        unoccluded: 0.0,
        visibility: f32::NAN,
    };

    fn of(gather: &Gather) -> Self {
        Self {
            unoccluded: gather.unoccluded.max_element(),
            visibility: gather.visibility.unwrap_or(f32::NAN),
        }
    }

    fn with(self, irradiance: Spectrum) -> Gather {
        Gather {
            irradiance,
            unoccluded: Spectrum::splat(self.unoccluded),
            visibility: Some(self.visibility).filter(|index| !index.is_nan()),
        }
    }

    /// That of three or four corners.
    fn mean(of: &[Self]) -> Self {
        let mut corners = [Gather::default(); 4];
        for (corner, sight) in corners.iter_mut().zip(of) {
            *corner = sight.with(Spectrum::ZERO);
        }
        Self::of(&Gather::mean(&corners[..of.len()]))
    }
}

impl Serialize for Arrived {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq((0..self.len() as u32).map(|vertex| self.at(vertex)))
    }
}

impl<'de> Deserialize<'de> for Arrived {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let gathers = Vec::<Gather>::deserialize(deserializer)?;
        Ok(Self {
            irradiance: gathers.iter().map(|gather| gather.irradiance).collect(),
            sight: gathers.iter().map(Sight::of).collect(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solver::options::Preset;
    use crate::solver::trial::Trial;

    #[test]
    fn what_tests_ask_for_is_kept_and_goes_through_a_file() {
        let trial = Trial::after(1, Preset::Draft.options());
        let mesh = &trial.solver().mesh;
        let lit = Gather {
            irradiance: Spectrum::new(1.0, 2.0, 3.0),
            unoccluded: Spectrum::new(4.0, 6.0, 5.0),
            visibility: Some(0.5),
        };
        let below_the_horizon = Gather::default();
        let mut arrived = Arrived::nothing(mesh);
        arrived.set(0, lit);
        arrived.set(1, below_the_horizon);
        let text = serde_json::to_string(&arrived).expect("memory can be written to");
        let read: Arrived = serde_json::from_str(&text).expect("was just written");
        for arrived in [&arrived, &read] {
            let kept = arrived.at(0);
            assert_eq!(kept.irradiance, lit.irradiance);
            assert_eq!(kept.unoccluded.max_element(), 6.0);
            assert_eq!(kept.visibility, lit.visibility);
            assert_eq!(arrived.at(1), below_the_horizon);
        }
        let listed: Vec<Gather> = serde_json::from_str(&text).expect("files have it so");
        assert_eq!(listed.len(), mesh.vertices.len());
        assert_eq!(listed[0], arrived.at(0));
    }

    #[test]
    fn unseen_it_is_the_irradiance_alone() {
        let trial = Trial::after(1, Preset::Draft.options());
        let mut arrived = Arrived::nothing_unseen(&trial.solver().mesh);
        let irradiance = Spectrum::ONE;
        let lit = Gather {
            irradiance,
            unoccluded: Spectrum::ONE,
            visibility: Some(1.0),
        };
        arrived.set(0, lit);
        let alone = Gather {
            irradiance,
            ..Gather::default()
        };
        assert_eq!(arrived.at(0), alone);
    }
}
