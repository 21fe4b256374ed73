//! Many boxes at random, on a floor and through it and one another.

use super::setup::{Polygons, cuboid, floor, pieces};
use glam::{DQuat, DVec3, EulerRot};
use radiosity::geometry::jitter;

/// Numbers in [0, 1).
struct Random(u32, u32);

impl Random {
    fn next(&mut self) -> f64 {
        self.1 += 1;
        jitter(self.0, self.1)[0]
    }

    fn vector(&mut self) -> DVec3 {
        DVec3::new(self.next(), self.next(), self.next())
    }
}

#[test]
fn boxes_through_a_floor_at_any_angle() {
    for seed in 0..300 {
        let mut random = Random(seed, 0);
        let mut scene = floor(4.0);
        for _ in 0..=seed % 4 {
            let size = random.vector() * 1.5 + 0.02;
            let angles = random.vector() * std::f64::consts::TAU;
            let turn = DQuat::from_euler(EulerRot::XYZ, angles.x, angles.y, angles.z);
            let at = (random.vector() - 0.5) * DVec3::new(3.0, 0.6, 3.0);
            scene = scene.and(&cuboid(size), turn, at);
        }
        let scene = scene.scene(seed % 2 == 0);
        let found = pieces(&scene);
        assert_eq!(found.mesh.unsplit_contacts, 0, "seed {seed}");
        found.assert_split_along_crossings(&scene, 1e-4);
    }
}

#[test]
fn boxes_on_a_floor_at_any_angle_and_of_any_precision() {
    for seed in 0..200 {
        let mut random = Random(seed, 1000);
        let size = random.vector() * 1.5 + 0.02;
        let turn = DQuat::from_rotation_y(random.next() * std::f64::consts::TAU);
        let at = (random.vector() - 0.5) * DVec3::new(2.0, 0.0, 2.0) + DVec3::Y * (0.5 * size.y);
        // Coordinates as a file of single precision or seven digits has them.
        let mut solid = Polygons::default().and(&cuboid(size), turn, at);
        if seed % 2 == 0 {
            solid
                .0
                .iter_mut()
                .flatten()
                .for_each(|p| *p = p.as_vec3().as_dvec3());
        }
        let tilt = DQuat::from_euler(EulerRot::XYZ, 0.3 * random.next(), 0.0, 0.3 * random.next());
        let scene = floor(4.0).and(&solid, DQuat::IDENTITY, DVec3::ZERO);
        let scene = Polygons::default()
            .and(&scene, tilt, DVec3::ZERO)
            .scene(true);
        let found = pieces(&scene);
        let foot = &scene.surfaces[3].corners.indices();
        for i in 0..4 {
            let side = [foot[i], foot[(i + 1) % 4]].map(|v| scene.vertices[v as usize]);
            found.assert_split_along(&scene, 0, side, 1e-4);
        }
        assert!(found.of[1..].iter().all(|of| of.len() == 1), "seed {seed}");
        let count = found.of[0].len();
        assert!((5..=24).contains(&count), "seed {seed}: {count} pieces");
    }
}

#[test]
fn stacks_of_boxes_with_faces_in_common_planes() {
    for seed in 0..100 {
        let mut random = Random(seed, 2000);
        let mut scene = floor(4.0);
        // Corners on a coarse lattice: faces overlap, edges lie on faces, corners coincide.
        for _ in 0..6 {
            let cell = |x: f64| (x * 4.0).floor() * 0.25;
            let size = (random.vector() * 3.0).floor() * 0.25 + 0.25;
            let low = DVec3::new(
                cell(random.next()),
                cell(random.next()) - 0.25,
                cell(random.next()),
            );
            scene = scene.and(&cuboid(size), DQuat::IDENTITY, low + size * 0.5);
        }
        let turn = DQuat::from_euler(EulerRot::XYZ, 0.1 * random.next(), random.next(), 0.2);
        let scene = Polygons::default()
            .and(&scene, turn, random.vector())
            .scene(false);
        let found = pieces(&scene);
        assert_eq!(found.mesh.unsplit_contacts, 0, "seed {seed}");
        found.assert_split_along_crossings(&scene, 1e-4);
    }
}

#[test]
fn triangles_at_random() {
    for seed in 0..40 {
        let mut random = Random(seed, 3000);
        let triangles = (0..40).map(|_| {
            let at = random.vector();
            (0..3).map(|_| at + random.vector() * 0.5).collect()
        });
        let scene = Polygons(triangles.collect()).scene(false);
        let found = pieces(&scene);
        assert_eq!(found.mesh.unsplit_contacts, 0, "seed {seed}");
        found.assert_split_along_crossings(&scene, 1e-5);
    }
}
