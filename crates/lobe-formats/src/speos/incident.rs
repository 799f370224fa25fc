//! The measurement of one incident direction, as a table of polar angle by azimuth.

use lobe_table::{scattered, spherical};

use crate::angle::degrees;

/// Azimuths closer than this, in degrees, are the same.
const SAME: f64 = 1e-6;
/// The widest gap between azimuths of a grid, in degrees: readers of such tables may interpolate across wider gaps
/// differently.
const GAP: f64 = 15.0;

/// A table of an incident direction. Angles are in degrees; azimuths count from the direction in which the light
/// continues, ascend, and run from 0 to 360, or from 0 to 180 for one half of a symmetric table.
pub(super) struct Incident {
    pub theta: f64,
    /// The azimuth of the light.
    pub phi: f64,
    pub thetas: Vec<f64>,
    pub phis: Vec<f64>,
    /// `[theta][phi][channel]`.
    pub values: Vec<f32>,
}

/// Converts an azimuth in the coordinates of the surface to the azimuth in the file, for light at `light`; both in
/// degrees.
fn from_forward(azimuth: f64, light: f64) -> f64 {
    let turned = degrees((azimuth - light - 180.0).rem_euclid(360.0).to_radians());
    if turned > 360.0 - SAME { 0.0 } else { turned }
}

/// A knot of a grid and its azimuth in the file.
#[derive(Clone, Copy)]
struct Knot {
    phi: f64,
    index: usize,
}

/// A column of a table: the two knots of a grid around it, with the share of the second.
struct Column {
    phi: f64,
    between: [usize; 2],
    share: f64,
}

/// The tables of a grid. Azimuths missing at the ends and in gaps are interpolated like the grid.
pub(super) fn of_spherical(grid: &spherical::Data) -> Vec<Incident> {
    let [theta_i, phi_i, theta_o, phi_o] = grid.knots();
    let count = grid.channels().count();
    let azimuths: Vec<f64> = phi_o.iter().map(|azimuth| degrees(*azimuth)).collect();
    let slices = theta_i.iter().flat_map(|theta| phi_i.iter().map(move |phi| (*theta, *phi)));
    let rows = grid.values().chunks_exact(theta_o.len() * phi_o.len() * count);
    let table = |((theta, phi), slice): ((f64, f64), &[f32])| {
        let columns = columns(&azimuths, degrees(phi), grid.is_mirrored());
        let mut values = Vec::with_capacity(theta_o.len() * columns.len() * count);
        for row in slice.chunks_exact(phi_o.len() * count) {
            for Column { between: [a, b], share, .. } in &columns {
                let ends = row[a * count..][..count].iter().zip(&row[b * count..][..count]);
                values.extend(ends.map(|(a, b)| match a == b {
                    true => *a,
                    false => (f64::from(*a) * (1.0 - share) + f64::from(*b) * share) as f32,
                }));
            }
        }
        Incident {
            theta: degrees(theta),
            phi: degrees(phi),
            thetas: theta_o.iter().map(|theta| degrees(*theta)).collect(),
            phis: columns.iter().map(|column| column.phi).collect(),
            values,
        }
    };
    slices.zip(rows).map(table).collect()
}

/// The columns of a table: those of the grid, the ends, and more if these are further apart than [`GAP`].
fn columns(azimuths: &[f64], light: f64, is_half: bool) -> Vec<Column> {
    let place = |azimuth: f64| if is_half { (180.0 - azimuth).max(0.0) } else { from_forward(azimuth, light) };
    let mut knots: Vec<Knot> =
        azimuths.iter().enumerate().map(|(index, azimuth)| Knot { phi: place(*azimuth), index }).collect();
    knots.sort_by(|a, b| a.phi.total_cmp(&b.phi));
    knots.dedup_by(|later, earlier| later.phi - earlier.phi < SAME);
    let end = if is_half { 180.0 } else { 360.0 };
    let mut phis = vec![0.0];
    for phi in knots.iter().map(|knot| knot.phi).filter(|phi| *phi > SAME && *phi < end - SAME).chain([end]) {
        let from = phis[phis.len() - 1];
        let parts = ((phi - from) / GAP - 1e-9).ceil().max(1.0);
        phis.extend((1..parts as usize).map(|part| from + (phi - from) * part as f64 / parts));
        phis.push(phi);
    }
    phis.into_iter().map(|phi| column(&knots, phi, is_half)).collect()
}

/// The column at an azimuth: between the knots around it, which are periodic or, for half a grid, clamped at the ends.
fn column(knots: &[Knot], phi: f64, is_half: bool) -> Column {
    let upper = knots.partition_point(|knot| knot.phi <= phi + SAME);
    let (first, last) = (knots[0], knots[knots.len() - 1]);
    let (below, above) = match upper {
        0 if is_half => (first, first),
        0 => (Knot { phi: last.phi - 360.0, ..last }, first),
        upper if upper == knots.len() && is_half => (last, last),
        upper if upper == knots.len() => (last, Knot { phi: first.phi + 360.0, ..first }),
        upper => (knots[upper - 1], knots[upper]),
    };
    let gap = above.phi - below.phi;
    let share = if gap > SAME { ((phi - below.phi) / gap).clamp(0.0, 1.0) } else { 0.0 };
    match () {
        () if (phi - below.phi).abs() <= SAME => Column { phi, between: [below.index; 2], share: 0.0 },
        () if (above.phi - phi).abs() <= SAME => Column { phi, between: [above.index; 2], share: 0.0 },
        () => Column { phi, between: [below.index, above.index], share },
    }
}

/// The tables of samples, if the samples of each incident direction form a grid of polar angles and azimuths, in which
/// a pole may have one sample for all azimuths.
pub(super) fn of_scattered(data: &scattered::Data) -> Option<Vec<Incident>> {
    let mut tables = Vec::new();
    let mut samples = data.relative_samples().peekable();
    while let Some(&([theta, phi, ..], _)) = samples.peek() {
        let mut of_table: Vec<(f64, f64, &[f32])> = Vec::new();
        while let Some(([.., theta_o, relative], values)) = samples.next_if(|([t, p, ..], _)| (*t, *p) == (theta, phi))
        {
            of_table.push((degrees(theta_o), from_forward(degrees(relative), 0.0), values));
        }
        // Values measured on one side of the plane of incidence also apply to the other.
        let is_beyond = |(theta_o, phi, _): &(f64, f64, _)| *theta_o < SAME || *phi < SAME || *phi > 180.0 - SAME;
        if data.is_isotropic() && of_table.iter().all(is_beyond) {
            of_table.iter_mut().filter(|sample| sample.1 >= SAME).for_each(|sample| sample.1 = 360.0 - sample.1);
        }
        tables.push(of_samples([degrees(theta), degrees(phi)], &of_table)?);
    }
    Some(tables)
}

/// The grid of the samples of one incident direction.
fn of_samples([theta, phi]: [f64; 2], samples: &[(f64, f64, &[f32])]) -> Option<Incident> {
    let distinct = |angles: &mut Vec<f64>| {
        angles.sort_by(f64::total_cmp);
        angles.dedup_by(|later, earlier| *later - *earlier < SAME);
    };
    let mut thetas: Vec<f64> = samples.iter().map(|sample| sample.0).collect();
    let mut phis: Vec<f64> = samples.iter().filter(|sample| sample.0 >= SAME).map(|sample| sample.1).collect();
    distinct(&mut thetas);
    distinct(&mut phis);
    let near = |angles: &[f64], angle: f64| {
        let at = angles.partition_point(|other| *other < angle - SAME);
        angles.get(at).is_some_and(|other| *other - angle < SAME).then_some(at)
    };
    let mut places: Vec<Option<&[f32]>> = vec![None; thetas.len() * phis.len()];
    for (theta_o, phi_o, values) in samples {
        let row = near(&thetas, *theta_o)?;
        match *theta_o < SAME {
            true => places[row * phis.len()..][..phis.len()].fill(Some(values)),
            false => places[row * phis.len() + near(&phis, *phi_o)?] = Some(values),
        }
    }
    let places: Vec<&[f32]> = places.into_iter().collect::<Option<_>>()?;
    let is_half = phis.last().is_some_and(|last| (*last - 180.0).abs() < SAME) && phis[0] < SAME;
    let is_whole = phis.first().is_some_and(|first| *first < SAME) && !is_half;
    // Without an azimuth at 0, there is none at the end of the turn either.
    if !is_half && !is_whole {
        return None;
    }
    let (columns, mut values) = (phis.len(), Vec::new());
    for row in places.chunks_exact(columns) {
        values.extend(row.iter().copied().flatten().copied());
        if is_whole {
            values.extend_from_slice(row[0]);
        }
    }
    if is_whole {
        phis.push(360.0);
    }
    Some(Incident { theta, phi, thetas, phis, values })
}
