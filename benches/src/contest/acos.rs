//! Arc cosines of the arguments that occur in an evaluation.

use std::rc::Rc;

use lobe::math;
use lobe::{Kernel, Lanes};

use super::{Contender, Contest, Tolerance, backends};
use crate::workload::Input;

/// Rounding of an `f32` near pi.
const EXACT: Tolerance = Tolerance { max: 2e-7, rms: 1e-7 };

/// The library's arc cosine.
pub fn eight_terms(input: Input, count: usize) -> Contest {
    contest::<8>(input, count, Tolerance { max: math::bounds::ACOS.abs, rms: 2e-7 })
}

/// The paper's arc cosine.
pub fn four_terms(input: Input, count: usize) -> Contest {
    contest::<4>(input, count, Tolerance { max: math::bounds::PAPER_ACOS.abs, rms: 1e-4 })
}

fn contest<const TERMS: usize>(input: Input, count: usize, tolerance: Tolerance) -> Contest {
    let cosines: Rc<[f32]> = input.thetas(count).iter().map(|theta| theta.cos() as f32).collect();
    let expected: Vec<f64> = cosines.iter().map(|&x| f64::from(x).acos()).collect();
    // Tolerances are relative to the largest value, bounds are in radians.
    let scale = expected.iter().fold(0.0f64, |a, b| a.max(*b));
    let tolerance = Tolerance { max: tolerance.max / scale, rms: tolerance.rms / scale };

    let scalar = |name, acos: fn(f32) -> f32| {
        let cosines = cosines.clone();
        let run = move |out: &mut Vec<f32>| out.iter_mut().zip(&*cosines).for_each(|(out, &x)| *out = acos(x));
        Contender::new(name, EXACT, vec![f32::NAN; count], run, Vec::clone)
    };
    let baselines = vec![
        scalar("libm", f32::acos),
        #[cfg(target_arch = "x86_64")]
        scalar("x87", crate::baseline::x87::acos),
    ];
    let contenders = backends().into_iter().map(|named| {
        let cosines = cosines.clone();
        let run = move |out: &mut Vec<f32>| named.backend.run(Acos::<TERMS> { cosines: &cosines, out });
        Contender::new(named.name, tolerance, vec![f32::NAN; count], run, Vec::clone)
    });
    Contest { count, baselines, contenders: contenders.collect(), expected }
}

struct Acos<'a, const TERMS: usize> {
    cosines: &'a [f32],
    out: &'a mut [f32],
}

impl<const TERMS: usize> Kernel for Acos<'_, TERMS> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let Acos { cosines, out } = self;
        let mut at = 0;
        while at < cosines.len() {
            let x = lanes.load_partial(&cosines[at..]);
            let angle = if TERMS == 4 { math::paper::acos(lanes, x) } else { math::acos(lanes, x) };
            lanes.store_partial(&mut out[at..], angle);
            at += L::LANES;
        }
    }
}
