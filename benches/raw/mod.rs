//! Embree without us: packets that are ready, only `tfar` is written anew.

use embree4_sys as sys;
use glam::Vec3;
use radiosity::visibility::{Fans, Isa, T_FAR, T_NEAR, Triangles};
use std::ffi::CStr;

/// Traces all packets and says how many rays are occluded.
pub type Answer = Box<dyn FnMut() -> u32>;

/// Packets of the width that goes with the instruction set, in a device that uses no wider one.
pub fn contender(isa: Isa, triangles: &Triangles, fans: &[Fans]) -> (&'static str, Answer) {
    match isa {
        Isa::Avx512 => {
            let scene = commit(triangles, c"threads=2");
            ("rtcOccluded16, AVX-512", sixteen::answer(scene, fans))
        }
        Isa::Avx2 => {
            let scene = commit(triangles, c"threads=2,max_isa=avx2");
            ("rtcOccluded8, AVX2", eight::answer(scene, fans))
        }
        Isa::Portable => {
            let scene = commit(triangles, c"threads=2,max_isa=sse4.2");
            ("rtcOccluded4, SSE4.2", four::answer(scene, fans))
        }
    }
}

macro_rules! packets {
    ($($module:ident, $width:literal, $rays:ident, $function:ident;)*) => {$(
        mod $module {
            use super::*;

            #[repr(align(64))]
            struct Valid([i32; $width]);

            pub fn answer(scene: sys::RTCScene, fans: &[Fans]) -> Answer {
                let mut packets = packets(fans);
                Box::new(move || trace(&mut packets, scene))
            }

            fn trace(packets: &mut [sys::$rays], scene: sys::RTCScene) -> u32 {
                // Lanes without a ray have a `tnear` beyond `tfar`.
                let valid = Valid([-1; $width]);
                let mut occluded = 0;
                for packet in packets {
                    packet.tfar = [T_FAR; $width];
                    // SAFETY: mask and packet are aligned by their types; the scene is committed.
                    unsafe { sys::$function(valid.0.as_ptr(), scene, packet, true) };
                    occluded += packet.tfar.iter().filter(|&&t| t < 0.0).count() as u32;
                }
                occluded
            }

            fn packets(fans: &[Fans]) -> Vec<sys::$rays> {
                let segments: Vec<_> = fans.iter().flat_map(segments).collect();
                let packet = |rays: &[(Vec3, Vec3)]| {
                    let mut packet = sys::$rays {
                        tnear: [f32::INFINITY; $width],
                        mask: [u32::MAX; $width],
                        ..Default::default()
                    };
                    for (lane, (origin, target)) in rays.iter().enumerate() {
                        let direction = target - origin;
                        packet.tnear[lane] = T_NEAR;
                        packet.org_x[lane] = origin.x;
                        packet.org_y[lane] = origin.y;
                        packet.org_z[lane] = origin.z;
                        packet.dir_x[lane] = direction.x;
                        packet.dir_y[lane] = direction.y;
                        packet.dir_z[lane] = direction.z;
                    }
                    packet
                };
                segments.chunks($width).map(packet).collect()
            }
        }
    )*};
}

packets! {
    sixteen, 16, RTCRay16, shim_occluded16;
    eight, 8, RTCRay8, shim_occluded8;
    four, 4, RTCRay4, shim_occluded4;
}

fn segments(fans: &Fans) -> impl Iterator<Item = (Vec3, Vec3)> {
    (0..fans.len()).flat_map(|fan| {
        let (origin, targets) = fans.fan(fan);
        targets.map(move |target| (origin, target))
    })
}

/// A scene as `visibility::embree` makes it; it lives as long as the program.
fn commit(triangles: &Triangles, device: &CStr) -> sys::RTCScene {
    let (vertices, indices) = (&triangles.vertices, &triangles.indices);
    // SAFETY: straight calls in the documented order; Embree's buffers have room for what is
    // copied into them.
    unsafe {
        let device = sys::rtcNewDevice(device.as_ptr());
        let scene = sys::rtcNewScene(device);
        sys::rtcSetSceneFlags(scene, sys::RTCSceneFlags::RTC_SCENE_FLAG_ROBUST);
        let kind = sys::RTCGeometryType::RTC_GEOMETRY_TYPE_TRIANGLE;
        let geometry = sys::rtcNewGeometry(device, kind);
        let buffer = |kind, format, count| {
            sys::rtcSetNewGeometryBuffer(geometry, kind, 0, format, 12, count)
        };
        let kind = sys::RTCBufferType::RTC_BUFFER_TYPE_VERTEX;
        buffer(kind, sys::RTCFormat::RTC_FORMAT_FLOAT3, vertices.len())
            .cast::<Vec3>()
            .copy_from_nonoverlapping(vertices.as_ptr(), vertices.len());
        let kind = sys::RTCBufferType::RTC_BUFFER_TYPE_INDEX;
        buffer(kind, sys::RTCFormat::RTC_FORMAT_UINT3, indices.len())
            .cast::<[u32; 3]>()
            .copy_from_nonoverlapping(indices.as_ptr(), indices.len());
        sys::rtcCommitGeometry(geometry);
        sys::rtcAttachGeometry(scene, geometry);
        sys::rtcCommitScene(scene);
        scene
    }
}
