//! Interpolation on rectilinear grids at known angles, compared with peers.

use std::rc::Rc;

use lobe::{Backend, Edges, specular};
use lobe_benches::baseline::interpn::Grid;
use lobe_benches::contest::{Contender, angles};
use lobe_benches::tables;
use lobe_benches::workload::Input;
use serde_json::json;

use super::comparison::Agreement;
use super::contest::{Contest, Outside};
use super::exchange::Exchange;

/// Points per run.
const COUNT: usize = 1 << 16;

/// Both tables of the paper's sizes, on both inputs.
///
/// # Errors
/// If a file cannot be written.
pub fn all(exchange: &mut Exchange) -> anyhow::Result<Vec<Contest>> {
    let mut contests = Vec::new();
    for (name, shown, samples) in
        [("iso", "7 × 8 × 13", tables::isotropic()), ("aniso", "17 × 7 × 17 × 13", tables::anisotropic())]
    {
        for input in Input::ALL {
            contests.push(contest(exchange, (name, shown), &samples, input)?);
        }
    }
    Ok(contests)
}

fn contest(
    exchange: &mut Exchange,
    (name, shown): (&str, &str),
    samples: &specular::Data,
    input: Input,
) -> anyhow::Result<Contest> {
    let angles = Rc::new(angles(input, COUNT));
    let axes: Vec<usize> = (0..4).filter(|&axis| samples.knots()[axis].len() > 1).collect();
    let rows: Vec<&[f32]> = axes.iter().map(|&axis| angles[axis].as_slice()).collect();
    let points = exchange.floats(&format!("{name}-{}", input.name()), &rows)?;
    let values = exchange.floats(name, &[samples.values()])?;
    // All contestants get the knots as this library rounds them.
    let knots: Vec<Vec<f32>> =
        axes.iter().map(|&axis| samples.knots()[axis].iter().map(|&knot| knot as f32).collect()).collect();
    let mut outside = Vec::new();
    for (peer, program, float) in
        [("interpn, wheel", "interpn", "f4"), ("SciPy f32", "scipy", "f4"), ("SciPy f64", "scipy", "f8")]
    {
        let task = format!("{name}-{}-{float}", input.name());
        exchange.task(&task, json!({ "knots": knots, "values": values, "points": points, "float": float }));
        outside.push(Outside::new(peer, program, task));
    }

    let table = specular::Table::new(samples, &Edges::default())?;
    let backend = Backend::best().fused();
    let columns = angles.clone();
    let run = move |out: &mut Vec<f32>| {
        table.interpolate_batch(backend, columns.each_ref().map(Vec::as_slice), out);
    };
    let grid = Grid::new(samples);
    let peer = move |out: &mut [Vec<f32>; 3]| grid.interpolate(angles.each_ref().map(Vec::as_slice), out);
    let interleaved = |[r, g, b]: &[Vec<f32>; 3]| (0..r.len()).flat_map(|i| [r[i], g[i], b[i]]).collect();
    let planes = [(); 3].map(|()| vec![f32::NAN; COUNT]);
    Ok(Contest {
        id: "interpolation",
        on: format!("{shown}, {}", input.name()),
        unit: "RGB lookup",
        count: COUNT,
        lobe: Contender::new("lobe", Contender::UNCHECKED, vec![f32::NAN; 3 * COUNT], run, Vec::clone),
        inside: vec![Contender::new("interpn, crate", Contender::UNCHECKED, planes, peer, interleaved)],
        outside,
        // Values are about 1; positions are rounded to 1e-6 of a table whose values change by about 1 in a cell.
        agreement: Some(Agreement { relative: 1e-4, floor: 1.0, outliers: 0.0 }),
        judge: None,
        goal: Some(12.0),
    })
}
