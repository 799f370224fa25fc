use super::*;

/// A path of `k` surfaces between a light and a camera, with everything that densities depend on.
struct Known {
    light: Emission,
    /// The density of camera rays, summed over pixels.
    camera: f32,
    /// Squared lengths of the segments from the light to the camera, one more than there are surfaces.
    lengths: Vec<f32>,
    surfaces: Vec<Surface>,
}

#[derive(Clone, Copy)]
struct Surface {
    /// Cosines toward the light and toward the camera.
    to_light: f32,
    to_camera: f32,
    /// Densities over solid angle of sampling the direction towards the camera (light path) and towards the light
    /// (camera path).
    onward: f32,
    back: f32,
    smooth: bool,
}

/// Numbers in `[0, 1)`.
struct Chance(u32);

impl Chance {
    fn next(&mut self) -> f32 {
        self.0 = self.0.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
        ((self.0 >> 8) as f32) / 16_777_216.0
    }

    fn between(&mut self, from: f32, to: f32) -> f32 {
        from * (to / from).powf(self.next())
    }
}

fn path(k: usize, seed: u32, smooth: bool) -> Known {
    let mut chance = Chance(seed);
    let kind = seed % 4;
    let (finite, delta) = (kind < 2, kind % 2 == 1);
    let light = Emission {
        position: if finite && delta { 1.0 } else { chance.between(0.05, 20.0) },
        direction: if !finite && delta { 1.0 } else { chance.between(0.05, 2.0) },
        chance: chance.between(0.1, 1.0),
        cos: if finite && !delta { chance.between(0.1, 1.0) } else { 1.0 },
        finite,
        delta,
    };
    let lengths = (0..=k).map(|_| chance.between(0.1, 9.0)).collect();
    let camera = chance.between(1.0, 1000.0);
    let surfaces = (0..k).map(|_| {
        let smooth = smooth && chance.next() < 0.4;
        let (onward, back) = (chance.between(0.02, 50.0), chance.between(0.02, 50.0));
        // A smooth surface has the same density, an arbitrary one, in both directions.
        let back = if smooth { onward } else { back };
        Surface { to_light: chance.between(0.1, 1.0), to_camera: chance.between(0.1, 1.0), onward, back, smooth }
    });
    Known { light, camera, surfaces: surfaces.collect(), lengths }
}

/// The density of a technique over the areas of all surfaces, times the number of its samples: `s` surfaces from the
/// light and the rest from the camera, which ends at the light itself if `hit`.
impl Known {
    /// Density over the area of surface `i` of a light path.
    fn onward(&self, i: usize) -> f64 {
        let (squared, cos) = (f64::from(self.lengths[i]), f64::from(self.surfaces[i].to_light));
        if i == 0 {
            let Emission { position, direction, chance, finite, .. } = self.light;
            let [position, direction, chance] = [position, direction, chance].map(f64::from);
            return chance * position * direction * cos / if finite { squared } else { 1.0 };
        }
        f64::from(self.surfaces[i - 1].onward) * cos / squared
    }

    /// Density over the area of surface `i` of a camera path.
    fn back(&self, i: usize) -> f64 {
        let (squared, cos) = (f64::from(self.lengths[i + 1]), f64::from(self.surfaces[i].to_camera));
        let over = match self.surfaces.get(i + 1) {
            Some(next) => f64::from(next.back),
            None => f64::from(self.camera),
        };
        over * cos / squared
    }

    /// Density of sampling the light alone.
    fn direct(&self) -> f64 {
        let Emission { position, direction, chance, finite, .. } = self.light;
        f64::from(chance) * f64::from(if finite { position } else { direction })
    }

    /// Density of finding the light from surface 0, in the same measure.
    fn found(&self) -> f64 {
        if self.light.delta {
            return 0.0;
        }
        let over = f64::from(self.surfaces[0].back);
        if self.light.finite { over * f64::from(self.light.cos) / f64::from(self.lengths[0]) } else { over }
    }

    fn connection(&self, s: usize, factors: Factors) -> f64 {
        let k = self.surfaces.len();
        // A smooth surface cannot be the end of a connection.
        if (s > 0 && self.surfaces[s - 1].smooth) || (s < k && self.surfaces[s].smooth) {
            return 0.0;
        }
        let light = if s == 0 { self.direct() } else { (0..s).map(|i| self.onward(i)).product() };
        let camera: f64 = (s..k).map(|i| self.back(i)).product();
        light * camera * if s == k { f64::from(factors.paths) } else { 1.0 }
    }

    fn hit(&self) -> f64 {
        (0..self.surfaces.len()).map(|i| self.back(i)).product::<f64>() * self.found()
    }

    /// At surface `i`.
    fn merged(&self, i: usize, factors: Factors) -> f64 {
        if self.surfaces[i].smooth {
            return 0.0;
        }
        let light: f64 = (0..=i).map(|i| self.onward(i)).product();
        let camera: f64 = (i..self.surfaces.len()).map(|i| self.back(i)).product();
        light * camera * f64::from(factors.merging)
    }

    /// The sums of a light path and of a camera path at surface `i`.
    fn ends(&self, factors: Factors) -> (Vec<Mis>, Vec<Mis>) {
        let k = self.surfaces.len();
        let mut light = Vec::new();
        let mut mis = Mis::of_light(self.light, factors);
        for (i, surface) in self.surfaces.iter().enumerate() {
            let far = i == 0 && !self.light.finite;
            mis.arrive(if far { 1.0 } else { self.lengths[i] }, surface.to_light);
            light.push(mis);
            match surface.smooth {
                true => mis.mirror(surface.to_camera),
                false => mis.scatter(surface.to_camera, surface.onward, surface.back, factors),
            }
        }
        let mut camera = vec![Mis::default(); k];
        let mut mis = Mis::of_camera(self.camera, factors);
        for (i, surface) in self.surfaces.iter().enumerate().rev() {
            mis.arrive(self.lengths[i + 1], surface.to_camera);
            camera[i] = mis;
            match surface.smooth {
                true => mis.mirror(surface.to_light),
                false => mis.scatter(surface.to_light, surface.back, surface.onward, factors),
            }
        }
        (light, camera)
    }

    /// The weights of all techniques, each with its expected value.
    fn weights(&self, factors: Factors) -> Vec<[f64; 2]> {
        let k = self.surfaces.len();
        let (light, camera) = self.ends(factors);
        let mut densities: Vec<f64> = (0..=k).map(|s| self.connection(s, factors)).collect();
        densities.push(self.hit());
        densities.extend((0..k).map(|i| self.merged(i, factors)));
        let sum: f64 = densities.iter().sum();
        let mut found = Vec::new();
        for (s, density) in densities.iter().enumerate().take(k + 1) {
            let shares = |weight: f32| f64::from(weight);
            found.push(if *density == 0.0 {
                0.0
            } else if s == k {
                let last = &self.surfaces[k - 1];
                let seen = self.camera * last.to_camera / self.lengths[k];
                shares(light[k - 1].splatted(seen, last.back, factors))
            } else if s == 0 {
                let first = &self.surfaces[0];
                let hit = if self.light.delta { 0.0 } else { (self.found() / self.direct()) as f32 };
                let back = (self.onward(0) / self.direct()) as f32;
                shares(camera[0].next_event(hit, back, first.onward, factors))
            } else {
                let (a, b) = (&self.surfaces[s - 1], &self.surfaces[s]);
                let squared = self.lengths[s];
                let light = Meeting { mis: &light[s - 1], density: b.back * a.to_camera / squared, reverse: a.back };
                let camera = Meeting { mis: &camera[s], density: a.onward * b.to_light / squared, reverse: b.onward };
                shares(Mis::connect(light, camera, factors))
            });
        }
        found.push(if self.light.delta {
            0.0
        } else {
            // The sums behind surface 0.
            let first = &self.surfaces[0];
            let mut mis = camera[0];
            match first.smooth {
                true => mis.mirror(first.to_light),
                false => mis.scatter(first.to_light, first.back, first.onward, factors),
            }
            if self.light.finite {
                mis.arrive(self.lengths[0], self.light.cos);
            }
            let Emission { position, direction, chance, .. } = self.light;
            f64::from(mis.found(self.direct() as f32, chance * position * direction))
        });
        for (i, surface) in self.surfaces.iter().enumerate() {
            let weight = Mis::merge(&light[i], &camera[i], [surface.back, surface.onward], factors);
            found.push(if densities[k + 2 + i] == 0.0 { 0.0 } else { f64::from(weight) });
        }
        found.into_iter().zip(densities).map(|(found, density)| [found, density / sum]).collect()
    }
}

#[test]
fn weights_follow_from_the_densities_and_sum_to_one() {
    for merging in [None, Some(0.02)] {
        let factors = Factors::new(500, merging);
        for k in 1..=7 {
            for seed in 0..400 {
                for smooth in [false, true] {
                    let path = path(k, seed, smooth);
                    let weights = path.weights(factors);
                    if weights.iter().all(|[_, expected]| expected.is_nan()) {
                        // No technique generates a path of smooth surfaces between a point and a pinhole.
                        continue;
                    }
                    let sum: f64 = weights.iter().map(|[found, _]| found).sum();
                    assert!((sum - 1.0).abs() < 1e-4, "{k} surfaces, seed {seed}: {sum} of {weights:?}");
                    for [found, expected] in weights {
                        assert!((found - expected).abs() < 1e-4, "{k} surfaces, seed {seed}: {found}, not {expected}");
                    }
                }
            }
        }
    }
}
