use super::*;

/// The solver shares one engine between its threads; the compiler must agree.
#[test]
fn committed_scenes_are_send_and_sync() {
    fn check<T: Send + Sync>() {}
    check::<Embree>();
    check::<CommittedScene>();
    check::<Device>();
}

/// A strip of triangles.
fn strip(count: u32) -> Triangles {
    let vertex = |i: u32| glam::Vec3::new(i as f32, (i % 2) as f32, (i % 7) as f32);
    Triangles {
        vertices: (0..count + 2).map(vertex).collect(),
        indices: (0..count).map(|i| [i, i + 1, i + 2]).collect(),
    }
}

#[test]
fn memory_that_is_refused_is_an_error_with_its_cause_at_every_limit() {
    let triangles = strip(20_000);
    let needed = Embree::new(&triangles, 1, None)
        .expect("there is memory")
        .info()
        .bytes;
    assert!(needed > 20_000 * 12, "{needed}");
    let mut refusals = Vec::new();
    for share in 0..10 {
        match Embree::new(&triangles, 1, Some(needed * share / 20)) {
            Err(VisibilityError::Embree { step, reason }) => {
                assert!(
                    reason.contains("out of memory (more than"),
                    "{step}: {reason}"
                );
                refusals.push(step);
            }
            other => panic!("{share}/20 of the memory: {other:?}"),
        }
    }
    assert!(refusals.contains(&"allocate a buffer"), "{refusals:?}");
    assert!(refusals.contains(&"build its structure"), "{refusals:?}");
    assert!(
        Embree::new(&triangles, 1, Some(8 * needed)).is_ok(),
        "{needed}"
    );
}

#[test]
fn an_instruction_set_that_is_not_there_is_an_error_or_another() {
    // Embree takes what it knows of a configuration, and refuses what it cannot run on.
    for config in [
        "isa=avx1024",
        "threads=1,isa=",
        "=,=,=",
        "verbose=0,nonsense=1",
    ] {
        match Device::open(config, None) {
            Ok(device) => assert!(!device.version().is_empty()),
            Err(error) => assert!(error.to_string().starts_with("Embree cannot"), "{error}"),
        }
    }
    let nul = Device::open("threads=1\0", None).expect_err("is no C string");
    assert!(nul.to_string().contains("NUL"), "{nul}");
}

#[test]
fn a_message_of_embree_reaches_the_error() {
    let device = Device::new(1, None).expect("Embree is installed");
    // SAFETY: the device is valid; a null scene is what Embree refuses with a message.
    let refused = device.step("commit nothing", || unsafe {
        embree4_sys::rtcCommitScene(std::ptr::null_mut());
    });
    // An error without a device belongs to no device: the step itself has succeeded.
    assert!(refused.is_ok());
    let refused = device.step("make a geometry of no kind", || {
        // SAFETY: the device is valid; Embree refuses kinds that it does not know.
        unsafe { embree4_sys::rtcNewGeometry(device.raw(), embree4_sys::RTCGeometryType(9999)) }
    });
    let error = refused.expect_err("there is no such kind").to_string();
    let (_, message) = error.split_once('(').expect("Embree says why");
    assert!(message.len() > 8, "{error}");
}
