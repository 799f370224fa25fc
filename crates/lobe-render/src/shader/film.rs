//! Surfaces with a thin film, tabulated over the angle.

use std::sync::Arc;

use lobe::{Bsdf, Directions};
use lobe_model::{Elements, Film, Ggx};
use lobe_spectrum::Spectrum;
use lobe_table::Channels as Named;

use super::Backend;
use super::models::{turned, turns};
use super::pairs::each_pair;
use crate::channels::Channels;
use crate::transport::Transport;

/// The number of cosines of a table, on each side. Films of 5000 nm have up to 33 fringes.
const COSINES: usize = 1024;

/// The elements of [`Elements`] in each channel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilmElements<S> {
    /// `a`, `b`, `c` and `s`.
    pub of: [S; 4],
}

/// Reflection and transmission at each of the cosines, from the front or from the back.
type Side<S> = Vec<[FilmElements<S>; 2]>;

/// The effect of a film on light from either side, by the cosine to the normal.
#[derive(Clone, Debug, PartialEq)]
pub struct FilmTable<S> {
    sides: [Side<S>; 2],
}

/// The wavelengths over which red, green and blue are integrated, in nm, and the step between them.
const STEP: f64 = 10.0;

fn fine() -> Vec<f64> {
    (0..=30).map(|k| 400.0 + STEP * f64::from(k)).collect()
}

/// Wavelengths around one of these, with weights, because thick films have fringes that are narrower than a step.
fn around(nm: f64) -> Vec<(f64, f64)> {
    let offsets = (-4..=4).map(|k| 0.2 * STEP * f64::from(k));
    offsets.map(|offset| (nm + offset, 0.2 * (1.0 - offset.abs() / STEP))).collect()
}

impl<S: Channels> FilmTable<S> {
    /// The table of a film whose refractive indices and thickness are given at a wavelength in nm: for light from the
    /// front, and from the back. Red, green and blue are those under D65.
    pub fn new<T: Transport<Spectrum = S>>(basis: &T::Basis, film: impl Fn(f64) -> [Film; 2]) -> Self {
        let followed = T::wavelengths(basis);
        let wavelengths = followed.map_or_else(fine, <[f64]>::to_vec);
        let near = |nm: f64| if followed.is_some() { vec![(nm, 1.0)] } else { around(nm) };
        let films: Vec<Vec<([Film; 2], f64)>> = wavelengths
            .iter()
            .map(|nm| near(*nm).into_iter().map(|(nm, weight)| (film(nm), weight)).collect())
            .collect();
        let row = |side: usize, step: usize| {
            let cos = step as f64 / (COSINES - 1) as f64;
            let at: Vec<(Elements, Elements)> = films.iter().map(|films| mean(films, side, cos)).collect();
            let reduced = |of: &dyn Fn(&(Elements, Elements)) -> Elements| {
                FilmElements::of::<T>(basis, &wavelengths, &at.iter().map(of).collect::<Vec<Elements>>())
            };
            [reduced(&|(mirrored, _)| *mirrored), reduced(&|(_, passed)| *passed)]
        };
        FilmTable { sides: [0, 1].map(|side| (0..COSINES).map(|step| row(side, step)).collect()) }
    }

    /// Reflection and transmission of light from the front or the back, at this cosine to the normal.
    pub fn at(&self, is_front: bool, cos: f32) -> [FilmElements<S>; 2] {
        let side = &self.sides[usize::from(!is_front)];
        let place = cos.clamp(0.0, 1.0) * (COSINES - 1) as f32;
        let cell = (place as usize).min(COSINES - 2);
        let (low, high, share) = (&side[cell], &side[cell + 1], place - cell as f32);
        [0, 1].map(|way| low[way].between(&high[way], share))
    }
}

/// The weighted mean of films.
fn mean(films: &[([Film; 2], f64)], side: usize, cos: f64) -> (Elements, Elements) {
    let none = Elements { a: 0.0, b: 0.0, c: 0.0, s: 0.0 };
    let add = |sum: Elements, e: Elements, weight: f64| Elements {
        a: sum.a + weight * e.a,
        b: sum.b + weight * e.b,
        c: sum.c + weight * e.c,
        s: sum.s + weight * e.s,
    };
    films.iter().fold((none, none), |(mirrored, passed), (film, weight)| {
        let (m, p) = film[side].elements(cos);
        (add(mirrored, m, *weight), add(passed, p, *weight))
    })
}

impl<S: Channels> FilmElements<S> {
    /// The elements in the channels of a picture.
    fn of<T: Transport<Spectrum = S>>(basis: &T::Basis, wavelengths: &[f64], elements: &[Elements]) -> Self {
        // Shares between 0 and 1, as spectra are.
        let share = |of: &dyn Fn(&Elements) -> f64| {
            let values = elements.iter().map(|e| of(e).clamp(0.0, 1.0)).collect();
            let spectrum = Spectrum::new(wavelengths.to_vec(), values);
            spectrum.map_or(S::ZERO, |spectrum| T::reflectance_of(basis, &spectrum))
        };
        let [across, within] = [share(&|e| e.a + e.b), share(&|e| e.a - e.b)];
        let signed = [share(&|e| 0.5 + 0.5 * e.c), share(&|e| 0.5 + 0.5 * e.s)];
        let mut out = [S::ZERO; 4];
        for k in 0..S::COUNT {
            let (rs, rp) = (across.as_ref()[k], within.as_ref()[k]);
            // What was clipped must not be more polarised than it is bright. Unused channels are 0.
            let most = (rs * rp).sqrt();
            let [c, s] = signed.map(|signed| 2.0 * signed.as_ref()[k] - 1.0);
            let scale = (most / libm::hypotf(c, s).max(f32::MIN_POSITIVE)).min(1.0);
            for (out, value) in out.iter_mut().zip([0.5 * (rs + rp), 0.5 * (rs - rp), c * scale, s * scale]) {
                out.as_mut()[k] = value;
            }
        }
        FilmElements { of: out }
    }

    fn between(&self, other: &Self, share: f32) -> Self {
        let mut of = self.of;
        for (element, other) in of.iter_mut().zip(&other.of) {
            element.as_mut().iter_mut().zip(other.as_ref()).for_each(|(a, b)| *a += share * (b - *a));
        }
        FilmElements { of }
    }
}

/// Rough microfacets, each with a film.
#[derive(Debug)]
pub(crate) struct RoughFilm<S> {
    pub ggx: Ggx,
    pub table: Arc<FilmTable<S>>,
    pub channels: Named,
}

impl<S: Channels> RoughFilm<S> {
    /// What perfect mirrors would reflect, and the elements of each facet.
    fn at(&self, wi: [f64; 3], wo: [f64; 3]) -> (f32, FilmElements<S>) {
        let cos = 0.5 * (1.0 + wi.iter().zip(wo).map(|(a, b)| a * b).sum::<f64>());
        let [mirrored, _] = self.table.at(true, cos.clamp(0.0, 1.0).sqrt() as f32);
        (self.ggx.mirrors(wi, wo) as f32, mirrored)
    }
}

impl<S: Channels> Bsdf for RoughFilm<S> {
    fn channels(&self) -> &Named {
        &self.channels
    }

    fn eval_batch(&self, _: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) {
        each_pair(wi, wo, self.channels.count(), out, |wi, wo, texel| {
            let (mirrors, elements) = self.at(wi, wo);
            texel.iter_mut().zip(elements.of[0].as_ref()).for_each(|(out, a)| *out = mirrors * a);
        });
    }

    fn is_polarised(&self) -> bool {
        true
    }

    fn mueller_batch(&self, _: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) -> bool {
        each_pair(wi, wo, 16 * self.channels.count(), out, |wi, wo, matrices| {
            let (mirrors, elements) = self.at(wi, wo);
            let (before, after) = if mirrors > 0.0 { turns(wi, wo) } else { ([1.0, 0.0], [1.0, 0.0]) };
            for (channel, out) in matrices.chunks_exact_mut(16).enumerate() {
                let [a, b, c, s] = elements.of.map(|element| f64::from(mirrors * element.as_ref()[channel]));
                let matrix = turned(Elements { a, b, c, s }.matrix(), before, after);
                out.iter_mut().zip(matrix.as_flattened()).for_each(|(out, m)| *out = *m as f32);
            }
        });
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::transport::{Bands, Rgb};

    fn soap(nm: f64) -> [Film; 2] {
        [Film { front: 1.0, film: 1.33, behind: [1.0, 0.0], thickness: 300.0 / nm }; 2]
    }

    #[test]
    fn tables_have_the_elements_of_the_film() {
        let basis = Arc::new(lobe_spectrum::Bands::uniform(8).unwrap());
        let table = FilmTable::new::<Bands<8>>(&basis, soap);
        for cos in [0.05, 0.35, 0.777, 1.0] {
            let [mirrored, passed] = table.at(true, cos);
            for (k, nm) in basis.wavelengths().iter().enumerate() {
                let (expected, through) = soap(*nm)[0].elements(f64::from(cos));
                for (found, expected) in [(mirrored, expected), (passed, through)] {
                    for (found, expected) in found.of.iter().zip([expected.a, expected.b, expected.c, expected.s]) {
                        let found = f64::from(found[k]);
                        assert!((found - expected).abs() < 1e-3, "{cos}, {nm} nm: {found}, not {expected}");
                    }
                }
            }
        }
    }

    #[test]
    fn colours_are_those_of_the_spectrum_under_daylight() {
        let table = FilmTable::new::<Rgb>(&(), soap);
        let bands = Arc::new(lobe_spectrum::Bands::uniform(32).unwrap());
        let spectral = FilmTable::new::<Bands<32>>(&bands, soap);
        let [mirrored, _] = table.at(true, 1.0);
        let [of_bands, _] = spectral.at(true, 1.0);
        let seen: Vec<f32> = of_bands.of[0].iter().zip(bands.emission([1.0; 3])).map(|(a, light)| a * light).collect();
        for (found, expected) in mirrored.of[0].iter().zip(bands.colour(&seen)) {
            assert!((found - expected.max(0.0)).abs() < 4e-3, "{:?}, not {:?}", mirrored.of[0], bands.colour(&seen));
        }
        // A film of 300 nm is not grey.
        let [r, g, b] = mirrored.of[0];
        assert!((r - b).abs() > 0.01 || (g - b).abs() > 0.01, "{r} {g} {b}");
    }
}
