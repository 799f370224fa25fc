//! Splats: contributions of light paths, which may go to any pixel.

use super::pixel::{add_radiance, mean_radiance, merge_sums};
use super::{Channels, Film, Filter, Rect, Transport};
use crate::transport::RadianceSums;

/// The splats of one pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Splat<T: Transport> {
    /// In units of [`RADIANCE_UNIT`](super::RADIANCE_UNIT).
    pub sums: RadianceSums<T>,
    /// Number of light paths that could have reached the pixel.
    pub paths: u64,
}

impl<T: Transport> Splat<T> {
    const EMPTY: Self = Splat { sums: T::Radiance::ZERO_SUMS, paths: 0 };

    pub fn mean_radiance(&self) -> T::Radiance {
        mean_radiance::<T>(&self.sums, self.paths)
    }
}

impl<T: Transport> Film<T> {
    /// Counts light paths that could have reached every pixel of the window, whether or not they have splatted.
    pub fn add_light_paths(&mut self, paths: u64) {
        self.splats_mut().iter_mut().for_each(|splat| splat.paths += paths);
    }

    /// Adds the contribution of a light path at a position in the picture: columns from its left edge and rows from its
    /// top edge, in pixels. The filter spreads it in the same way as the samples of pixels, so that both have equal
    /// means. Parts outside the window are dropped. Returns `false` if the radiance was not finite: it then counts
    /// as 0.
    ///
    /// A pixel shows the mean over light paths. [Importance](crate::View::sample_we) integrates to 1 over the whole
    /// film, but a contribution refers to one pixel, so it is multiplied by the number of pixels of the picture.
    pub fn splat(&mut self, at: [f32; 2], radiance: T::Radiance, filter: Filter) -> bool {
        match filter {
            Filter::Box => self.splat_pixel(at.map(|x| f64::from(x).floor()), &radiance, 1.0),
            Filter::Tent => {
                let at = at.map(|x| f64::from(x) - 0.5);
                let corner = at.map(f64::floor);
                let share = [at[0] - corner[0], at[1] - corner[1]];
                let mut finite = true;
                for (dy, v) in [(0.0, 1.0 - share[1]), (1.0, share[1])] {
                    for (dx, u) in [(0.0, 1.0 - share[0]), (1.0, share[0])] {
                        finite &= self.splat_pixel([corner[0] + dx, corner[1] + dy], &radiance, (u * v) as f32);
                    }
                }
                finite
            }
        }
    }

    fn splat_pixel(&mut self, [x, y]: [f64; 2], radiance: &T::Radiance, share: f32) -> bool {
        let Rect { x: left, y: top, width, height } = self.window;
        let (column, row) = (x - f64::from(left), y - f64::from(top));
        // Both are false for NaN.
        let inside = column >= 0.0 && row >= 0.0 && column < f64::from(width) && row < f64::from(height);
        if !inside || share == 0.0 {
            return radiance.as_ref().iter().all(|value| value.is_finite());
        }
        let index = row as usize * width as usize + column as usize;
        add_radiance::<T>(&mut self.splats_mut()[index].sums, &radiance.map(|value| value * share))
    }

    /// The splats, one per pixel; none if no light path was added.
    pub(crate) fn splats(&self) -> &[Splat<T>] {
        &self.splats
    }

    /// The splats for writing, one per pixel.
    pub(crate) fn splats_mut(&mut self) -> &mut [Splat<T>] {
        self.splats.resize(self.window.area(), Splat::EMPTY);
        &mut self.splats
    }

    pub(super) fn merge_splats(&mut self, other: &Film<T>, shared: Rect) {
        if other.splats.is_empty() {
            return;
        }
        self.splats_mut();
        for y in shared.rows() {
            for x in shared.columns() {
                let (at, from) = (self.index(x, y), other.index(x, y));
                merge_sums::<T>(&mut self.splats[at].sums, &other.splats[from].sums);
                self.splats[at].paths = self.splats[at].paths.saturating_add(other.splats[from].paths);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::transport::Rgb;

    const WINDOW: Rect = Rect { x: 3, y: 2, width: 8, height: 6 };

    fn splats() -> Vec<([f32; 2], [f32; 3])> {
        (0..500)
            .map(|i| {
                let at = |step: f32, size: f32| (i as f32 * step).fract() * size;
                ([1.0 + at(0.618_034, 12.0), at(0.754_878, 10.0)], [at(0.37, 1e-9), at(0.11, 1.0), at(0.23, 1e6)])
            })
            .collect()
    }

    fn splatted<'a>(window: Rect, splats: impl Iterator<Item = &'a ([f32; 2], [f32; 3])>, filter: Filter) -> Film {
        let mut film = Film::new(window);
        for (at, radiance) in splats {
            film.add_light_paths(1);
            assert!(film.splat(*at, *radiance, filter));
        }
        film
    }

    #[test]
    fn splats_merge_to_the_same_bits_in_any_order() {
        let splats = splats();
        for filter in [Filter::Box, Filter::Tent] {
            let whole = splatted(WINDOW, splats.iter(), filter);
            assert!(whole == splatted(WINDOW, splats.iter().rev(), filter), "{filter:?}");
            let mut merged = splatted(WINDOW, splats[300..].iter(), filter);
            merged.merge(&splatted(WINDOW, splats[..300].iter(), filter));
            assert!(whole == merged, "{filter:?}, parts of the paths");
            // Parts of the picture, each with all of the paths.
            let mut tiles = Film::new(WINDOW);
            for (x, width) in [(3, 5), (8, 3)] {
                tiles.merge(&splatted(Rect { x, width, ..WINDOW }, splats.iter(), filter));
            }
            assert!(whole == tiles, "{filter:?}, parts of the picture");
        }
    }

    #[test]
    fn splats_have_the_mean_of_samples() {
        let mut film = Film::<Rgb>::new(WINDOW);
        film.add_light_paths(4);
        assert!(film.splat([5.7, 4.2], [8.0, 4.0, 0.0], Filter::Box));
        let pixel = film.index(5, 4);
        assert_eq!(film.radiance(pixel), [2.0, 1.0, 0.0]);
        film.pixels_mut()[pixel].add(&super::super::Sample { radiance: [1.0; 3], ..super::super::Sample::EMPTY });
        assert_eq!(film.radiance(pixel), [3.0, 2.0, 1.0]);
        let sum: f32 = film.colours().map(|c| c[0]).sum();
        assert_eq!(sum, 3.0);
        // A tent in the middle of four pixels, and one over the edge of the window.
        let mut film = Film::<Rgb>::new(WINDOW);
        film.add_light_paths(1);
        assert!(film.splat([6.0, 5.0], [4.0; 3], Filter::Tent));
        for (x, y) in [(5, 4), (6, 4), (5, 5), (6, 5)] {
            assert_eq!(film.radiance(film.index(x, y)), [1.0; 3]);
        }
        assert!(film.splat([3.0, 3.5], [4.0; 3], Filter::Tent));
        assert_eq!(film.radiance(film.index(3, 3)), [2.0; 3]);
        // A position outside, and a radiance that is not a number.
        assert!(film.splat([-1e30, f32::NAN], [1.0; 3], Filter::Tent));
        assert!(!film.splat([5.5, 4.5], [f32::NAN; 3], Filter::Box));
        assert_eq!(film.radiance(film.index(5, 4)), [1.0; 3]);
    }

    #[test]
    fn a_film_without_splats_is_the_mean_of_its_samples() {
        let mut film = Film::<Rgb>::new(WINDOW);
        film.pixels_mut()[7].add(&super::super::Sample { radiance: [-0.0, 1.0, 0.3], ..super::super::Sample::EMPTY });
        assert!(film.splats().is_empty());
        let radiance = film.radiance(7);
        assert_eq!(radiance.map(f32::to_bits), film.pixels()[7].mean_radiance().map(f32::to_bits));
    }
}
