//! `cargo xtask sweep`: checks the inverse trigonometry of every backend over every `f32` of `[-1, 1]`.
#![forbid(unsafe_code)]

use std::f64::consts::PI;
use std::sync::atomic::{AtomicU32, Ordering};

use clap::Parser;
use comfy_table::{CellAlignment, Table, presets};
use lobe::{Backend, Kernel, Lanes};
use lobe_math::bounds::{self, Bound};

use xtask_common::Steps;

/// Compare acos and asin on every backend with `f64`, over every `f32` of [-1, 1]
#[derive(Parser, Debug)]
#[command(bin_name = "cargo xtask sweep")]
struct Args {
    /// Check only every N-th float
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..))]
    step: u32,
}

/// The bits of 1: the floats of `[0, 1]` are those whose bits are at most these.
const ONE: u32 = 1f32.to_bits();
/// Arguments per chunk.
const CHUNK: usize = 1 << 14;

/// The functions that are swept, with the stated bounds of each.
const FUNCTIONS: [(&str, Bound); 4] = [
    ("acos", bounds::ACOS),
    ("asin", bounds::ASIN),
    ("paper acos", bounds::PAPER_ACOS),
    ("paper asin", Bound { ulp: f64::INFINITY, ..bounds::PAPER_ACOS }),
];

/// The largest errors found so far, of each function.
type Errors = [Bound; FUNCTIONS.len()];
const NONE: Errors = [Bound { abs: 0.0, ulp: 0.0 }; FUNCTIONS.len()];

/// Sweeps, with a progress bar, and prints a table.
///
/// # Errors
/// If an error is above its stated bound.
fn main() -> anyhow::Result<()> {
    let args = Args::parse();
    let forms: Vec<Backend> = Backend::available()
        .into_iter()
        .flat_map(|b| if b.has_fused_form() { vec![b.strict(), b.fused()] } else { vec![b.strict()] })
        .collect();
    let found = sweep(&forms, args.step);

    let mut table = Table::new();
    table.load_style(presets::UTF8_HORIZONTAL_ONLY);
    table.set_header(["backend", "form", "function", "largest error", "bound", "ULP", "bound", ""]);
    for column in 3..7 {
        table.column_mut(column).expect("a column").set_cell_alignment(CellAlignment::Right);
    }
    let mut faults = 0;
    for (backend, errors) in forms.iter().zip(found) {
        for ((name, bound), error) in FUNCTIONS.into_iter().zip(errors) {
            let ulp = |ulp: f64| if bound.ulp.is_finite() { format!("{ulp:.2}") } else { "-".into() };
            let ok = error.abs <= bound.abs && error.ulp <= bound.ulp;
            faults += usize::from(!ok);
            table.add_row([
                backend.name().to_string(),
                if backend.is_strict() { "strict" } else { "fused" }.to_string(),
                name.to_string(),
                format!("{:.3e}", error.abs),
                format!("{:.3e}", bound.abs),
                ulp(error.ulp),
                ulp(bound.ulp),
                if ok { "ok" } else { "FAILED" }.to_string(),
            ]);
        }
    }
    println!("{table}");
    println!("{} floats", 2 * (u64::from(ONE / args.step) + 1));
    anyhow::ensure!(faults == 0, "{faults} errors above their bounds");
    Ok(())
}

/// The largest errors of each backend over each `step`-th float of `[0, 1]` and its negative, on all cores.
fn sweep(backends: &[Backend], step: u32) -> Vec<Errors> {
    let count = ONE / step + 1;
    let chunks = count.div_ceil(CHUNK as u32);
    let steps = Steps::new(u64::from(chunks));
    let next = AtomicU32::new(0);
    let work = || {
        let mut errors = vec![NONE; backends.len()];
        let mut chunk = Chunk::new();
        loop {
            let at = next.fetch_add(1, Ordering::Relaxed);
            if at >= chunks {
                return errors;
            }
            chunk.fill((0..CHUNK as u32).map(|i| f32::from_bits((at * CHUNK as u32 + i).min(count - 1) * step)));
            for (backend, errors) in backends.iter().zip(&mut errors) {
                chunk.measure(*backend, errors);
            }
            steps.done(1);
        }
    };
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let all: Vec<Vec<Errors>> = std::thread::scope(|scope| {
        let running: Vec<_> = (0..threads).map(|_| scope.spawn(work)).collect();
        running.into_iter().map(|thread| thread.join().expect("a thread that does not panic")).collect()
    });
    all.into_iter().fold(vec![NONE; backends.len()], |mut most, errors| {
        for (most, error) in most.iter_mut().flatten().zip(errors.iter().flatten()) {
            most.abs = most.abs.max(error.abs);
            most.ulp = most.ulp.max(error.ulp);
        }
        most
    })
}

/// Arguments, the exact results, and room for those of a backend.
struct Chunk {
    xs: Vec<f32>,
    acos: Vec<Truth>,
    asin: Vec<Truth>,
    out: Vec<f32>,
}

/// An exact result, and the number of `f32` steps per unit there, 0 if no ULP bound is given.
#[derive(Clone, Copy)]
struct Truth {
    value: f64,
    steps_a_unit: f64,
}

impl Truth {
    fn new(value: f64) -> Self {
        let size = value.abs();
        if size < bounds::ULP_FROM {
            return Truth { value, steps_a_unit: 0.0 };
        }
        let below = size as f32;
        Truth { value, steps_a_unit: 1.0 / (f64::from(below.next_up()) - f64::from(below)) }
    }
}

impl Chunk {
    fn new() -> Self {
        let truth = || Vec::with_capacity(2 * CHUNK);
        Chunk { xs: Vec::with_capacity(2 * CHUNK), acos: truth(), asin: truth(), out: vec![0.0; 2 * CHUNK] }
    }

    /// Takes `CHUNK` arguments, which are positive, and their negatives.
    fn fill(&mut self, arguments: impl Iterator<Item = f32>) {
        self.xs.clear();
        self.acos.clear();
        self.asin.clear();
        for x in arguments {
            let (acos, asin) = (f64::from(x).acos(), f64::from(x).asin());
            self.xs.extend([x, -x]);
            self.acos.extend([acos, PI - acos].map(Truth::new));
            self.asin.extend([asin, -asin].map(Truth::new));
        }
    }

    fn measure(&mut self, backend: Backend, errors: &mut Errors) {
        for (function, error) in errors.iter_mut().enumerate() {
            let Chunk { xs, out, .. } = self;
            backend.run(Apply { function, xs, out });
            let truths = if function % 2 == 0 { &self.acos } else { &self.asin };
            for (&found, truth) in self.out.iter().zip(truths) {
                let abs = (f64::from(found) - truth.value).abs();
                // A NaN must not get lost in a maximum.
                let abs = if abs.is_nan() { f64::INFINITY } else { abs };
                error.abs = error.abs.max(abs);
                error.ulp = error.ulp.max(abs * truth.steps_a_unit);
            }
        }
    }
}

/// One of [`FUNCTIONS`] over a slice whose length is a multiple of all lanes.
struct Apply<'a> {
    function: usize,
    xs: &'a [f32],
    out: &'a mut [f32],
}

impl Kernel for Apply<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let Apply { function, xs, out } = self;
        let mut at = 0;
        while at < xs.len() {
            let x = lanes.load(&xs[at..]);
            let value = match function {
                0 => lobe_math::acos(lanes, x),
                1 => lobe_math::asin(lanes, x),
                2 => lobe_math::paper::acos(lanes, x),
                _ => lobe_math::paper::asin(lanes, x),
            };
            lanes.store(&mut out[at..], value);
            at += L::LANES;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_coarse_sweep_is_within_the_bounds_and_not_far_below() {
        for errors in sweep(&Backend::available(), 10_007) {
            for ((name, bound), error) in FUNCTIONS.into_iter().zip(errors) {
                assert!(error.abs <= bound.abs && error.ulp <= bound.ulp, "{name}: {error:?}");
                assert!(error.abs > bound.abs / 8.0, "{name}: {error:?}");
            }
        }
    }

    #[test]
    fn a_wrong_result_is_detected() {
        let mut chunk = Chunk::new();
        chunk.fill([0.0, 0.5, 1.0].into_iter().cycle().take(CHUNK));
        let mut errors = NONE;
        chunk.measure(Backend::available()[0], &mut errors);
        assert!(errors[0].abs < bounds::ACOS.abs);
        chunk.acos[3].value += 1e-3;
        chunk.measure(Backend::available()[0], &mut errors);
        assert!(errors[0].abs > 9e-4);
    }
}
