//! The arc cosine of eight lanes, compared with SLEEF.

use std::rc::Rc;

use lobe::{Backend, Kernel, Lanes, math};
use lobe_benches::contest::Contender;
use lobe_benches::workload::Input;

use super::comparison::Agreement;
use super::contest::{Contest, Outside};
use super::exchange::Exchange;

/// The number of values, which fit into the first or second cache.
const COUNT: usize = 1 << 14;
/// How often a run goes through all of them, as `acos.c` does.
const PASSES: usize = 64;

/// The contest; its cosines are in a separate file.
///
/// # Errors
/// If this file cannot be written.
pub fn acos(exchange: &Exchange) -> anyhow::Result<Contest> {
    let cosines: Rc<[f32]> = Input::Incoherent.thetas(COUNT).iter().map(|theta| theta.cos() as f32).collect();
    exchange.floats("cosines", &[&cosines])?;
    let backend = Backend::best().fused();
    let run = move |out: &mut Vec<f32>| {
        for _ in 0..PASSES {
            backend.run(Acos { cosines: &cosines, out });
            std::hint::black_box(&*out);
        }
    };
    let sum = math::bounds::ACOS.abs + 3.5 * f64::from(f32::EPSILON);
    Ok(Contest {
        id: "acos",
        on: format!("{COUNT} cosines"),
        unit: "value",
        count: COUNT * PASSES,
        lobe: Contender::new("lobe", Contender::UNCHECKED, vec![f32::NAN; COUNT], run, Vec::clone),
        inside: Vec::new(),
        outside: vec![Outside::new("SLEEF acosf8_u35", "sleef", "acos")],
        // Angles up to pi, each within its bound: 3.5 units in the last place of SLEEF's.
        agreement: Some(Agreement { relative: sum, floor: 1.0, outliers: 0.0 }),
        judge: None,
        goal: Some(1.4),
    })
}

struct Acos<'a> {
    cosines: &'a [f32],
    out: &'a mut [f32],
}

impl Kernel for Acos<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let mut at = 0;
        while at < self.cosines.len() {
            let angle = math::acos(lanes, lanes.load_partial(&self.cosines[at..]));
            lanes.store_partial(&mut self.out[at..], angle);
            at += L::LANES;
        }
    }
}
