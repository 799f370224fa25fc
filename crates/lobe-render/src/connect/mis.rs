//! Weights of the techniques that could have made the same path (multiple importance sampling).
//!
//! A path of `k` surfaces is made by following it from the camera over `t` of them and from a light over `s`: the two
//! ends are connected (`s + t = k`; `t = 0` is a light path that the camera sees, `s = 0` a camera path for which a
//! light is sampled, or which hits one), or merged where both are at the same surface (`s + t = k + 1`). The weight of
//! a technique is its density over the sum of those of all techniques (the balance heuristic). Both ends carry three
//! sums of ratios of densities, from which that weight follows where they meet, whatever their lengths: Georgiev,
//! Krivanek, Davidovic and Slusallek 2012 ("Light Transport Simulation with Vertex Connection and Merging") and
//! Georgiev's report on its implementation, whose names `vcm`, `vc` and `vm` are kept.
//!
//! Chances that do not depend on the pair of directions (Russian roulette, the choice among the lobes of smooth
//! surfaces) are left out of all densities. Weights are then those of slightly other densities, and still sum to 1.

use std::f32::consts::PI;

/// How many samples the techniques of a pass have compared with one connection.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Factors {
    /// Light paths that the camera may see; 0 if they are not connected to it.
    pub paths: f32,
    /// Light paths times the area that merging covers; 0 without merging.
    pub merging: f32,
    /// The reciprocal of that; 0 without merging.
    pub connecting: f32,
}

impl Factors {
    /// Of a pass of so many light paths, with merging over this radius.
    pub fn new(paths: u32, radius: Option<f32>) -> Self {
        let paths = paths as f32;
        let merging = radius.map_or(0.0, |radius| PI * radius * radius * paths);
        Factors { paths, merging, connecting: if merging > 0.0 { 1.0 / merging } else { 0.0 } }
    }
}

/// The sums of one end of a path.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Mis {
    vcm: f32,
    vc: f32,
    vm: f32,
}

/// The densities of a ray that leaves a light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Emission {
    /// Over area on the light, or on the disk that its light enters the scene through.
    pub position: f32,
    /// Over solid angle, 1/sr.
    pub direction: f32,
    /// The chance of the light.
    pub chance: f32,
    /// The cosine at the light; 1 if it has no surface.
    pub cos: f32,
    /// Whether it has a place.
    pub finite: bool,
    /// Whether no ray reaches it by chance.
    pub delta: bool,
}

/// So that no sum becomes infinite, and products of infinity and 0 do not occur.
const MOST: f32 = 1e30;

fn bounded(x: f32) -> f32 {
    x.min(MOST)
}

impl Mis {
    /// At the beginning of a light path.
    pub fn of_light(emission: Emission, factors: Factors) -> Self {
        let Emission { position, direction, chance, cos, finite, delta } = emission;
        let vcm = if finite { 1.0 / direction } else { 1.0 / position };
        let vc = if delta { 0.0 } else { cos / (position * direction * chance) };
        Mis { vcm: bounded(vcm), vc: bounded(vc), vm: bounded(vc * factors.connecting) }
    }

    /// At the beginning of a camera path, whose directions have that density, summed over all pixels; 0 if the camera
    /// does not see light paths.
    pub fn of_camera(density: f32, factors: Factors) -> Self {
        Mis { vcm: bounded(factors.paths / density), vc: 0.0, vm: 0.0 }
    }

    /// At a surface that meets the ray at that cosine. The distance is squared; it is 1 for the first ray of a light
    /// that has no place.
    pub fn arrive(&mut self, distance: f32, cos: f32) {
        let cos = cos.max(1e-6);
        *self = Mis { vcm: bounded(self.vcm * distance / cos), vc: bounded(self.vc / cos), vm: bounded(self.vm / cos) };
    }

    /// Scattered by a surface, which the path leaves at that cosine: with the density of the direction, and of the
    /// reverse path's.
    pub fn scatter(&mut self, cos: f32, forward: f32, reverse: f32, factors: Factors) {
        let Mis { vcm, vc, vm } = *self;
        let ratio = cos / forward;
        *self = Mis {
            vcm: bounded(1.0 / forward),
            vc: bounded(ratio * (vc * reverse + vcm + factors.merging)),
            vm: bounded(ratio * (vm * reverse + vcm * factors.connecting + 1.0)),
        };
    }

    /// Sent into an exact direction, in which the path leaves the surface at that cosine.
    pub fn mirror(&mut self, cos: f32) {
        *self = Mis { vcm: 0.0, vc: bounded(self.vc * cos), vm: bounded(self.vm * cos) };
    }

    /// Of a camera path that has hit a light. `direct` is the density with which a light path begins there (over
    /// solid angle if the light has no place), `emission` that with which it also goes back along the path.
    pub fn found(&self, direct: f32, emission: f32) -> f32 {
        1.0 / (1.0 + direct * self.vcm + emission * self.vc)
    }

    /// Of a light sampled for the surface at the end of a camera path. `hit` is the density with which the material
    /// samples the direction of the light over that of sampling the light; `back` the density over the surface with
    /// which the light sends rays there; `reverse` that of the material for the direction that the path has come from.
    pub fn next_event(&self, hit: f32, back: f32, reverse: f32, factors: Factors) -> f32 {
        1.0 / (1.0 + hit + back * (factors.merging + self.vcm + self.vc * reverse))
    }

    /// Of the end of a light path as the camera sees it. `seen` is the density over the surface of all camera rays.
    pub fn splatted(&self, seen: f32, reverse: f32, factors: Factors) -> f32 {
        1.0 / (1.0 + seen / factors.paths * (factors.merging + self.vcm + self.vc * reverse))
    }

    /// Of two ends that are connected. Each has the density over its surface with which the other end's material
    /// samples it, and that of its material for the direction that it has come from.
    pub fn connect(light: Meeting<'_>, camera: Meeting<'_>, factors: Factors) -> f32 {
        let share = |end: &Meeting<'_>| end.density * (factors.merging + end.mis.vcm + end.mis.vc * end.reverse);
        1.0 / (1.0 + share(&light) + share(&camera))
    }

    /// Of two ends that are merged: `forward` is the density of the camera path's material for the direction that the
    /// light comes from, `reverse` that for the opposite way.
    pub fn merge(light: &Mis, camera: &Mis, [forward, reverse]: [f32; 2], factors: Factors) -> f32 {
        let back = light.vcm * factors.connecting + light.vm * forward;
        let on = camera.vcm * factors.connecting + camera.vm * reverse;
        1.0 / (1.0 + back + on)
    }
}

/// One of two ends that are connected.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Meeting<'a> {
    pub mis: &'a Mis,
    /// Over its surface, with which the other end's material samples it.
    pub density: f32,
    /// Over solid angle, of its material for the direction that it has come from.
    pub reverse: f32,
}

#[cfg(test)]
mod tests;
