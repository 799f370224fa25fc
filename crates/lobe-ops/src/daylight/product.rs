//! Products of matrices, in the order that takes the fewest operations.

use nalgebra::DMatrix;
use thiserror::Error;

use super::Matrix;

/// The reason why matrices have no product.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum Shapes {
    /// There are no matrices.
    #[error("no matrices; expected at least one")]
    Empty,
    /// A matrix does not have as many columns as the next one has rows.
    #[error("{columns} columns in matrix {index} and {rows} rows in the next; expected equal numbers")]
    Inner {
        /// The index of the first of the two.
        index: usize,
        /// The number of its columns.
        columns: usize,
        /// The number of rows of the next.
        rows: usize,
    },
    /// Two matrices differ in the number of components, and neither has only one.
    #[error("{found} components in matrix {index}; expected 1 or {expected}, as before")]
    Components {
        /// The index of the matrix.
        index: usize,
        /// The number of its components.
        found: usize,
        /// The number of components of the matrices before it.
        expected: usize,
    },
}

/// The product of matrices, component by component. A matrix with one component is used for all components of the
/// others.
///
/// # Errors
/// [`Shapes`] if they have no product.
pub fn product(matrices: &[Matrix]) -> Result<Matrix, Shapes> {
    let mut components = 1;
    for (index, matrix) in matrices.iter().enumerate() {
        let [_, columns, found] = matrix.shape();
        if found != 1 && components != 1 && found != components {
            return Err(Shapes::Components { index, found, expected: components });
        }
        components = components.max(found);
        if let Some(next) = matrices.get(index + 1) {
            let [rows, ..] = next.shape();
            if rows != columns {
                return Err(Shapes::Inner { index, columns, rows });
            }
        }
    }
    let Some(last) = matrices.last() else { return Err(Shapes::Empty) };
    let mut sizes: Vec<usize> = matrices.iter().map(|matrix| matrix.shape()[0]).collect();
    sizes.push(last.shape()[1]);
    let order = order(&sizes);
    let of_component = |component: usize| {
        let factors: Vec<&DMatrix<f64>> = matrices
            .iter()
            .map(|matrix| &matrix.components[if matrix.components.len() == 1 { 0 } else { component }])
            .collect();
        multiplied(&factors, &order, [0, factors.len()])
    };
    Ok(Matrix { components: (0..components).map(of_component).collect() })
}

/// The position at which to split the product of the factors from `first` up to `end`, as `[first][end]`.
fn order(sizes: &[usize]) -> Vec<Vec<usize>> {
    let count = sizes.len() - 1;
    let (mut costs, mut splits) = (vec![vec![0.0; count + 1]; count + 1], vec![vec![0; count + 1]; count + 1]);
    for length in 2..=count {
        for first in 0..=count - length {
            let end = first + length;
            let cost = |split: usize| {
                let multiplied = sizes[first] as f64 * sizes[split] as f64 * sizes[end] as f64;
                costs[first][split] + costs[split][end] + multiplied
            };
            let best = (first + 1..end).map(|split| (cost(split), split)).min_by(|a, b| a.0.total_cmp(&b.0));
            if let Some((cost, split)) = best {
                (costs[first][end], splits[first][end]) = (cost, split);
            }
        }
    }
    splits
}

fn multiplied(factors: &[&DMatrix<f64>], order: &[Vec<usize>], [first, end]: [usize; 2]) -> DMatrix<f64> {
    if end - first == 1 {
        return factors[first].clone();
    }
    let split = order[first][end];
    multiplied(factors, order, [first, split]) * multiplied(factors, order, [split, end])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn matrix(rows: usize, columns: usize, components: usize, seed: u32) -> Matrix {
        let element = |index: usize| ((index as u32 * 37 + seed) % 101) as f64 / 50.0 - 1.0;
        Matrix::new([rows, columns, components], &(0..rows * columns * components).map(element).collect::<Vec<_>>())
    }

    /// Compares with explicit sums; one of the matrices has only one component.
    #[test]
    fn products_are_sums_of_products() {
        let [v, t, s] = [matrix(3, 5, 3, 1), matrix(5, 4, 1, 2), matrix(4, 2, 3, 3)];
        let found = product(&[v.clone(), t.clone(), s.clone()]).expect("a product");
        assert_eq!(found.shape(), [3, 2, 3]);
        for row in 0..3 {
            for column in 0..2 {
                for component in 0..3 {
                    let mut sum = 0.0;
                    for i in 0..5 {
                        for j in 0..4 {
                            sum += v.at(row, i, component) * t.at(i, j, 0) * s.at(j, column, component);
                        }
                    }
                    assert!((found.at(row, column, component) - sum).abs() < 1e-12);
                }
            }
        }
    }

    #[test]
    fn the_cheapest_order_is_chosen() {
        assert_eq!(order(&[1, 100, 100, 100])[0][3], 2);
        assert_eq!(order(&[100, 100, 100, 1])[0][3], 1);
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        assert_eq!(product(&[]), Err(Shapes::Empty));
        let inner = product(&[matrix(2, 3, 1, 0), matrix(4, 1, 1, 0)]);
        assert_eq!(inner, Err(Shapes::Inner { index: 0, columns: 3, rows: 4 }));
        let components = product(&[matrix(2, 3, 2, 0), matrix(3, 1, 3, 0)]);
        assert_eq!(components, Err(Shapes::Components { index: 1, found: 3, expected: 2 }));
    }
}
