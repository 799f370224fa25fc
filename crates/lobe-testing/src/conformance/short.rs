//! Checks that every operation on memory refuses slices that are too short.

use std::panic::{AssertUnwindSafe, catch_unwind};

use lobe_lane::{Block, Kernel, Lanes, MAX_LANES};

/// An operation that takes a slice.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Access {
    Load,
    Store,
    LoadInt,
    StoreInt,
    LoadXyz,
    QuadLoad,
    QuadStore,
    OctLoad,
    OctStore,
    Gather,
    GatherPair,
    GatherQuadsAt,
}

impl Access {
    const ALL: [Access; 12] = [
        Access::Load,
        Access::Store,
        Access::LoadInt,
        Access::StoreInt,
        Access::LoadXyz,
        Access::QuadLoad,
        Access::QuadStore,
        Access::OctLoad,
        Access::OctStore,
        Access::Gather,
        Access::GatherPair,
        Access::GatherQuadsAt,
    ];

    /// The length that it needs.
    fn needs(self, lanes: usize) -> usize {
        match self {
            Access::Load | Access::Store | Access::LoadInt | Access::StoreInt | Access::LoadXyz => lanes,
            Access::GatherQuadsAt => lanes,
            Access::QuadLoad | Access::QuadStore => 4,
            Access::OctLoad | Access::OctStore => 8,
            Access::Gather | Access::GatherPair => 1,
        }
    }
}

/// Accesses a slice of `len` elements.
struct Touch {
    access: Access,
    len: usize,
}

impl Kernel for Touch {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let Touch { access, len } = self;
        let (mut floats, mut ints) = (vec![0.0f32; len], vec![0i32; len]);
        match access {
            Access::Load => _ = lanes.load(&floats),
            Access::Store => lanes.store(&mut floats, lanes.splat(1.0)),
            Access::LoadInt => _ = lanes.load_int(&ints),
            Access::StoreInt => lanes.store_int(&mut ints, lanes.iota()),
            Access::LoadXyz => _ = lanes.load_xyz(&vec![[0.0; 3]; len]),
            Access::QuadLoad => _ = lanes.quad_load(&floats),
            Access::QuadStore => lanes.quad_store(&mut floats, lanes.quad_splat(1.0)),
            Access::OctLoad => _ = lanes.oct_load(&floats),
            Access::OctStore => lanes.oct_store(&mut floats, lanes.oct_splat(1.0)),
            Access::Gather => _ = lanes.gather(&floats, lanes.iota()),
            Access::GatherPair => _ = lanes.gather_pair(&vec![[0.0; 2]; len], lanes.iota()),
            Access::GatherQuadsAt => _ = lanes.gather_quads_at(&Block::new(&[0.0; 4], [0]), &ints),
        }
    }
}

/// On a target where a panic ends the program, each access needs a separate process: the environment variable
/// `LOBE_SHORT`, set by `cargo xtask cross`, has the number of the access, and how many elements the slice has more or
/// less than needed.
fn one_access<L: Lanes>(lanes: L) {
    let Ok(wanted) = std::env::var("LOBE_SHORT") else {
        eprintln!("SKIPPED: a panic ends the program on this target");
        return;
    };
    let (access, more) = wanted.split_once(':').expect("two numbers");
    let Some(&access) = Access::ALL.get(access.parse::<usize>().expect("a number")) else {
        eprintln!("there is no access {access}");
        return;
    };
    let len = access.needs(L::LANES).checked_add_signed(more.parse().expect("a number")).expect("a length");
    lanes.vectorize(Touch { access, len });
    eprintln!("{access:?} of a slice of {len} is accepted");
}

/// # Panics
/// If a slice that is too short is accepted, or one that is long enough is refused.
pub fn refuses_short_slices<L: Lanes>(lanes: L) {
    if cfg!(not(panic = "unwind")) {
        return one_access(lanes);
    }
    for access in Access::ALL {
        let needs = access.needs(L::LANES);
        for len in 0..=MAX_LANES {
            let accepted = catch_unwind(AssertUnwindSafe(|| lanes.vectorize(Touch { access, len }))).is_ok();
            assert_eq!(accepted, len >= needs, "{access:?} of a slice of {len}, {needs} needed");
        }
    }
}
