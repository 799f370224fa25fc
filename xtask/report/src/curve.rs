//! The error of the arc cosine over [-1, 1]: Fig. 2 of the paper, for four terms and for eight.

use lobe::{Backend, Kernel, Lanes, math};

use xtask_common::svg::{Anchor, Svg, step};

const WIDTH: f64 = 360.0;
const HEIGHT: f64 = 230.0;
const LEFT: f64 = 62.0;
const RIGHT: f64 = 14.0;
const TOP: f64 = 26.0;
const BOTTOM: f64 = 30.0;

/// Columns of the picture, and arguments in each: the error of an `f32` function is a band, not a line.
const COLUMNS: usize = 560;
const SAMPLES: usize = 64;

/// The picture of one polynomial.
pub fn curve(title: &str, terms: Terms) -> String {
    let band = band(terms);
    let most = band.iter().flatten().fold(0.0f64, |most, error| most.max(error.abs()));
    let mut svg = Svg::new(WIDTH, HEIGHT, &format!("Error of the arc cosine, {title}"));
    let x = |at: f64| LEFT + (at + 1.0) / 2.0 * (WIDTH - LEFT - RIGHT);
    let y = |error: f64| TOP + (1.0 - error / (1.1 * most)) / 2.0 * (HEIGHT - TOP - BOTTOM);

    svg.text("name", [0.0, 14.0], Anchor::Start, title);
    svg.text("tick", [WIDTH - RIGHT, 14.0], Anchor::End, &format!("largest {most:.1e} rad"));
    let step = step(most);
    let ticks = (1.1 * most / step) as i32;
    for tick in -ticks..=ticks {
        let error = f64::from(tick) * step;
        svg.line("grid", [LEFT, y(error)], [WIDTH - RIGHT, y(error)]);
        let label = if tick == 0 { "0".into() } else { format!("{error:.1e}") };
        svg.text("tick", [LEFT - 6.0, y(error) + 4.0], Anchor::End, &label);
    }
    for tick in [-1.0, -0.5, 0.0, 0.5, 1.0] {
        svg.line("grid", [x(tick), TOP], [x(tick), HEIGHT - BOTTOM]);
        svg.text("tick", [x(tick), HEIGHT - BOTTOM + 16.0], Anchor::Middle, &format!("{tick}"));
    }
    let column = |at: usize| x(2.0 * (at as f64 + 0.5) / COLUMNS as f64 - 1.0);
    let upper = (0..COLUMNS).map(|at| [column(at), y(band[at][1])]);
    let lower = (0..COLUMNS).rev().map(|at| [column(at), y(band[at][0])]);
    svg.polygon("band", upper.chain(lower));
    svg.finish()
}

/// The polynomials.
#[derive(Clone, Copy, Debug)]
pub enum Terms {
    /// The polynomial of the paper.
    Four,
    /// The polynomial of the library.
    Eight,
}

/// The least and the greatest error of each column, in radians.
fn band(terms: Terms) -> Vec<[f64; 2]> {
    let count = COLUMNS * SAMPLES;
    let arguments: Vec<f32> = (0..count).map(|i| (2.0 * i as f64 / (count - 1) as f64 - 1.0) as f32).collect();
    let mut angles = vec![0.0; count];
    Backend::best().run(Acos { terms, arguments: &arguments, angles: &mut angles });
    let columns = arguments.chunks(SAMPLES).zip(angles.chunks(SAMPLES));
    columns
        .map(|(arguments, angles)| {
            let errors = arguments.iter().zip(angles).map(|(&x, &angle)| f64::from(angle) - f64::from(x).acos());
            errors.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], e| [least.min(e), most.max(e)])
        })
        .collect()
}

struct Acos<'a> {
    terms: Terms,
    arguments: &'a [f32],
    angles: &'a mut [f32],
}

impl Kernel for Acos<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let Acos { terms, arguments, angles } = self;
        for (x, angle) in arguments.chunks(L::LANES).zip(angles.chunks_mut(L::LANES)) {
            let x = lanes.load_partial(x);
            let acos = match terms {
                Terms::Four => math::paper::acos(lanes, x),
                Terms::Eight => math::acos(lanes, x),
            };
            lanes.store_partial(angle, acos);
        }
    }
}
