//! Tests of rows of Mueller matrices, against whole matrices in `f64`.

use super::*;

type Matrix = [[f64; 4]; 4];

fn multiplied(a: Matrix, b: Matrix) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..4).map(|k| a[i][k] * b[k][j]).sum()))
}

fn rotation([cos, sin]: Turn) -> Matrix {
    let [cos, sin] = [cos, sin].map(f64::from);
    [[1.0, 0.0, 0.0, 0.0], [0.0, cos, sin, 0.0], [0.0, -sin, cos, 0.0], [0.0, 0.0, 0.0, 1.0]]
}

/// Numbers without a pattern.
fn mueller(seed: usize) -> Mueller<2> {
    let mut elements = [[[0.0f32; 2]; 4]; 4];
    let flat = elements.as_flattened_mut().as_flattened_mut();
    flat.iter_mut().enumerate().for_each(|(k, x)| *x = ((k * 7 + 3 * seed) % 11) as f32 / 11.0 - 0.3);
    Mueller { elements, depolarises: false }
}

fn of<const R: usize>(rows: &Rows<R, 2>, channel: usize) -> Vec<[f64; 4]> {
    rows.elements.iter().map(|row| row.map(|element| f64::from(element[channel]))).collect()
}

fn matrix(mueller: &Mueller<2>, channel: usize) -> Matrix {
    mueller.elements.map(|row| row.map(|element| f64::from(element[channel])))
}

/// The matrix of a surface in the frames of the world.
fn whole(local: Matrix, Bounce { frame, wi, wo }: &Bounce) -> Matrix {
    let (toward, out) = (in_world(frame, neg(*wi)), in_world(frame, *wo));
    let before = doubled(toward, stokes_basis(toward), in_world(frame, stokes_basis(neg(*wi))));
    let after = doubled(out, in_world(frame, stokes_basis(*wo)), stokes_basis(out));
    let sign = if dot(cross(frame[0], frame[1]), frame[2]) < 0.0 { -1.0 } else { 1.0 };
    let mirrored =
        std::array::from_fn(|i| std::array::from_fn(|j| local[i][j] * if (i < 2) == (j < 2) { 1.0 } else { sign }));
    multiplied(multiplied(rotation(after), mirrored), rotation(before))
}

fn bounces() -> [Bounce; 3] {
    let (wi, wo) = ([0.48, 0.36, 0.8], [-0.64, 0.48, 0.6]);
    [
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        [[0.0, 0.6, 0.8], [1.0, 0.0, 0.0], [0.0, 0.8, -0.6]],
        [[0.0, 0.6, 0.8], [-1.0, 0.0, 0.0], [0.0, 0.8, -0.6]],
    ]
    .map(|frame| Bounce { frame, wi, wo })
}

fn assert_near<const R: usize>(found: &Rows<R, 2>, expected: [Matrix; 2]) {
    for (channel, expected) in expected.iter().enumerate() {
        for (found, expected) in of(found, channel).iter().zip(expected) {
            for (found, expected) in found.iter().zip(expected) {
                assert!((found - expected).abs() < 1e-5, "{found}, not {expected}");
            }
        }
    }
}

/// In `f64`, by products of whole matrices.
#[test]
fn paths_multiply_matrices_in_the_frames_of_the_world() {
    for bounce in bounces() {
        let (first, second) = (mueller(1), mueller(5));
        let one = |channel| whole(matrix(&first, channel), &bounce);
        let both = |channel| multiplied(one(channel), whole(matrix(&second, channel), &bounce));
        let rows = Rows::<4, 2>::IDENTITY.bounced(&first, &bounce);
        assert_near(&rows, [0, 1].map(one));
        assert_near(&rows.bounced(&second, &bounce), [0, 1].map(both));
        let energy = Rows::<1, 2>::IDENTITY.bounced(&first, &bounce).bounced(&second, &bounce);
        assert_near(&energy, [0, 1].map(both));
        // After a surface that depolarises, only the first row of the next one counts.
        let share = [0.5, 0.25];
        let depolarised = |channel: usize| {
            let mut grey = [[0.0; 4]; 4];
            grey[0][0] = f64::from(share[channel]);
            multiplied(multiplied(one(channel), grey), whole(matrix(&second, channel), &bounce))
        };
        let rows = rows.bounced(&Mueller::depolarising(share), &bounce);
        assert!(rows.counts_energy);
        assert_near(&rows.bounced(&second, &bounce), [0, 1].map(depolarised));
    }
}

#[test]
fn scattered_light_is_that_of_the_path_after_the_surface() {
    let (emitted, polarised) = ([2.0, 3.0], [0.3, -0.5, 0.4]);
    for bounce in bounces() {
        for start in [
            Rows::<4, 2>::IDENTITY.bounced(&mueller(2), &bounce),
            Rows::IDENTITY.bounced(&mueller(2), &bounce).depolarised(&[0.5, 0.7]),
        ] {
            for matrix in [mueller(3), Mueller::depolarising([0.2, 0.9])] {
                for light in [None, Some(polarised)] {
                    let found = start.of_scattered_light(&matrix, &bounce, &emitted, light);
                    let expected = start.bounced(&matrix, &bounce).of_light(&emitted, light);
                    for (found, expected) in found.as_flattened().iter().zip(expected.as_flattened()) {
                        assert!((found - expected).abs() < 3e-5, "{found}, not {expected}");
                    }
                }
            }
        }
    }
}

#[test]
fn exact_directions_have_the_matrix_of_their_plane() {
    let polarisation = Polarisation { axis: [-0.6, 0.8, 0.0], b: [0.2, -0.4], c: [0.5, 0.1], s: [-0.3, 0.6] };
    let weight = [0.5, 0.8];
    for Bounce { frame, .. } in bounces() {
        let bounce = Bounce { frame, wi: [0.48, 0.36, 0.8], wo: [-0.48, -0.36, 0.8] };
        let plane = |k: usize| {
            let [b, c, s] = [polarisation.b, polarisation.c, polarisation.s].map(|e| f64::from(weight[k] * e[k]));
            let a = f64::from(weight[k]);
            let matrix = [[a, b, 0.0, 0.0], [b, a, 0.0, 0.0], [0.0, 0.0, c, s], [0.0, 0.0, -s, c]];
            let toward = neg(bounce.wi);
            let before = doubled(toward, stokes_basis(toward), polarisation.axis);
            let after = doubled(bounce.wo, polarisation.axis, stokes_basis(bounce.wo));
            whole(multiplied(multiplied(rotation(after), matrix), rotation(before)), &bounce)
        };
        let one = |k: usize| multiplied(whole(matrix(&mueller(4), k), &bounce), plane(k));
        let rows = Rows::<4, 2>::IDENTITY.bounced(&mueller(4), &bounce);
        assert_near(&rows.bounced_exactly(&weight, Some(&polarisation), &bounce), [0, 1].map(one));
        let plain = rows.depolarised(&[1.0; 2]);
        let grey = |k: usize| {
            let mut only = [[0.0; 4]; 4];
            only[0][0] = 1.0;
            multiplied(multiplied(whole(matrix(&mueller(4), k), &bounce), only), plane(k))
        };
        assert_near(&plain.bounced_exactly(&weight, Some(&polarisation), &bounce), [0, 1].map(grey));
    }
}
