//! The cell of an angle on the theta axis of the anisotropic table, and on longer axes, and the fraction into it.

use std::rc::Rc;

use lobe::table::{Cell, paper};
use lobe::{Axis, Edge, Kernel, Lanes};

use super::{Contender, Contest, Tolerance, backends};
use crate::workload::Input;
use crate::{baseline, tables};

/// Tolerance relative to the number of cells: positions up to 16 are rounded to 1e-6, with the same again for knots and
/// widths.
const TOLERANCE: Tolerance = Tolerance { max: 3e-7, rms: 1e-7 };

/// Cells, and fractions into them.
struct Cells<I> {
    cell: Vec<I>,
    fraction: Vec<f32>,
}

impl<I: Copy + Default> Cells<I> {
    fn new(count: usize) -> Self {
        Cells { cell: vec![I::default(); count], fraction: vec![f32::NAN; count] }
    }

    /// Cell and fraction in one number, which unlike the two does not jump at a knot.
    fn positions(&self, as_f32: impl Fn(I) -> f32) -> Vec<f32> {
        self.cell.iter().zip(&self.fraction).map(|(&cell, fraction)| as_f32(cell) + fraction).collect()
    }
}

/// The input shared by all contenders.
struct Setup {
    angles: Vec<f32>,
    axis: Axis,
    /// `[knot, 1 / width]`.
    cells: Vec<[f32; 2]>,
}

/// The library's search.
pub fn library(input: Input, count: usize) -> Contest {
    among(&tables::anisotropic().knots()[2], input, count)
}

/// The same search among 33 knots, the most that AVX2 searches in registers.
pub fn among_33(input: Input, count: usize) -> Contest {
    among(&tables::theta_knots(33), input, count)
}

/// The same search among 65 knots, the most that AVX-512 searches in registers.
pub fn among_65(input: Input, count: usize) -> Contest {
    among(&tables::theta_knots(65), input, count)
}

fn among(knots: &[f64], input: Input, count: usize) -> Contest {
    contest(knots, input, count, |name, backend, setup| {
        let run = move |out: &mut Cells<i32>| backend.run(Find { setup: &setup, out });
        Contender::new(name, TOLERANCE, Cells::new(count), run, |out| out.positions(|cell| cell as f32))
    })
}

/// The paper's search, in the version that returns weights.
pub fn paper(input: Input, count: usize) -> Contest {
    contest(&tables::anisotropic().knots()[2], input, count, |name, backend, setup| {
        let run = move |out: &mut Cells<f32>| backend.run(StackSearch { setup: &setup, out });
        Contender::new(name, TOLERANCE, Cells::new(count), run, |out| out.positions(|cell| cell))
    })
}

fn contest(
    knots: &[f64],
    input: Input,
    count: usize,
    contender: impl Fn(&'static str, lobe::Backend, Rc<Setup>) -> Contender,
) -> Contest {
    let axis = Axis::new(knots, Edge::Clamp).expect("the knots of a valid table");
    let cells = knots.windows(2).map(|ends| [ends[0] as f32, (1.0 / (ends[1] - ends[0])) as f32]).collect();
    let angles: Vec<f32> = input.thetas(count).iter().map(|&theta| theta as f32).collect();
    let expected = angles.iter().map(|&angle| position(knots, f64::from(angle))).collect();
    let setup = Rc::new(Setup { angles, axis, cells });

    let scalar = |name, locate: fn(&[f32], f32) -> (usize, f32)| {
        let setup = setup.clone();
        let run = move |out: &mut Cells<u32>| {
            for ((cell, fraction), &angle) in out.cell.iter_mut().zip(&mut out.fraction).zip(&setup.angles) {
                let found = locate(setup.axis.knots(), angle);
                (*cell, *fraction) = (found.0 as u32, found.1);
            }
        };
        Contender::new(name, TOLERANCE, Cells::new(count), run, |out| out.positions(|cell| cell as f32))
    };
    let baselines = vec![
        scalar("libm", baseline::libm::locate),
        #[cfg(target_arch = "x86_64")]
        scalar("x87", baseline::x87::locate),
    ];
    let contenders = backends().into_iter().map(|named| contender(named.name, named.backend, setup.clone()));
    Contest { count, baselines, contenders: contenders.collect(), expected }
}

fn position(knots: &[f64], angle: f64) -> f64 {
    let angle = angle.clamp(knots[0], knots[knots.len() - 1]);
    let cell = knots[1..knots.len() - 1].partition_point(|&knot| knot <= angle);
    cell as f64 + (angle - knots[cell]) / (knots[cell + 1] - knots[cell])
}

struct Find<'a> {
    setup: &'a Setup,
    out: &'a mut Cells<i32>,
}

impl Kernel for Find<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let Find { setup: Setup { angles, axis, .. }, out } = self;
        assert_eq!(angles.len() % L::LANES, 0, "whole packets");
        let mut at = 0;
        while at < angles.len() {
            let Cell { index, fraction } = axis.cell(lanes, lanes.load(&angles[at..]));
            lanes.store_int(&mut out.cell[at..], index);
            lanes.store(&mut out.fraction[at..], fraction);
            at += L::LANES;
        }
    }
}

struct StackSearch<'a> {
    setup: &'a Setup,
    out: &'a mut Cells<f32>,
}

impl Kernel for StackSearch<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let StackSearch { setup: Setup { angles, axis, cells }, out } = self;
        let mut at = 0;
        while at < angles.len() {
            let mask = lanes.first_n(angles.len() - at);
            let angle = lanes.load_partial(&angles[at..]);
            let (index, [_, upper]) = paper::search::weights(lanes, axis.knots(), cells, angle, mask);
            lanes.store_partial(&mut out.cell[at..], index);
            lanes.store_partial(&mut out.fraction[at..], upper);
            at += L::LANES;
        }
    }
}
