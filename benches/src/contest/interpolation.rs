//! Interpolation alone: from known angles to RGB.

use std::rc::Rc;

use lobe::table::specular::coords::directions_to_angles;
use lobe::table::specular::reference;
use lobe::{Edges, specular};

use super::{Contender, Contest, Tolerance, backends};
use crate::baseline::{self, ScalarTable, interpn::Grid};
use crate::tables;
use crate::workload::Input;

/// Rounding of positions in the table, whose steepest cells change by their largest value over 0.012 rad.
const TOLERANCE: Tolerance = Tolerance { max: 1e-4, rms: 2e-6 };

/// Isotropic: three dimensions.
pub fn iso(input: Input, count: usize) -> Contest {
    contest(&tables::isotropic(), input, count)
}

/// Anisotropic: four dimensions.
pub fn aniso(input: Input, count: usize) -> Contest {
    contest(&tables::anisotropic(), input, count)
}

/// Sigma, psi, theta and phi in radians of `count` pairs of directions.
pub fn angles(input: Input, count: usize) -> [Vec<f32>; 4] {
    let (wi, wo) = input.pairs(count).vectors();
    let mut angles = [(); 4].map(|()| Vec::with_capacity(count));
    for (wi, wo) in wi.iter().zip(&wo) {
        let found = directions_to_angles(wi.map(f64::from), wo.map(f64::from), |sigma| sigma);
        angles.iter_mut().zip(found).for_each(|(column, angle)| column.push(angle as f32));
    }
    angles
}

struct Setup {
    angles: [Vec<f32>; 4],
    scalar: ScalarTable,
    grid: Grid,
    table: specular::Table,
}

impl Setup {
    fn columns(&self) -> [&[f32]; 4] {
        self.angles.each_ref().map(Vec::as_slice)
    }
}

fn contest(samples: &specular::Data, input: Input, count: usize) -> Contest {
    let angles = angles(input, count);
    let mut expected = vec![0.0; 3 * count];
    for (query, out) in expected.chunks_exact_mut(3).enumerate() {
        let at = angles.each_ref().map(|angles| f64::from(angles[query]));
        reference::eval_angles(samples, &Edges::default(), at, out);
    }
    let setup = Rc::new(Setup {
        angles,
        scalar: ScalarTable::new(samples),
        grid: Grid::new(samples),
        table: specular::Table::new(samples, &Edges::default()).expect("a small table"),
    });
    let baselines = vec![scalar(setup.clone()), interpn(setup.clone())];
    let contenders = backends().into_iter().map(|named| {
        let setup = setup.clone();
        let run = move |out: &mut Vec<f32>| setup.table.interpolate_batch(named.backend, setup.columns(), out);
        Contender::new(named.name, TOLERANCE, vec![f32::NAN; 3 * count], run, Vec::clone)
    });
    Contest { count, baselines, contenders: contenders.collect(), expected }
}

fn scalar(setup: Rc<Setup>) -> Contender {
    let out = vec![[f32::NAN; 3]; setup.angles[0].len()];
    let run = move |out: &mut Vec<[f32; 3]>| {
        let [sigma, psi, theta, phi] = setup.columns();
        for (query, out) in out.iter_mut().enumerate() {
            let angles = [sigma[query], psi[query], theta[query], phi[query]];
            *out = baseline::libm::interpolate(&setup.scalar, angles);
        }
    };
    Contender::new("libm", TOLERANCE, out, run, |out| out.as_flattened().to_vec())
}

fn interpn(setup: Rc<Setup>) -> Contender {
    let out = [(); 3].map(|()| vec![f32::NAN; setup.angles[0].len()]);
    let run = move |out: &mut [Vec<f32>; 3]| setup.grid.interpolate(setup.columns(), out);
    let values = |[r, g, b]: &[Vec<f32>; 3]| (0..r.len()).flat_map(|i| [r[i], g[i], b[i]]).collect();
    Contender::new("interpn", TOLERANCE, out, run, values)
}
