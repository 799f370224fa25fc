//! How many values of a function its distribution may take: those of the survey that decides where the grid is fine,
//! and those of the slices.

/// A number of evaluations.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Budget(usize);

impl Budget {
    /// No more than `evaluations`, if any number is given.
    pub(crate) fn of(evaluations: Option<usize>) -> Self {
        Budget(evaluations.unwrap_or(usize::MAX))
    }

    /// What a survey leaves.
    pub(crate) fn after(self, survey: &Survey) -> Self {
        match self.0 {
            usize::MAX => self,
            all => Budget(all.saturating_sub(survey.evaluations())),
        }
    }

    /// `true` if this number of cells can be evaluated at `points` by `points` midpoints each.
    pub(crate) fn allows(self, cells: usize, points: usize) -> bool {
        cells.saturating_mul(points * points) <= self.0
    }

    /// The number of midpoints of each cell along each axis: `wanted`, or as many as can be evaluated, at least one.
    pub(crate) fn points(self, cells: usize, wanted: usize) -> usize {
        (1..=wanted).rev().find(|&points| self.allows(cells, points)).unwrap_or(1)
    }
}

/// Which slices are surveyed, and how finely.
#[derive(Clone, Debug)]
pub(crate) struct Survey {
    /// The number of slices, of which every `stride`-th is surveyed.
    pub(crate) slices: usize,
    pub(crate) stride: usize,
    /// The edges of rows and columns.
    pub(crate) rows: Vec<f64>,
    pub(crate) columns: Vec<f64>,
}

/// A survey takes at most this part of a budget.
const SHARE: usize = 4;
/// With fewer slices than this, cells are made larger first.
const FEW_SLICES: usize = 8;
/// Rows and columns are not made fewer than this.
const FEW_CELLS: usize = 32;

impl Survey {
    fn surveyed(&self) -> usize {
        self.slices.div_ceil(self.stride)
    }

    /// One per cell of each surveyed slice.
    fn evaluations(&self) -> usize {
        self.surveyed() * (self.rows.len() - 1) * (self.columns.len() - 1)
    }

    /// Leaves out slices and edges until the survey takes little of the budget. Returns whether any were left out.
    pub(crate) fn limit(&mut self, budget: Budget) -> bool {
        let mut is_limited = false;
        while self.evaluations() > budget.0 / SHARE {
            let finer = if self.rows.len() > self.columns.len() { &mut self.rows } else { &mut self.columns };
            let can_be_coarser = finer.len() > 2 * FEW_CELLS;
            if self.slices > FEW_SLICES * self.stride || (!can_be_coarser && self.slices > self.stride) {
                // An odd stride, so that not all slices have the same azimuth.
                self.stride = 2 * self.stride + 1;
            } else if can_be_coarser {
                thin(finer);
            } else {
                return is_limited;
            }
            is_limited = true;
        }
        is_limited
    }
}

/// Leaves out every other edge, but not the last.
fn thin(edges: &mut Vec<f64>) {
    let last = edges.len() - 1;
    let kept = edges.iter().enumerate().filter(|(at, _)| at.is_multiple_of(2) || *at == last);
    *edges = kept.map(|(_, edge)| *edge).collect();
}

#[cfg(test)]
mod tests {
    use super::*;

    fn survey() -> Survey {
        let edges = |count: usize| (0..=count).map(|edge| edge as f64 / count as f64).collect();
        Survey { slices: 192, stride: 6, rows: edges(128), columns: edges(123) }
    }

    #[test]
    fn surveys_take_a_quarter_of_the_budget_or_are_the_coarsest() {
        for budget in [0, 1_000, 10_000, 100_000, 1_000_000, 10_000_000, usize::MAX] {
            let (whole, mut limited) = (survey(), survey());
            let is_limited = limited.limit(Budget(budget));
            assert_eq!(is_limited, whole.evaluations() > budget / 4, "{budget}");
            assert_eq!(is_limited, limited.evaluations() < whole.evaluations(), "{budget}");
            let is_coarsest = limited.surveyed() == 1 && limited.rows.len().max(limited.columns.len()) <= 2 * FEW_CELLS;
            assert!(limited.evaluations() <= budget / 4 || is_coarsest, "{budget}: {limited:?}");
            for edges in [&limited.rows, &limited.columns] {
                assert!(edges[0] == 0.0 && edges[edges.len() - 1] == 1.0, "{budget}: {edges:?}");
            }
        }
    }

    #[test]
    fn midpoints_are_as_many_as_the_budget_allows() {
        assert_eq!([15, 16, 159, 1600].map(|budget| Budget(budget).points(16, 4)), [1, 1, 3, 4]);
        assert!(!Budget(usize::MAX - 1).allows(usize::MAX, 2) && Budget::of(None).allows(usize::MAX, 2));
    }
}
