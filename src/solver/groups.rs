//! Corners of many small patches that receive together.
//!
//! Where patches are smaller than the smallest element may be, there are more corners than the thresholds ask for. They are put in groups no
//! larger than that element that face much the same way. A few of a group receive, its *nodes*, as far from one another as can be.
//! Where the light at these differs by little, as at the corners of an element that is not split, the others take it by how near they are
//! and how alike they face; elsewhere the group is halved.

use crate::form_factor::Gather;
use crate::geometry::facing;
use crate::mesh::Mesh;
use glam::{DVec3, Vec3};
use rayon::prelude::*;
use std::ops::Range;

/// Members that receive at first.
const NODES: usize = 6;

/// All members of a group receive that has no more.
const FEW: usize = 8;

/// Normals as far apart as this count like places a whole group apart.
const TURN: f64 = 0.5;

/// Nearer than this part of a group the light of a node is not weighed any more.
const NEAREST: f32 = 0.05;

/// A vertex that may receive in a group: where it is in sides of the largest group, and how it faces.
#[derive(Debug, Clone, Copy)]
pub(super) struct Member {
    pub vertex: u32,
    at: [Vec3; 2],
}

impl Member {
    /// A vertex at a point with a normal; groups are no larger than `side`.
    pub fn new(vertex: u32, point: DVec3, normal: DVec3, side: f64) -> Self {
        let at = [(point / side).fract_gl(), normal / TURN];
        Self {
            vertex,
            at: at.map(|v| v.as_vec3()),
        }
    }

    fn distance_squared(&self, other: &Self) -> f32 {
        let [place, normal] = [0, 1].map(|i| self.at[i].distance_squared(other.at[i]));
        place + normal
    }

    /// The coordinate along one of six axes.
    fn along(&self, axis: usize) -> f32 {
        self.at[axis / 3][axis % 3]
    }
}

/// The members of all groups, one group after the other.
#[derive(Debug, Default)]
pub(super) struct Groups {
    members: Vec<Member>,
    /// What each receives, as far as that is known.
    found: Vec<Option<Gather>>,
    /// Groups that are not settled.
    open: Vec<Range<usize>>,
}

impl Groups {
    /// The groups of `vertices`, all of small patches.
    pub fn new(mesh: &Mesh, vertices: &[u32]) -> Self {
        let side = mesh.limits().min_size * mesh.frame.extent();
        let mut keyed: Vec<_> = vertices
            .par_iter()
            .map(|vertex| {
                let (point, normal) = mesh.receiver(*vertex);
                let back = mesh.patch(mesh.vertices.patch_of(*vertex)).back;
                let cell = (point / side).floor().as_i64vec3().to_array();
                let member = Member::new(*vertex, point, normal, side);
                ((cell, facing(normal), back), member)
            })
            .collect();
        keyed.par_sort_by_key(|(key, member)| (*key, member.vertex));
        let mut groups = Self {
            found: vec![None; keyed.len()],
            ..Self::default()
        };
        for group in keyed.chunk_by(|a, b| a.0 == b.0) {
            let begin = groups.members.len();
            groups
                .members
                .extend(group.iter().map(|(_, member)| member));
            groups.open.push(begin..groups.members.len());
        }
        groups
    }

    /// What each member receives: `receive` says it for some of them, and `differ` whether the light in a group differs too much to be
    /// interpolated.
    pub fn gather(
        mut self,
        mut receive: impl FnMut(&[u32]) -> Vec<Gather>,
        differ: impl Fn(&[(Member, Gather)]) -> bool + Sync,
    ) -> impl Iterator<Item = (u32, Gather)> {
        while !self.open.is_empty() {
            let (members, found) = (&self.members, &self.found);
            let nodes: Vec<Vec<usize>> = self
                .open
                .par_iter()
                .map(|group| nodes(members, found, group))
                .collect();
            let nodes = nodes.concat();
            let vertices: Vec<u32> = nodes.iter().map(|n| members[*n].vertex).collect();
            let received = receive(&vertices);
            for (node, gather) in nodes.iter().zip(received) {
                self.found[*node] = Some(gather);
            }
            self.settle(&differ);
        }
        let found = self.members.into_iter().zip(self.found);
        found.filter_map(|(member, gather)| Some((member.vertex, gather?)))
    }

    /// Interpolates in groups whose nodes agree, and halves the others.
    fn settle(&mut self, differ: impl Fn(&[(Member, Gather)]) -> bool + Sync) {
        let (members, found) = (&self.members, &self.found);
        let interpolated: Vec<Option<Vec<Gather>>> = self
            .open
            .par_iter()
            .map(|group| {
                let nodes: Vec<(Member, Gather)> = group
                    .clone()
                    .filter_map(|n| Some((members[n], found[n]?)))
                    .collect();
                (nodes.len() == group.len() || !differ(&nodes)).then(|| {
                    group
                        .clone()
                        .map(|n| found[n].unwrap_or_else(|| between(&nodes, &members[n])))
                        .collect()
                })
            })
            .collect();
        for (group, interpolated) in std::mem::take(&mut self.open).into_iter().zip(interpolated) {
            match interpolated {
                Some(light) => {
                    let slots = self.found[group].iter_mut();
                    slots
                        .zip(light)
                        .for_each(|(slot, light)| *slot = Some(light));
                }
                None => self.halve(group),
            }
        }
    }

    /// Cuts a group across its longest axis.
    fn halve(&mut self, group: Range<usize>) {
        let members = &self.members[group.clone()];
        let length = |axis: usize| {
            let along = members.iter().map(|member| member.along(axis));
            let low = along.clone().fold(f32::INFINITY, f32::min);
            along.fold(f32::NEG_INFINITY, f32::max) - low
        };
        let longest = (0..6).max_by(|a, b| length(*a).total_cmp(&length(*b)));
        let axis = longest.unwrap_or(0);
        let mut order: Vec<(Member, Option<Gather>)> = group
            .clone()
            .map(|n| (self.members[n], self.found[n]))
            .collect();
        order.sort_by(|(a, _), (b, _)| {
            let place = a.along(axis).total_cmp(&b.along(axis));
            place.then(a.vertex.cmp(&b.vertex))
        });
        for (n, (member, gather)) in group.clone().zip(order) {
            (self.members[n], self.found[n]) = (member, gather);
        }
        let middle = (group.start + group.end) / 2;
        self.open.extend([group.start..middle, middle..group.end]);
    }
}

/// Members of a group that are to receive: all of few, else as many as it takes for [`NODES`], each as far as can be from those before it.
fn nodes(members: &[Member], found: &[Option<Gather>], group: &Range<usize>) -> Vec<usize> {
    let unknown = group.clone().filter(|n| found[*n].is_none());
    if group.len() <= FEW {
        return unknown.collect();
    }
    let mut known: Vec<usize> = group.clone().filter(|n| found[*n].is_some()).collect();
    let mut nodes = Vec::new();
    if known.is_empty() {
        known.push(group.start);
        nodes.push(group.start);
    }
    let distance = |n: usize, known: &[usize]| {
        let distances = known
            .iter()
            .map(|k| members[n].distance_squared(&members[*k]));
        distances.fold(f32::INFINITY, f32::min)
    };
    let mut apart: Vec<f32> = group.clone().map(|n| distance(n, &known)).collect();
    while known.len() < NODES {
        let farthest = (0..apart.len()).max_by(|a, b| apart[*a].total_cmp(&apart[*b]));
        let Some(farthest) = farthest.filter(|n| apart[*n] > 0.0) else {
            break;
        };
        let node = group.start + farthest;
        known.push(node);
        nodes.push(node);
        for (n, apart) in group.clone().zip(&mut apart) {
            *apart = apart.min(distance(n, &[node]));
        }
    }
    nodes
}

/// The light of `nodes` where another member is.
fn between(nodes: &[(Member, Gather)], at: &Member) -> Gather {
    let weight = |node: &Member| (node.distance_squared(at) + NEAREST * NEAREST).recip();
    let sum: f32 = nodes.iter().map(|(node, _)| weight(node)).sum();
    let mut mean = Gather::default();
    for (node, gather) in nodes {
        let part = weight(node) / sum;
        mean.irradiance += gather.irradiance * part;
        mean.unoccluded += gather.unoccluded * part;
    }
    let all = mean.unoccluded.element_sum();
    mean.visibility = (all > 0.0).then(|| mean.irradiance.element_sum() / all);
    mean
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radiometry::Spectrum;

    /// A strip of vertices along x, which face along z.
    fn strip(count: u32) -> Groups {
        let member = |vertex: u32| {
            let at = DVec3::X * (f64::from(vertex) + 0.5) / f64::from(count);
            Member::new(vertex, at, DVec3::Z, 1.0)
        };
        Groups {
            members: (0..count).map(member).collect(),
            found: vec![None; count as usize],
            open: std::iter::once(0..count as usize).collect(),
        }
    }

    fn gather(irradiance: f32) -> Gather {
        Gather {
            irradiance: Spectrum::splat(irradiance),
            unoccluded: Spectrum::ONE,
            visibility: Some(irradiance),
        }
    }

    /// What 100 vertices of a strip receive, and how many were asked, where `light` says it by their place.
    fn received(light: impl Fn(f32) -> f32, most: f32) -> (Vec<f32>, usize) {
        let mut asked = 0;
        let receive = |nodes: &[u32]| {
            asked += nodes.len();
            let at = nodes.iter().map(|v| (*v as f32 + 0.5) / 100.0);
            at.map(|x| gather(light(x))).collect()
        };
        let differ = |of: &[(Member, Gather)]| {
            let values = of.iter().map(|(_, g)| g.irradiance.x);
            let low = values.clone().fold(f32::INFINITY, f32::min);
            values.fold(f32::NEG_INFINITY, f32::max) - low > most
        };
        let mut found: Vec<_> = strip(100).gather(receive, differ).collect();
        found.sort_by_key(|(vertex, _)| *vertex);
        assert!(found.iter().map(|(vertex, _)| *vertex).eq(0..100));
        let found = found.iter().map(|(_, gather)| gather.irradiance.x);
        (found.collect(), asked)
    }

    #[test]
    fn even_light_is_asked_for_at_the_nodes_alone() {
        let (found, asked) = received(|_| 0.25, 0.1);
        assert_eq!(asked, NODES);
        assert!(found.iter().all(|e| (e - 0.25).abs() < 1e-6), "{found:?}");
    }

    #[test]
    fn light_that_is_interpolated_errs_by_no_more_than_nodes_differ() {
        let light = |x: f32| x * x;
        let (found, asked) = received(light, 0.2);
        assert!((NODES + 1..90).contains(&asked), "{asked}");
        for (vertex, e) in found.iter().enumerate() {
            let exact = light((vertex as f32 + 0.5) / 100.0);
            assert!((e - exact).abs() < 0.2, "{e} at {vertex}, {exact}");
        }
    }

    #[test]
    fn a_shadow_is_found_and_everything_beside_it_interpolated() {
        let light = |x: f32| f32::from(u8::from(x < 0.37));
        let (found, asked) = received(light, 0.1);
        assert!(asked < 60, "{asked}");
        for (vertex, e) in found.iter().enumerate() {
            let exact = light((vertex as f32 + 0.5) / 100.0);
            assert!((e - exact).abs() < 1e-6, "{e} at {vertex}");
        }
    }

    #[test]
    fn light_that_differs_everywhere_is_asked_for_everywhere() {
        let (found, asked) = received(|x| (1000.0 * x).sin(), 0.0);
        assert_eq!(asked, 100);
        assert!(found.iter().enumerate().all(|(vertex, e)| {
            (e - (1000.0 * ((vertex as f32 + 0.5) / 100.0)).sin()).abs() < 1e-6
        }));
    }
}
