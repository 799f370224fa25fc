//! The uncertainties of the parameters.

use std::f64::consts::TAU;

use nalgebra::{DMatrix, SymmetricEigen};

use crate::geometry::Geometry;

/// A direction of the parameters that changes the residuals by less than this, relative to the one that changes them
/// most, is not determined by them.
const UNDETERMINED: f64 = 1e-12;

/// The standard deviations of the parameters that are `free` to move; `None` for those that are not, or that the
/// measurement does not determine.
///
/// `rows` are residuals `[pair][channel]` and `slopes` their derivatives, row by row. The estimate needs no assumption
/// on the size of the noise in each direction (the sandwich of P. Huber and H. White). It is made twice, with the
/// residuals of all pairs independent of each other, and with those of neighbouring pairs summed, because the errors of
/// an interpolation, of an instrument and of a model are similar there; the larger is used.
pub(crate) fn deviations(pairs: &[Geometry], rows: &[f64], slopes: &[f64], free: &[bool]) -> Vec<Option<f64>> {
    let (width, count) = (free.len(), rows.len() / pairs.len().max(1));
    let kept: Vec<usize> = (0..width).filter(|&column| free[column]).collect();
    let size = kept.len();
    let mut deviations = vec![None; width];
    if size == 0 || rows.len() <= size {
        return deviations;
    }
    let mut scales = vec![0.0; size];
    for row in slopes.chunks_exact(width) {
        kept.iter().zip(&mut scales).for_each(|(&column, scale)| *scale += row[column] * row[column]);
    }
    let scales: Vec<f64> = scales.iter().map(|square: &f64| square.sqrt()).collect();
    let scaled = |row: &[f64], index: usize| {
        if scales[index] > 0.0 { row[kept[index]] / scales[index] } else { 0.0 }
    };
    let clusters = clusters(pairs);
    let groups = clusters.iter().max().map_or(0, |last| last + 1);
    let mut normal = DMatrix::<f64>::zeros(size, size);
    let mut single = DMatrix::<f64>::zeros(size, size);
    let mut sums = DMatrix::<f64>::zeros(size, groups);
    for (index, row) in slopes.chunks_exact(width).enumerate() {
        let residual = rows[index];
        for a in 0..size {
            let left = scaled(row, a);
            sums[(a, clusters[index / count])] += left * residual;
            for b in 0..=a {
                let product = left * scaled(row, b);
                normal[(a, b)] += product;
                single[(a, b)] += product * residual * residual;
            }
        }
    }
    normal.fill_upper_triangle_with_lower_triangle();
    single.fill_upper_triangle_with_lower_triangle();
    let eigen = SymmetricEigen::new(normal);
    let most = eigen.eigenvalues.max();
    let is_sound = |value: f64| value > UNDETERMINED * most;
    let inverse = {
        let values = eigen.eigenvalues.map(|value| if is_sound(value) { value.recip() } else { 0.0 });
        &eigen.eigenvectors * DMatrix::from_diagonal(&values) * eigen.eigenvectors.transpose()
    };
    let used = pairs.len() as f64 * count as f64;
    let single = &inverse * single * &inverse * (used / (used - size as f64));
    let joint = if groups > size + 1 {
        let factor = groups as f64 / (groups as f64 - 1.0);
        &inverse * (&sums * sums.transpose()) * &inverse * factor
    } else {
        DMatrix::zeros(size, size)
    };
    for (index, &column) in kept.iter().enumerate() {
        let is_undetermined = (0..size)
            .any(|other| !is_sound(eigen.eigenvalues[other]) && eigen.eigenvectors[(index, other)].abs() > 1e-3);
        let variance = single[(index, index)].max(joint[(index, index)]);
        if !is_undetermined && variance.is_finite() && scales[index] > 0.0 {
            deviations[column] = Some(variance.max(0.0).sqrt() / scales[index]);
        }
    }
    deviations
}

/// The cluster of each pair: those of neighbouring directions of the light and of the viewer about the mirror
/// direction.
fn clusters(pairs: &[Geometry]) -> Vec<usize> {
    const DISTANCES: usize = 8;
    const RINGS: usize = 4;
    const SECTORS: usize = 4;
    let mut order: Vec<f64> = pairs.iter().map(Geometry::off_mirror).collect();
    order.sort_by(f64::total_cmp);
    let limits: Vec<f64> = (1..DISTANCES).map(|index| order[index * order.len() / DISTANCES]).collect();
    let key = |pair: &Geometry| {
        let distance = limits.partition_point(|limit| *limit <= pair.off_mirror());
        let ring = ((RINGS as f64 * (1.0 - pair.cos_i().powi(2))) as usize).min(RINGS - 1);
        let azimuth = (pair.wi[1] + pair.wo[1]).atan2(pair.wi[0] + pair.wo[0]).rem_euclid(TAU);
        let sector = ((SECTORS as f64 * azimuth / TAU) as usize).min(SECTORS - 1);
        (distance * RINGS + ring) * SECTORS + sector
    };
    let keys: Vec<usize> = pairs.iter().map(key).collect();
    let mut used = keys.clone();
    used.sort_unstable();
    used.dedup();
    keys.iter().map(|key| used.partition_point(|other| other < key)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pairs() -> Vec<Geometry> {
        lobe_ops::direction_pairs(600, 1.3).into_iter().map(|(wi, wo)| Geometry::new(wi, wo)).collect()
    }

    /// The deviation of a mean is that of the values divided by the square root of their number.
    #[test]
    fn a_mean_has_the_right_uncertainty() {
        let pairs = pairs();
        let rows: Vec<f64> = (0..pairs.len()).map(|index| if index % 2 == 0 { 0.1 } else { -0.1 }).collect();
        let slopes = vec![1.0; rows.len()];
        let found = deviations(&pairs, &rows, &slopes, &[true])[0].expect("a deviation");
        let expected = 0.1 / (rows.len() as f64).sqrt();
        assert!((0.99..2.0).contains(&(found / expected)), "{found} for {expected}");
        // Errors that are similar for neighbouring directions contain less information.
        let rows: Vec<f64> = pairs.iter().map(|pair| if pair.off_mirror() < 0.3 { 0.1 } else { -0.1 }).collect();
        let alike = deviations(&pairs, &rows, &slopes, &[true])[0].expect("a deviation");
        assert!(alike > 1.8 * expected, "{alike} and {expected}");
    }

    #[test]
    fn undetermined_parameters_have_no_deviation() {
        let pairs = pairs();
        let rows: Vec<f64> = (0..pairs.len()).map(|index| (index as f64).sin()).collect();
        // The first two have the same effect on all residuals, the last has none; the fourth is not free.
        let of_pair = |pair: &Geometry| [pair.cos_i(), 2.0 * pair.cos_i(), pair.cos_o(), 1.0, 0.0];
        let slopes: Vec<f64> = pairs.iter().flat_map(of_pair).collect();
        let found = deviations(&pairs, &rows, &slopes, &[true, true, true, false, true]);
        let is_known: Vec<bool> = found.iter().map(Option::is_some).collect();
        assert_eq!(is_known, [false, false, true, false, false], "{found:?}");
    }
}
