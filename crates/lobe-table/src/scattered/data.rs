//! The samples, and their interpolation.

use super::mesh::Mesh;
use crate::spherical::AXIS_NAMES;
use crate::{Channels, Scatter};
use libm::{atan2, hypot, sin, sincos};
use std::collections::BTreeMap;
use std::f64::consts::{FRAC_PI_2, TAU};
use std::sync::Arc;
use thiserror::Error;

/// Angles and values that are not a valid measurement.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ScatteredError {
    /// No samples or no channels.
    #[error("no samples; expected at least one, with at least one channel")]
    Empty,
    /// The value count is not the number of samples times the channels.
    #[error("{found} values; expected {expected} = samples x channels")]
    ValueCount {
        /// What was found.
        found: usize,
        /// What samples and channels require.
        expected: usize,
    },
    /// A value that is NaN or infinite.
    #[error("value {value} of sample {sample}; expected a finite number")]
    ValueNotFinite {
        /// Position of the sample.
        sample: usize,
        /// What was found.
        value: f32,
    },
    /// An angle that is not finite, or a polar angle outside `[0, pi/2]`.
    #[error("{name} of sample {sample} is {angle} rad; expected a finite angle, a polar one in [0, pi/2]")]
    Angle {
        /// `theta_i`, `phi_i`, `theta_o` or `phi_o`.
        name: &'static str,
        /// Position of the sample.
        sample: usize,
        /// What was found, in radians.
        angle: f64,
    },
}

/// The largest distance of a polar angle, rounded in its file, beyond the horizon, in radians.
const ROUNDING: f64 = 1e-4;
/// Directions nearer to each other than this, in radians, are equal.
pub(super) const SAME: f64 = 1e-6;

/// The measurement for one incident direction.
#[derive(Clone, Debug)]
pub(super) struct Incidence {
    pub(super) theta: f64,
    /// The azimuth that outgoing azimuths are relative to.
    pub(super) phi: f64,
    /// Polar angle and relative azimuth of each outgoing direction.
    pub(super) outgoing: Vec<[f64; 2]>,
    /// `[outgoing][channel]`.
    pub(super) values: Vec<f32>,
    pub(super) mesh: Mesh,
}

/// Scattered measurements of a BRDF or BTDF. Values are `f` in 1/sr, without the cosine; negative ones are kept.
///
/// If all incident directions have the same azimuth, the material is isotropic. If the outgoing directions of an
/// isotropic material are all on one side of the plane of incidence, the other side is their mirror image.
///
/// [`eval`](Self::eval) evaluates them in `f64`, one pair at a time; a `Table` has the same values in lanes.
#[derive(Clone, Debug)]
pub struct Data {
    pub(super) scatter: Scatter,
    pub(super) channels: Channels,
    pub(super) is_isotropic: bool,
    /// 1 or -1 if only outgoing directions with a sine of that sign were measured, otherwise 0.
    pub(super) measured_side: f64,
    /// Shared by clones, as are the triangles, because prepared materials keep the same data.
    pub(super) incidences: Arc<[Incidence]>,
    pub(super) mesh: Arc<Mesh>,
}

impl Data {
    /// Checks samples and stores them. `angles` are the [`AXIS_NAMES`] of each sample in radians, each polar angle from
    /// the normal on the side of its direction, so that those of a BTDF are below `pi/2` too; `values` are
    /// `[sample][channel]`. Samples with the same two directions are averaged.
    ///
    /// # Errors
    /// [`ScatteredError`] names the sample, what was found and what was expected.
    pub fn new(
        scatter: Scatter,
        channels: Channels,
        angles: &[[f64; 4]],
        values: &[f32],
    ) -> Result<Self, ScatteredError> {
        let count = channels.count();
        if angles.is_empty() || count == 0 {
            return Err(ScatteredError::Empty);
        }
        if values.len() != angles.len() * count {
            return Err(ScatteredError::ValueCount { found: values.len(), expected: angles.len() * count });
        }
        if let Some(index) = values.iter().position(|v| !v.is_finite()) {
            return Err(ScatteredError::ValueNotFinite { sample: index / count, value: values[index] });
        }
        for (sample, of_sample) in angles.iter().enumerate() {
            for (axis, &angle) in of_sample.iter().enumerate() {
                let is_polar = axis % 2 == 0;
                let fits = !is_polar || (-ROUNDING..=FRAC_PI_2 + ROUNDING).contains(&angle);
                if !angle.is_finite() || !fits {
                    return Err(ScatteredError::Angle { name: AXIS_NAMES[axis], sample, angle });
                }
            }
        }
        // At the pole an azimuth says nothing about the direction.
        let mut azimuths = angles.iter().filter(|a| a[0] > SAME).map(|a| azimuth_key(a[1]));
        let first = azimuths.next();
        let is_isotropic = azimuths.all(|azimuth| Some(azimuth) == first);

        // Compared by the place in the mesh, which has no seam of azimuths.
        let mut samples: BTreeMap<(i64, i64), Vec<usize>> = BTreeMap::new();
        for (sample, [theta, phi, ..]) in angles.iter().enumerate() {
            let theta = if *theta <= SAME { 0.0 } else { *theta };
            let [x, y] = project(theta, place(*phi, is_isotropic));
            samples.entry((key(x), key(y))).or_default().push(sample);
        }
        let incidences: Option<Vec<_>> =
            samples.values().map(|samples| incidence(samples, angles, values, count, is_isotropic)).collect();
        let mut incidences = incidences.ok_or(ScatteredError::Empty)?;
        incidences.sort_by_key(|incidence| (key(incidence.theta), azimuth_key(incidence.phi)));
        let positions: Vec<_> = incidences.iter().map(|i| project(i.theta, place(i.phi, is_isotropic))).collect();
        let mesh = Mesh::new(&positions).ok_or(ScatteredError::Empty)?;

        let (incidences, mesh): (Arc<[Incidence]>, _) = (incidences.into(), Arc::new(mesh));
        let mut sides = incidences.iter().flat_map(|i| &i.outgoing).map(|[theta, phi]| sin(*theta) * sin(*phi));
        let (least, most) = sides.by_ref().fold((0.0_f64, 0.0_f64), |(lo, hi), y| (lo.min(y), hi.max(y)));
        let measured_side = match is_isotropic {
            true if least > -SAME => 1.0,
            true if most < SAME => -1.0,
            _ => 0.0,
        };
        Ok(Data { scatter, channels, is_isotropic, measured_side, incidences, mesh })
    }

    /// Reflection or transmission.
    pub fn scatter(&self) -> Scatter {
        self.scatter
    }

    /// The meaning of the channels.
    pub fn channels(&self) -> &Channels {
        &self.channels
    }

    /// `true` if the value depends on the difference of the azimuths only.
    pub fn is_isotropic(&self) -> bool {
        self.is_isotropic
    }

    /// The polar angle and azimuth of each incident direction, in radians, by ascending polar angle.
    pub fn incidences(&self) -> impl ExactSizeIterator<Item = [f64; 2]> {
        self.incidences.iter().map(|incidence| [incidence.theta, incidence.phi])
    }

    /// The samples: the [`AXIS_NAMES`] in radians, and the channels.
    pub fn samples(&self) -> impl Iterator<Item = ([f64; 4], &[f32])> {
        self.relative_samples()
            .map(|([theta, phi, theta_o, relative], values)| ([theta, phi, theta_o, phi + relative], values))
    }

    /// The samples as stored: like [`samples`](Self::samples), but with the outgoing azimuth counted from the incident
    /// one.
    pub fn relative_samples(&self) -> impl Iterator<Item = ([f64; 4], &[f32])> {
        let count = self.channels.count();
        self.incidences.iter().flat_map(move |incidence| {
            let Incidence { theta, phi, .. } = *incidence;
            let outgoing = incidence.outgoing.iter().zip(incidence.values.chunks_exact(count));
            outgoing.map(move |(&[theta_o, relative], values)| ([theta, phi, theta_o, relative], values))
        })
    }

    /// The channels of `f` in 1/sr for light from `wi` to `wo`, unit vectors that point away from the surface.
    ///
    /// Zero for directions that graze the surface, for directions on opposite sides if reflection was measured, and on
    /// the same side if transmission was. The two sides of the surface are assumed to be alike.
    pub fn eval(&self, wi: [f64; 3], wo: [f64; 3]) -> Vec<f32> {
        let count = self.channels.count();
        let (mut sum, mut out) = (vec![0.0; count], vec![0.0; count]);
        self.eval_into(wi, wo, &mut sum, &mut out);
        out
    }

    /// Like [`eval`](Self::eval), into `out`; `sum` is scratch memory for the channels. Both can be reused for many
    /// pairs.
    ///
    /// # Panics
    /// If one of the two is shorter than the number of channels.
    pub fn eval_into(&self, wi: [f64; 3], wo: [f64; 3], sum: &mut [f64], out: &mut [f32]) {
        let count = self.channels.count();
        let (sum, out) = (&mut sum[..count], &mut out[..count]);
        sum.fill(0.0);
        let sides = wi[2] * wo[2];
        let is_measured = match self.scatter {
            Scatter::Reflection => sides > 0.0,
            Scatter::Transmission => sides < 0.0,
        };
        if !is_measured {
            return out.fill(0.0);
        }
        let theta = atan2(hypot(wi[0], wi[1]), wi[2].abs());
        let phi = atan2(wi[1], wi[0]);
        for (index, weight) in self.mesh.weights(project(theta, place(phi, self.is_isotropic))) {
            if weight == 0.0 {
                continue;
            }
            let incidence = &self.incidences[index];
            let is_fixed_pole = !self.is_isotropic && incidence.theta <= SAME;
            let [theta_o, mut phi_o] = turned(wo, phi, incidence.theta - theta);
            if is_fixed_pole {
                phi_o += phi;
            }
            let [x, mut y] = project(theta_o, phi_o);
            if self.measured_side != 0.0 {
                y = y.abs() * self.measured_side;
            }
            for (outgoing, share) in incidence.mesh.weights([x, y]) {
                let values = &incidence.values[outgoing * count..][..count];
                sum.iter_mut().zip(values).for_each(|(sum, value)| *sum += weight * share * f64::from(*value));
            }
        }
        out.iter_mut().zip(sum).for_each(|(out, value)| *out = *value as f32);
    }
}

/// Gathers the samples of one incident direction.
fn incidence(
    samples: &[usize],
    angles: &[[f64; 4]],
    values: &[f32],
    count: usize,
    is_isotropic: bool,
) -> Option<Incidence> {
    let [theta, phi, ..] = angles[samples[0]];
    // For anisotropic materials, azimuths at the pole remain relative to the sample.
    let is_fixed_pole = !is_isotropic && theta <= SAME;
    let mut places: BTreeMap<(i64, i64), (usize, Vec<f64>)> = BTreeMap::new();
    let mut outgoing: Vec<[f64; 2]> = Vec::new();
    for &sample in samples {
        let [_, phi_i, theta_o, phi_o] = angles[sample];
        let relative = (if is_fixed_pole { phi_o } else { phi_o - phi_i }).rem_euclid(TAU);
        let [x, y] = project(theta_o, relative);
        let next = places.len();
        let (index, sums) = places.entry((key(x), key(y))).or_insert_with(|| (next, vec![0.0; count + 1]));
        if *index == outgoing.len() {
            outgoing.push([theta_o, relative]);
        }
        let sample_values = &values[sample * count..][..count];
        sums.iter_mut().zip(sample_values).for_each(|(sum, value)| *sum += f64::from(*value));
        sums[count] += 1.0;
    }
    let mut averages = vec![0.0; outgoing.len() * count];
    for (index, sums) in places.values() {
        let to = &mut averages[index * count..][..count];
        to.iter_mut().zip(sums).for_each(|(value, sum)| *value = (sum / sums[count]) as f32);
    }
    let positions: Vec<_> = outgoing.iter().map(|&[theta, phi]| project(theta, phi)).collect();
    let mesh = Mesh::new(&positions)?;
    Some(Incidence { theta, phi: if is_fixed_pole { 0.0 } else { phi }, outgoing, values: averages, mesh })
}

/// Polar angle and azimuth, relative to the plane of incidence, of an outgoing direction that is rotated in that plane
/// by `by`, away from the light, and kept above the horizon.
fn turned(wo: [f64; 3], phi_i: f64, by: f64) -> [f64; 2] {
    let ((sin, cos), (sin_by, cos_by)) = (sincos(phi_i), sincos(by));
    let (x, y, z) = (cos * wo[0] + sin * wo[1], cos * wo[1] - sin * wo[0], wo[2].abs());
    let (x, z) = (cos_by * x - sin_by * z, (sin_by * x + cos_by * z).max(0.0));
    [atan2(hypot(x, y), z), atan2(y, x)]
}

/// The place of a direction in its mesh. The last digit of a sine decides which of two equally good diagonals of a
/// trapezoid of samples is an edge, so it must be the same on every system.
fn project(theta: f64, phi: f64) -> [f64; 2] {
    let (sin, cos) = sincos(phi);
    [theta * cos, theta * sin]
}

/// The azimuth of an incident direction in the mesh: for an isotropic material, all are on a line.
fn place(phi: f64, is_isotropic: bool) -> f64 {
    if is_isotropic { 0.0 } else { phi }
}

fn key(angle: f64) -> i64 {
    (angle / SAME).round() as i64
}

/// The same azimuth for a full turn more or less, and for angles that rounding puts on either side of the seam.
fn azimuth_key(phi: f64) -> i64 {
    key(phi.rem_euclid(TAU)) % key(TAU)
}
