//! Refines nodes until an error is small enough.

use lobe_model::goniometer::rgl::Resolution;
use lobe_model::goniometer::spherical::uniform_half;
use lobe_model::goniometer::tensor_tree::Refinement;
use lobe_table::window::klems::AngleBasis;

use super::Nodes;

impl Nodes {
    /// The next finer nodes, each in one respect: an axis with additional knots between its knots, half as many knots
    /// or texels again, or smaller patches. Empty if there is nothing finer.
    pub fn refined(&self) -> Vec<Nodes> {
        match self {
            Nodes::Specular(knots) => denser(knots).into_iter().map(Nodes::Specular).collect(),
            Nodes::Polarised(knots) => denser(knots).into_iter().map(Nodes::Polarised).collect(),
            Nodes::Mueller(knots) => denser(knots).into_iter().map(Nodes::Mueller).collect(),
            Nodes::Spherical { knots, is_half: false } => {
                denser(knots).into_iter().map(|knots| Nodes::Spherical { knots, is_half: false }).collect()
            }
            // Half grids must be uniform, because no format has others.
            Nodes::Spherical { knots: [thetas, _, _, phis], is_half: true } => {
                let (zeniths, azimuths) = (thetas.len(), phis.len());
                let finer = [[half_more(zeniths), azimuths], [zeniths, half_more(azimuths)]];
                let half = |[zeniths, azimuths]: [usize; 2]| uniform_half(zeniths, azimuths);
                finer.map(half).into_iter().map(|knots| Nodes::Spherical { knots, is_half: true }).collect()
            }
            Nodes::HalfDiff(_) | Nodes::Utia => Vec::new(),
            Nodes::Rgl(resolution) => {
                let mut finer = vec![
                    Resolution { spectra: half_more(resolution.spectra), ..*resolution },
                    Resolution { theta_i: half_more(resolution.theta_i), ..*resolution },
                ];
                if resolution.phi_i > 1 {
                    finer.push(Resolution { phi_i: half_more(resolution.phi_i), ..*resolution });
                }
                finer.into_iter().map(Nodes::Rgl).collect()
            }
            Nodes::Klems(basis) => {
                let standard = [AngleBasis::quarter(), AngleBasis::half(), AngleBasis::full()];
                standard
                    .into_iter()
                    .find(|finer| finer.patches() > basis.patches())
                    .map(Nodes::Klems)
                    .into_iter()
                    .collect()
            }
            Nodes::Tree(refinement) => {
                let error = 0.5 * refinement.error;
                let depth = refinement.depth + 1;
                let finer = [
                    Refinement { depth, ..*refinement },
                    Refinement { error, ..*refinement },
                    Refinement { depth, error, ..*refinement },
                ];
                finer.into_iter().map(Nodes::Tree).collect()
            }
        }
    }
}

fn half_more(count: usize) -> usize {
    count + count.div_ceil(2)
}

/// The knots with additional ones between them, along one axis at a time.
fn denser<const AXES: usize>(knots: &[Vec<f64>; AXES]) -> Vec<[Vec<f64>; AXES]> {
    let is_axis = |axis: &usize| knots[*axis].len() > 1;
    let along = |axis: usize| {
        let mut finer = knots.clone();
        finer[axis] = knots[axis].windows(2).flat_map(|ends| [ends[0], 0.5 * (ends[0] + ends[1])]).collect();
        finer[axis].extend(knots[axis].last());
        finer
    };
    (0..AXES).filter(is_axis).map(along).collect()
}

/// The result of the search for nodes.
#[derive(Clone, Debug)]
pub struct Refined<T> {
    /// The nodes.
    pub nodes: Nodes,
    /// The measurement at the nodes.
    pub measured: T,
    /// The error of the measurement.
    pub error: f64,
    /// `true` if the error is as small as requested.
    pub is_met: bool,
}

/// The largest number of values that a search takes for one file.
const MOST: usize = 1 << 26;
/// A step must bring the error below this share of the previous error.
const PROGRESS: f64 = 0.98;

/// Searches for nodes with an error of at most `bound`, beginning at `start`: each step takes the finer nodes with the
/// smallest error. If no step helps, or if too many values would be needed, the result with the smallest error is
/// returned. `measure` returns the measurement at nodes, and its error.
///
/// # Errors
/// Those of `measure`.
pub fn refine<T, E>(
    start: Nodes,
    channels: usize,
    bound: f64,
    measure: impl Fn(&Nodes) -> Result<(T, f64), E>,
) -> Result<Refined<T>, E> {
    let refined = |nodes: Nodes, (measured, error): (T, f64)| {
        let is_met = error <= bound;
        Refined { nodes, measured, error, is_met }
    };
    let values = |nodes: &Nodes| nodes.counts().into_iter().fold(channels, usize::saturating_mul);
    let first = measure(&start)?;
    let mut best = refined(start, first);
    while !best.is_met {
        // The error of linear interpolation falls at best with the square of the number of values. Trees also have the
        // error of their leaves.
        let growth = MOST as f64 / values(&best.nodes).max(1) as f64;
        if !matches!(best.nodes, Nodes::Tree(_)) && best.error / (growth * growth) > bound {
            break;
        }
        let mut next: Option<Refined<T>> = None;
        for nodes in best.nodes.refined() {
            if values(&nodes) > MOST {
                continue;
            }
            let found = measure(&nodes)?;
            if next.as_ref().is_none_or(|next| found.1 < next.error) {
                next = Some(refined(nodes, found));
            }
        }
        match next.filter(|next| next.error < PROGRESS * best.error) {
            Some(next) => best = next,
            None => break,
        }
    }
    Ok(best)
}

#[cfg(test)]
mod tests {
    use lobe_table::window::tensor_tree::Rank;

    use super::*;

    fn spherical(knots: [usize; 4]) -> Nodes {
        let axis = |count: usize| (0..count).map(|i| i as f64 / count as f64).collect::<Vec<f64>>();
        Nodes::Spherical { knots: knots.map(axis), is_half: false }
    }

    #[test]
    fn bounds_that_need_too_many_values_are_given_up_early() {
        let most = std::cell::Cell::new(0);
        // The error halves with each step.
        let measure = |nodes: &Nodes| {
            let values: usize = nodes.counts().into_iter().product();
            most.set(most.get().max(values));
            Ok::<_, ()>(((), 1.0 / values as f64))
        };
        let reached = |bound: f64| {
            most.set(0);
            let refined = refine(spherical([5, 1, 5, 5]), 1, bound, measure).unwrap();
            (refined.is_met, most.get())
        };
        assert!(reached(1e-6).0);
        let (is_met, values) = reached(1e-12);
        assert!(!is_met && values < MOST / 100, "{values}");
    }

    #[test]
    fn one_axis_is_refined_at_a_time() {
        let finer = spherical([3, 1, 4, 5]).refined();
        let counts: Vec<_> = finer.iter().map(Nodes::counts).collect();
        assert_eq!(counts, [[5, 1, 4, 5], [3, 1, 7, 5], [3, 1, 4, 9]]);
        assert!(Nodes::HalfDiff([90, 90, 180]).refined().is_empty() && Nodes::Utia.refined().is_empty());
        let turns = Nodes::Mueller([vec![0.0, 1.0], vec![0.0, 0.5, 1.0], vec![0.0]]).refined();
        let counts: Vec<_> = turns.iter().map(Nodes::counts).collect();
        assert_eq!(counts, [[3, 3, 1, 16], [2, 5, 1, 16]]);
        assert!(Nodes::Klems(AngleBasis::full()).refined().is_empty());
        assert_eq!(Nodes::Klems(AngleBasis::quarter()).refined(), [Nodes::Klems(AngleBasis::half())]);
        let tree = Nodes::Tree(Refinement { rank: Rank::Three, depth: 3, error: 0.2 });
        assert_eq!(tree.refined().len(), 3);
    }

    /// An error that falls along the first and the third axis only, and not below 0.02.
    #[test]
    fn the_search_ends_where_the_bound_is_met_or_nothing_helps() {
        let error = |nodes: &Nodes| {
            let counts = nodes.counts();
            Ok::<_, ()>(((), 0.02 + 1.0 / (counts[0] * counts[0]) as f64 + 1.0 / (counts[2] * counts[2]) as f64))
        };
        let met = refine(spherical([3, 1, 4, 5]), 1, 0.05, error).expect("no error");
        assert!(met.is_met && met.error <= 0.05 && met.nodes.counts()[3] == 5, "{met:?}");
        let unmet = refine(spherical([3, 1, 4, 5]), 1, 0.01, error).expect("no error");
        assert!(!unmet.is_met && unmet.error < 0.021, "{unmet:?}");
    }
}
