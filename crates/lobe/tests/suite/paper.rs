//! The paper's kernel on every backend, against the reference evaluation and against a search one lane at a time.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use lobe::math::bounds;
use lobe::table::paper::{PaperError, PaperTable, search};
use lobe::table::specular::coords::{angles_to_directions, directions_to_angles};
use lobe::table::specular::reference;
use lobe::{Backend, Channels, Directions, Edges, Kernel, Lanes, Scatter, specular};

/// Every backend of this machine, fused and strict, and its name.
fn backends() -> impl Iterator<Item = (String, Backend)> {
    Backend::available()
        .into_iter()
        .flat_map(|b| [(format!("{b} fused"), b.fused()), (format!("{b} strict"), b.strict())])
}

/// The steepest slope of [`smooth`] along each angle, per radian.
const SLOPES: [f64; 4] = [0.3, 0.2, 0.4, 0.2];

/// A smooth function of the four angles, periodic in psi and phi. No table of it is steeper than the function.
fn smooth([sigma, psi, theta, phi]: [f64; 4], channel: usize) -> f64 {
    let slow = [1.0, 0.5, 0.7][channel];
    1.0 + slow * (0.3 * sigma.sin() + 0.2 * psi.cos() + 0.4 * (-theta).exp() + 0.2 * phi.sin())
}

fn samples(psi: Vec<f64>) -> specular::Data {
    let theta = (0..8).map(|i| PI * (f64::from(i) / 7.0).powi(2)).collect();
    let knots = [
        vec![0.0, 0.1, 0.4, 0.9, 1.2, 1.5, FRAC_PI_2],
        psi,
        theta,
        (0..13).map(|i| TAU / 13.0 * f64::from(i)).collect(),
    ];
    let mut values = Vec::new();
    for &s in &knots[0] {
        for &p in &knots[1] {
            for &t in &knots[2] {
                for &h in &knots[3] {
                    values.extend((0..3).map(|channel| smooth([s, p, t, h], channel) as f32));
                }
            }
        }
    }
    specular::Data::new(Scatter::Reflection, knots, Channels::Rgb, values).unwrap()
}

fn tables() -> [specular::Data; 2] {
    [samples(vec![0.0]), samples(vec![0.0, 0.7, 1.9, 3.0, 4.4, 5.5])]
}

/// Pairs of directions above the horizon, `count` per axis, in scan order (coherent) or scattered.
fn pairs(coherent: bool) -> Vec<[[f32; 3]; 2]> {
    let mut pairs = Vec::new();
    for i in 0..4001u32 {
        // A large odd stride visits every angle once, far from the one before.
        let at = if coherent { i } else { i * 1597 % 4001 };
        let part = |turns: f64| (f64::from(at) / 4001.0 * turns).fract();
        let angles = [0.02 + 1.5 * part(1.0), TAU * part(3.0), 0.03 + 3.0 * part(11.0), TAU * part(5.0)];
        let (wi, wo) = angles_to_directions(angles, |sigma| sigma);
        if wo[2] > 1e-3 {
            pairs.push([wi, wo].map(|w| w.map(|x| x as f32)));
        }
    }
    pairs
}

/// Evaluates all pairs: `[query][channel]`.
fn evaluate(backend: Backend, table: &PaperTable, pairs: &[[[f32; 3]; 2]]) -> Vec<[f32; 3]> {
    let wi: Vec<_> = pairs.iter().map(|pair| pair[0]).collect();
    let wo: Vec<_> = pairs.iter().map(|pair| pair[1]).collect();
    let [mut r, mut g, mut b] = [(); 3].map(|()| vec![f32::NAN; pairs.len()]);
    backend.run(table.batch((&wi).into(), (&wo).into(), [&mut r, &mut g, &mut b]));
    (0..pairs.len()).map(|i| [r[i], g[i], b[i]]).collect()
}

/// How far the arc cosine moves if its argument, the cosine of `angle`, is `delta` off.
fn shaken(angle: f64, delta: f64) -> f64 {
    let acos = |shift: f64| (angle.cos() + shift).clamp(-1.0, 1.0).acos();
    (acos(delta) - angle).abs().max((acos(-delta) - angle).abs())
}

/// The error that four terms and the rounding of the cosines leave in a value at `angles`.
fn tolerance(angles: [f64; 4]) -> f64 {
    // A cosine has about five roundings of numbers of size 1; for psi and phi, it is divided by their radius.
    let rounding = 5.0 * f64::from(f32::EPSILON);
    let radius = [1.0, angles[0].sin(), 1.0, angles[2].sin()];
    let errors =
        (0..4).map(|axis| SLOPES[axis] * (bounds::PAPER_ACOS.abs + shaken(angles[axis], rounding / radius[axis])));
    errors.sum::<f64>() + 8.0 * f64::from(f32::EPSILON)
}

#[test]
fn values_are_the_reference_within_the_error_of_four_terms() {
    for samples in tables() {
        let table = PaperTable::new(&samples).unwrap();
        for coherent in [true, false] {
            let pairs = pairs(coherent);
            assert!(pairs.len() > 1500, "only {} queries", pairs.len());
            for (name, backend) in backends() {
                let mut largest: f64 = 0.0;
                for (pair, got) in pairs.iter().zip(evaluate(backend, &table, &pairs)) {
                    let [wi, wo] = pair.map(|w| w.map(f64::from));
                    let mut expected = [0.0; 3];
                    reference::eval(&samples, &Edges::default(), wi, wo, &mut expected);
                    let allowed = tolerance(directions_to_angles(wi, wo, |sigma| sigma));
                    for channel in 0..3 {
                        let error = (f64::from(got[channel]) - expected[channel]).abs();
                        assert!(error <= allowed, "{name}: {pair:?} gave {got:?}, not {expected:?} within {allowed:e}");
                        largest = largest.max(error);
                    }
                }
                // The error of the polynomial is visible, so the paper's kernel ran and not the library's.
                assert!(largest > 1e-5, "{name}: {largest:e}");
            }
        }
    }
}

/// Interpolating equal values gives that value, even if the angles have no meaning.
#[test]
fn degenerate_directions_give_a_value_of_the_table_or_zero() {
    let flat = |psi: Vec<f64>| {
        let knots = [vec![0.0, 1.5], psi, vec![0.0, 0.1, PI], vec![0.0, 2.0, TAU]];
        let count = 3 * knots.iter().map(Vec::len).product::<usize>();
        PaperTable::new(&specular::Data::new(Scatter::Reflection, knots, Channels::Rgb, vec![2.0; count]).unwrap())
            .unwrap()
    };
    let up = [0.0, 0.0, 1.0];
    let inside = [[up, up], [[0.6, 0.0, 0.8], [-0.6, 0.0, 0.8]], [[0.6, 0.0, 0.8]; 2], [up, [0.6, 0.0, 0.8]]];
    let (nan, inf) = (f32::NAN, f32::INFINITY);
    let outside = [
        [up, [0.0, 0.0, -1.0]],
        [[1.0, 0.0, 0.0], up],
        [[nan, 0.0, 1.0], up],
        [up, [0.0, inf, 1.0]],
        [up, [0.0, 0.0, nan]],
    ];
    for table in [flat(vec![0.0]), flat(vec![0.0, 3.0])] {
        for (name, backend) in backends() {
            // All in one batch: a lane that has no value must not disturb its neighbours.
            let queries: Vec<_> = inside.iter().chain(&outside).copied().collect();
            for (i, value) in evaluate(backend, &table, &queries).into_iter().enumerate() {
                let expected = if i < inside.len() { 2.0 } else { 0.0 };
                assert!(value.iter().all(|v| (v - expected).abs() < 1e-6), "{name}: query {i} gave {value:?}");
            }
        }
    }
}

/// The results of the three searches for all of `x`: index, both weights, and the value of a function.
struct Searches<'a> {
    knots: &'a [f32],
    values: &'a [f32],
    x: &'a [f32],
    /// Lanes that take part, one bit each.
    mask: u32,
}

impl Kernel for Searches<'_> {
    type Out = Vec<[f32; 5]>;

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> Self::Out {
        let Searches { knots, values, x, mask } = self;
        let cells: Vec<_> = knots.windows(2).map(|k| [k[0], 1.0 / (k[1] - k[0])]).collect();
        let slope = |i: usize| (values[i + 1] - values[i]) / (knots[i + 1] - knots[i]);
        let lines: Vec<_> = (0..cells.len()).map(|i| [values[i], slope(i)]).collect();
        let lane_mask = (0..L::LANES).fold(lanes.first_n(0), |sum, lane| {
            let one = lanes.first_n(lane + 1) ^ lanes.first_n(lane);
            if mask >> lane & 1 == 1 { sum | one } else { sum }
        });
        let mut found = Vec::new();
        for packet in x.chunks(L::LANES) {
            let x = lanes.load_partial(packet);
            let index = search::index(lanes, knots, x, lane_mask);
            let (again, weights) = search::weights(lanes, knots, &cells, x, lane_mask);
            let value = search::value(lanes, knots, &lines, x, lane_mask);
            found.extend(
                (0..packet.len()).map(|lane| {
                    [index, again, weights[0], weights[1], value].map(|column| lanes.extract(column, lane))
                }),
            );
        }
        found
    }
}

#[test]
fn all_searches_agree_with_one_lane_at_a_time() {
    for knot_count in [2, 3, 7, 8, 13, 17, 90] {
        let knots: Vec<f32> = (0..knot_count).map(|i| (i as f32 / knot_count as f32).powi(2) + 0.125).collect();
        let values: Vec<f32> = (0..knot_count).map(|i| ((i * 7) % 5) as f32).collect();
        // The knots themselves, and values between and outside them, scattered so that every lane takes a different
        // branch.
        let last = knots[knot_count - 1];
        let spread = (0..997u32).map(|i| (i * 619 % 997) as f32 / 997.0 * last);
        let mut x: Vec<f32> = knots.iter().copied().chain(spread).chain([-1.0, 0.0, last, last + 1.0]).collect();
        // And a run of equal ones: the coherent path.
        x.extend([0.3; 32]);
        for (name, backend) in backends() {
            for mask in [u32::MAX, 0b1010_1010_0101_0110, 1, 0] {
                let found = backend.run(Searches { knots: &knots, values: &values, x: &x, mask });
                assert_eq!(found.len(), x.len());
                for (i, (x, found)) in x.iter().zip(found).enumerate() {
                    if mask >> (i % backend.lanes()) & 1 == 0 {
                        assert_eq!(found, [0.0; 5], "{name}: a lane left out");
                        continue;
                    }
                    let cell = knots.partition_point(|knot| knot <= x).clamp(1, knot_count - 1) - 1;
                    let fraction = (x - knots[cell]) / (knots[cell + 1] - knots[cell]);
                    let value = values[cell] + fraction * (values[cell + 1] - values[cell]);
                    let [index, again, lower, upper, result] = found;
                    assert_eq!((index, again), (cell as f32, cell as f32), "{name}: {x} among {knot_count} knots");
                    let close = |a: f32, b: f32| (a - b).abs() <= 4e-6 * b.abs().max(1.0);
                    assert!(
                        close(upper, fraction) && close(lower, 1.0 - fraction) && close(result, value),
                        "{name}: {x}"
                    );
                }
            }
        }
    }
}

/// A table evaluated through components gives the bits of one evaluated through vectors.
#[test]
fn components_and_vectors_give_the_same() {
    let pairs = pairs(false);
    let table = PaperTable::new(&tables()[1]).unwrap();
    let column = |side: usize, k: usize| -> Vec<f32> { pairs.iter().map(|pair| pair[side][k]).collect() };
    let columns = [0, 1].map(|side| [0, 1, 2].map(|k| column(side, k)));
    let [wi, wo] = columns.each_ref().map(|[x, y, z]| Directions::columns(x, y, z));
    for (_, backend) in backends() {
        let mut out = [(); 3].map(|()| vec![f32::NAN; pairs.len()]);
        let [r, g, b] = &mut out;
        backend.run(table.batch(wi, wo, [r, g, b]));
        for (i, expected) in evaluate(backend, &table, &pairs).into_iter().enumerate() {
            assert_eq!([out[0][i], out[1][i], out[2][i]], expected);
        }
    }
}

#[test]
fn unsupported_tables_are_refused() {
    let one = |scatter, channels: Channels, phi: Vec<f64>| {
        let knots = [vec![0.0, 1.0], vec![0.0], vec![0.0, 1.0], phi];
        let count = channels.count() * knots.iter().map(Vec::len).product::<usize>();
        PaperTable::new(&specular::Data::new(scatter, knots, channels, vec![1.0; count]).unwrap()).map(|_| ())
    };
    let circle = vec![0.0, 3.0];
    assert_eq!(one(Scatter::Reflection, Channels::Rgb, circle.clone()), Ok(()));
    for refused in [
        one(Scatter::Transmission, Channels::Rgb, circle.clone()),
        one(Scatter::Reflection, Channels::Mono, circle),
        one(Scatter::Reflection, Channels::Rgb, vec![0.0]),
    ] {
        assert!(matches!(refused, Err(PaperError::Unsupported { .. })), "{refused:?}");
    }
}
