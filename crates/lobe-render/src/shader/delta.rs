//! Surfaces that send a ray into one or two exact directions.

use std::sync::Arc;

use lobe_model::{Elements, fresnel, fresnel_conductor};

use super::film::FilmTable;
use super::{Evaluated, Lobes, Sampled, Scratch, Shader};
use crate::channels::Channels;
use crate::transport::{Polarisation, Transport, TransportMode};
use crate::vec3::{Vec3, cross, dot, scale, sub, unit};

/// One of the exact directions that a path may take, and its effect on the path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DeltaSample<S> {
    /// The direction in which the path continues.
    pub wi: [f32; 3],
    /// The factor for radiance or importance.
    pub weight: S,
    /// The effect on polarised light; `None` if that was not requested, or if the light becomes unpolarised.
    pub polarisation: Option<Polarisation<S>>,
}

/// The contents requested of a sample.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Choice {
    /// `true` to include the effect on polarised light.
    pub is_polarised: bool,
    /// If channels take different directions: the channel that is followed, and its weight for all of them. If it is
    /// `None`, all take the direction of the middle one.
    pub lone: Option<(usize, f32)>,
}

/// The exact directions for a known direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DeltaSamples<S> {
    /// The mirrored direction.
    pub reflection: DeltaSample<S>,
    /// The refracted direction, if there is one.
    pub transmission: Option<DeltaSample<S>>,
}

/// The effect of a smooth surface on a ray.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Delta<S: Channels = [f32; 3]> {
    /// Mirrors a constant share of the light.
    Mirror(S),
    /// Mirrors a share of the light that depends on the angle to the normal: ascending angles in radians, each with a
    /// share.
    Measured(Vec<(f32, S)>),
    /// Mirrors and refracts by the equations of Fresnel.
    Glass {
        /// Refractive index inside (the side that the normal points away from) over that outside.
        eta: f32,
        /// The factors for mirrored and for refracted light.
        tint: S,
    },
    /// Glass with a different refractive index in each channel.
    Dispersive {
        /// The relative refractive index by channel, as for glass.
        eta: S,
        /// The factors for mirrored and for refracted light.
        tint: S,
    },
    /// A smooth metal, by the equations of Fresnel.
    Metal {
        /// The real part of the refractive index.
        eta: S,
        /// Its imaginary part.
        k: S,
    },
    /// A thin sheet through which light goes straight, but for the part polarised across an axis. A tilted one absorbs
    /// along that direction as it is seen along the ray (Korger et al., Optics Express 21(22), 2013).
    Polariser {
        /// The angle of the axis from the x axis of the surface, in radians.
        angle: f32,
        /// The share of this part that passes.
        tint: S,
    },
    /// A thin sheet through which light goes straight, and which delays the part polarised across an axis.
    Retarder {
        /// The angle of the fast axis from the x axis of the surface, in radians.
        angle: f32,
        /// The delay, in radians.
        retardance: f32,
    },
    /// A thin film, whose colours depend on the angle.
    Film {
        /// Its reflection and transmission.
        table: Arc<FilmTable<S>>,
        /// The medium that it lies on.
        behind: Behind,
        /// The factors for mirrored and for transmitted light.
        tint: S,
    },
}

/// The medium that a film lies on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Behind {
    /// The same as in front, so that light goes straight through.
    Nothing,
    /// Glass of this relative refractive index.
    Glass(f32),
    /// A metal, which light does not pass.
    Metal,
}

impl<S: Channels> Delta<S> {
    /// The directions in which a path with the known direction `wo` may continue.
    pub fn samples(&self, mode: TransportMode, wo: [f32; 3]) -> DeltaSamples<S> {
        let mirrored = [-wo[0], -wo[1], wo[2]];
        let mirror = |weight| DeltaSamples { reflection: DeltaSample::new(mirrored, weight), transmission: None };
        match self {
            Delta::Mirror(share) => mirror(*share),
            Delta::Measured(shares) => mirror(share_at(shares, wo)),
            Delta::Glass { eta, tint } => {
                let ratio = if wo[2] > 0.0 { 1.0 / eta } else { *eta };
                let (share, refracted) = refract(wo, ratio);
                let transmission = refracted.map(|wi| {
                    // Radiance, but not importance, is compressed into the smaller cone of the denser medium.
                    let squeezed = match mode {
                        TransportMode::Radiance => ratio * ratio,
                        TransportMode::Importance => 1.0,
                    };
                    DeltaSample::new(wi, tint.map(|t| t * (1.0 - share) * squeezed))
                });
                DeltaSamples { transmission, ..mirror(tint.map(|t| t * share)) }
            }
            Delta::Metal { eta, k } => {
                let (mut weight, cos) = (S::ZERO, f64::from(wo[2].abs().min(1.0)));
                for ((weight, eta), k) in weight.as_mut().iter_mut().zip(eta.as_ref()).zip(k.as_ref()) {
                    let share = fresnel_conductor(cos, f64::from(*eta), f64::from(*k)) as f32;
                    // Unused channels have no index.
                    *weight = if *eta == 0.0 && *k == 0.0 { 0.0 } else { share };
                }
                mirror(weight)
            }
            _ => self.samples_of(mode, wo, Choice::default()),
        }
    }

    /// `true` if channels may take different directions.
    pub fn disperses(&self) -> bool {
        matches!(self, Delta::Dispersive { .. })
    }

    /// `true` if light may pass through.
    pub fn transmits(&self) -> bool {
        match self {
            Delta::Mirror(_) | Delta::Measured(_) | Delta::Metal { .. } => false,
            Delta::Film { behind, .. } => *behind != Behind::Metal,
            _ => true,
        }
    }

    /// Like [`samples`](Self::samples), with the contents requested of them.
    pub fn samples_of(&self, mode: TransportMode, wo: [f32; 3], choice: Choice) -> DeltaSamples<S> {
        let mirrored = [-wo[0], -wo[1], wo[2]];
        match self {
            Delta::Mirror(_) | Delta::Measured(_) => self.samples(mode, wo),
            Delta::Glass { eta, tint } => {
                let channels = S::ONE.map(|_| *eta);
                refractive(mode, wo, &channels, tint, Choice { lone: choice.lone.map(|_| (usize::MAX, 1.0)), ..choice })
            }
            Delta::Dispersive { eta, tint } => refractive(mode, wo, eta, tint, choice),
            Delta::Metal { eta, k } => {
                let (mut weight, mut elements) = (S::ZERO, [S::ZERO; 3]);
                for channel in 0..S::COUNT {
                    let (eta, k) = (f64::from(eta.as_ref()[channel]), f64::from(k.as_ref()[channel]));
                    // Unused channels have no index.
                    if eta == 0.0 && k == 0.0 {
                        continue;
                    }
                    let (mirror, _) = fresnel(f64::from(wo[2].abs()), eta, k);
                    weight.as_mut()[channel] = mirror.a as f32;
                    set(&mut elements, channel, mirror);
                }
                let polarisation = choice.is_polarised.then(|| polarisation(wo, elements));
                let reflection = DeltaSample { wi: mirrored, weight, polarisation };
                DeltaSamples { reflection, transmission: None }
            }
            Delta::Polariser { angle, tint } => {
                let (sin, cos) = libm::sincosf(*angle);
                let axis = seen([-sin, cos, 0.0], wo).map(|absorbed| cross(absorbed, wo));
                straight(wo, axis, tint.map(|t| 0.5 * t), [S::ONE, S::ZERO, S::ZERO], choice)
            }
            Delta::Retarder { angle, retardance } => {
                let [(sin, cos), (y, x)] = [*retardance, *angle].map(libm::sincosf);
                let elements = [S::ZERO, S::ONE.map(|_| cos), S::ONE.map(|_| sin)];
                straight(wo, seen([x, y, 0.0], wo), S::ONE, elements, choice)
            }
            Delta::Film { table, behind, tint } => {
                let [mirror, passed] = table.at(wo[2] > 0.0, wo[2].abs()).map(|elements| elements.of);
                let sample = |wi: Vec3, elements: [S; 4], factor: f32| {
                    let (mut weight, mut relative) = (S::ZERO, [S::ZERO; 3]);
                    for k in 0..S::COUNT {
                        let [a, b, c, s] = elements.map(|element| f64::from(element.as_ref()[k]));
                        weight.as_mut()[k] = tint.as_ref()[k] * factor * a as f32;
                        set(&mut relative, k, Elements { a, b, c, s });
                    }
                    let polarisation = choice.is_polarised.then(|| polarisation(wo, relative));
                    DeltaSample { wi, weight, polarisation }
                };
                let transmission = match behind {
                    Behind::Metal => None,
                    Behind::Nothing => Some(sample(wo.map(|x| -x), passed, 1.0)),
                    Behind::Glass(eta) => {
                        let ratio = if wo[2] > 0.0 { 1.0 / eta } else { *eta };
                        let squeezed = if mode == TransportMode::Radiance { ratio * ratio } else { 1.0 };
                        refract(wo, ratio).1.map(|wi| sample(wi, passed, squeezed))
                    }
                };
                DeltaSamples { reflection: sample(mirrored, mirror, 1.0), transmission }
            }
        }
    }
}

impl<S> DeltaSample<S> {
    /// A sample of a direction, with a weight for unpolarised light.
    pub fn new(wi: [f32; 3], weight: S) -> Self {
        DeltaSample { wi, weight, polarisation: None }
    }
}

/// The elements `b`, `c` and `s` of a channel, relative to the first.
fn set<S: Channels>(elements: &mut [S; 3], channel: usize, Elements { a, b, c, s }: Elements) {
    if a > 0.0 {
        for (out, value) in elements.iter_mut().zip([b, c, s]) {
            out.as_mut()[channel] = (value / a) as f32;
        }
    }
}

/// About the normal of the plane of incidence.
fn polarisation<S>(wo: Vec3, [b, c, s]: [S; 3]) -> Polarisation<S> {
    let across = libm::hypotf(wo[0], wo[1]);
    let axis = if across > 0.0 { [-wo[1] / across, wo[0] / across, 0.0] } else { [0.0, 1.0, 0.0] };
    Polarisation { axis, b, c, s }
}

/// The unit vector of an axis as seen along a ray; `None` along the axis.
fn seen(axis: Vec3, wo: Vec3) -> Option<Vec3> {
    unit(sub(axis, scale(wo, dot(axis, wo))))
}

/// Light that goes straight through a sheet with an axis.
fn straight<S: Channels>(wo: Vec3, axis: Option<Vec3>, weight: S, of: [S; 3], choice: Choice) -> DeltaSamples<S> {
    let [b, c, s] = of;
    let polarisation = axis.filter(|_| choice.is_polarised).map(|axis| Polarisation { axis, b, c, s });
    let wi = wo.map(|x| -x);
    DeltaSamples {
        reflection: DeltaSample::new([-wo[0], -wo[1], wo[2]], S::ZERO),
        transmission: Some(DeltaSample { wi, weight, polarisation }),
    }
}

/// Mirrored light of all channels, and refracted light of one.
fn refractive<S: Channels>(mode: TransportMode, wo: Vec3, eta: &S, tint: &S, choice: Choice) -> DeltaSamples<S> {
    let (mut mirrored, mut passed) = (S::ZERO, S::ZERO);
    let (mut of_mirror, mut of_glass) = ([S::ZERO; 3], [S::ZERO; 3]);
    let (lone, count) = match choice.lone {
        Some((channel, count)) => (channel, count),
        None => (S::COUNT / 2, 1.0),
    };
    let follows = |channel: usize| choice.lone.is_none() || lone >= S::COUNT || channel == lone;
    let guide = eta.as_ref()[lone.min(S::COUNT - 1)];
    for channel in 0..S::COUNT {
        let (eta, tint) = (eta.as_ref()[channel], tint.as_ref()[channel]);
        // Unused channels have no index.
        if eta == 0.0 {
            continue;
        }
        let ratio = if wo[2] > 0.0 { 1.0 / eta } else { eta };
        let (mirror, glass) = fresnel(f64::from(wo[2].abs()), 1.0 / f64::from(ratio), 0.0);
        mirrored.as_mut()[channel] = tint * mirror.a as f32;
        set(&mut of_mirror, channel, mirror);
        if follows(channel) {
            let squeezed = if mode == TransportMode::Radiance { ratio * ratio } else { 1.0 };
            passed.as_mut()[channel] = tint * glass.a as f32 * squeezed * count;
            set(&mut of_glass, channel, glass);
        }
    }
    let ratio = if wo[2] > 0.0 { 1.0 / guide } else { guide };
    let (_, refracted) = refract(wo, ratio);
    let wanted = |elements| choice.is_polarised.then(|| polarisation(wo, elements));
    let reflection = DeltaSample { wi: [-wo[0], -wo[1], wo[2]], weight: mirrored, polarisation: wanted(of_mirror) };
    let transmission = refracted.map(|wi| DeltaSample { wi, weight: passed, polarisation: wanted(of_glass) });
    DeltaSamples { reflection, transmission }
}

/// The mirrored share, and the refracted direction unless all light is mirrored; `ratio` is the index on the side of
/// `wo` over the index on the other side.
fn refract(wo: Vec3, ratio: f32) -> (f32, Option<Vec3>) {
    let cos = wo[2].abs().min(1.0);
    let sin2 = ratio * ratio * (1.0 - cos * cos);
    if sin2 >= 1.0 {
        return (1.0, None);
    }
    let through = (1.0 - sin2).sqrt();
    let parallel = (cos - ratio * through) / (cos + ratio * through);
    let perpendicular = (ratio * cos - through) / (ratio * cos + through);
    let share = 0.5 * (parallel * parallel + perpendicular * perpendicular);
    let z = if wo[2] > 0.0 { -through } else { through };
    (share, Some([-ratio * wo[0], -ratio * wo[1], z]))
}

/// Interpolates linearly between the angles; constant beyond them.
fn share_at<S: Channels>(shares: &[(f32, S)], wo: Vec3) -> S {
    let theta = libm::acosf(wo[2].abs().min(1.0));
    let after = shares.partition_point(|(angle, _)| *angle <= theta);
    match (after.checked_sub(1).and_then(|before| shares.get(before)), shares.get(after)) {
        (Some((from, a)), Some((to, b))) => {
            let t = (theta - from) / (to - from);
            let mut share = *a;
            for (a, b) in share.as_mut().iter_mut().zip(b.as_ref()) {
                *a += t * (b - *a);
            }
            share
        }
        (Some((_, only)), None) | (None, Some((_, only))) => *only,
        (None, None) => S::ZERO,
    }
}

/// A material that consists only of a [`Delta`].
#[derive(Clone, Debug, PartialEq)]
pub struct DeltaShader<S: Channels = [f32; 3]>(pub Delta<S>);

impl<T: Transport> Shader<T> for DeltaShader<T::Spectrum> {
    fn lobes(&self) -> Lobes {
        Lobes { values: false, delta: true, transmits: self.0.transmits() }
    }

    fn delta(&self) -> Option<&Delta<T::Spectrum>> {
        Some(&self.0)
    }

    /// White, as denoisers expect of smooth surfaces.
    fn albedo(&self) -> [f32; 3] {
        [1.0; 3]
    }

    fn eval(&self, _: TransportMode, _: &[Vec3], _: &[Vec3], out: Evaluated<'_, T>, _: &mut Scratch) {
        out.f.fill(T::ABSORBED);
        out.pdf.fill(0.0);
    }

    fn sample(&self, _: TransportMode, _: &[Vec3], _: &[[f32; 2]], out: Sampled<'_, T>, _: &mut Scratch) {
        out.weight.fill(T::ABSORBED);
        out.pdf.fill(0.0);
    }
}

#[cfg(test)]
mod tests;
