//! Thin films: interference of the light that both surfaces of a film mirror.

use crate::fresnel::{Complex, Elements};

/// A film between two media that are thick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Film {
    /// The refractive index of the medium in front, in which light arrives.
    pub front: f64,
    /// The refractive index of the film.
    pub film: f64,
    /// The complex refractive index `[n, k]` of the medium behind.
    pub behind: [f64; 2],
    /// The thickness of the film over the wavelength in vacuum.
    pub thickness: f64,
}

impl Film {
    /// Reflection at the film and transmission through it, as shares of the energy, for light at this cosine to the
    /// normal in the medium in front. There is no transmission into an absorbing medium, or at total reflection.
    ///
    /// The sum of all reflections within the film: M. Born and E. Wolf, *Principles of optics*, 1.6.4 (7th edition), with
    /// the sign convention of [`fresnel`](crate::fresnel()).
    pub fn elements(&self, cos: f64) -> (Elements, Elements) {
        let cos = cos.clamp(0.0, 1.0);
        let real = |re: f64| Complex { re, im: 0.0 };
        let [front, film, behind] =
            [real(self.front), real(self.film), Complex { re: self.behind[0], im: self.behind[1] }];
        let across = self.front * self.front * (1.0 - cos * cos);
        // The normal component of the wave vector in each medium, over that in vacuum.
        let normal = |index: Complex| index.times(index).plus(real(-across)).root();
        let at = [real(self.front * cos), normal(film), normal(behind)];
        let perpendicular = |a: usize, b: usize| at[a].minus(at[b]).over(at[a].plus(at[b]));
        let indices = [front, film, behind].map(|index| index.times(index));
        let parallel = |a: usize, b: usize| {
            let (x, y) = (indices[b].times(at[a]), indices[a].times(at[b]));
            x.minus(y).over(x.plus(y))
        };
        // The phase of a way forth and back.
        let way = 4.0 * std::f64::consts::PI * self.thickness;
        let (sin, phase) = (way * at[1].re).sin_cos();
        let turn = Complex { re: phase, im: sin }.scaled((-way * at[1].im).exp());
        let sum = |first: Complex, second: Complex| {
            let again = second.times(turn);
            let all = real(1.0).plus(first.times(again));
            (first.plus(again).over(all), all)
        };
        let (rs, all_s) = sum(perpendicular(0, 1), perpendicular(1, 2));
        let (rp, all_p) = sum(parallel(0, 1), parallel(1, 2));
        let mirrored = Elements::of(rs, rp);
        let passes = self.behind[1] == 0.0 && self.behind[0] * self.behind[0] > across;
        if !passes {
            return (mirrored, Elements { a: 0.0, b: 0.0, c: 0.0, s: 0.0 });
        }
        let (ts, tp) = ((1.0 - rs.norm()).max(0.0), (1.0 - rp.norm()).max(0.0));
        // Both parts are delayed by the reflections within the film.
        let delay = all_s.conjugate().times(all_p);
        let mixed = delay.scaled((ts * tp / delay.norm()).sqrt());
        (mirrored, Elements { a: 0.5 * (ts + tp), b: 0.5 * (ts - tp), c: mixed.re, s: -mixed.im })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fresnel;

    fn near(a: Elements, b: Elements) -> bool {
        [a.a - b.a, a.b - b.b, a.c - b.c, a.s - b.s].iter().all(|x| x.abs() < 1e-9)
    }

    #[test]
    fn films_without_thickness_or_contrast_are_not_there() {
        for cos in [1.0, 0.7, 0.2] {
            for behind in [[1.5, 0.0], [0.2, 3.0]] {
                let bare = fresnel(cos, behind[0], behind[1]);
                let thin = Film { front: 1.0, film: 1.33, behind, thickness: 0.0 }.elements(cos);
                assert!(near(thin.0, bare.0) && near(thin.1, bare.1), "{thin:?}, not {bare:?}");
                let air = Film { front: 1.0, film: 1.0, behind, thickness: 0.0 }.elements(cos);
                assert!(near(air.0, bare.0), "{air:?}, not {bare:?}");
            }
            // A film of the index behind it only delays.
            let same = Film { front: 1.0, film: 1.5, behind: [1.5, 0.0], thickness: 0.37 }.elements(cos);
            assert!(near(same.0, fresnel(cos, 1.5, 0.0).0));
        }
    }

    #[test]
    fn a_quarter_wave_of_the_mean_index_mirrors_nothing() {
        let film = Film { front: 1.0, film: 1.5_f64.sqrt(), behind: [1.5, 0.0], thickness: 0.25 / 1.5_f64.sqrt() };
        let (mirrored, passed) = film.elements(1.0);
        assert!(mirrored.a < 1e-12 && (passed.a - 1.0).abs() < 1e-12, "{mirrored:?}");
        // Half a wave is as if there were no film.
        let half = Film { thickness: 2.0 * film.thickness, ..film }.elements(1.0).0;
        assert!((half.a - 0.04).abs() < 1e-9, "{half:?}");
    }

    /// A free film: black if thin; at the normal, R = 4 r^2 sin^2 / ((1 - r^2)^2 + 4 r^2 sin^2) (Airy).
    #[test]
    fn soap_films_follow_airys_formula() {
        let r2 = ((1.33_f64 - 1.0) / 2.33).powi(2);
        for step in 0..20 {
            let thickness = 0.05 * f64::from(step);
            let (mirrored, passed) = Film { front: 1.0, film: 1.33, behind: [1.0, 0.0], thickness }.elements(1.0);
            let sin2 = (2.0 * std::f64::consts::PI * 1.33 * thickness).sin().powi(2);
            let expected = 4.0 * r2 * sin2 / ((1.0 - r2).powi(2) + 4.0 * r2 * sin2);
            assert!((mirrored.a - expected).abs() < 1e-12 && (mirrored.a + passed.a - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn no_light_is_made_and_pure_light_stays_pure() {
        for (front, film, behind) in [(1.0, 1.4, [0.2, 3.0]), (1.5, 1.3, [1.0, 0.0]), (1.0, 2.2, [1.5, 0.0])] {
            for step in 0..=20 {
                let (mirrored, passed) = Film { front, film, behind, thickness: 0.8 }.elements(f64::from(step) / 20.0);
                assert!(mirrored.a <= 1.0 + 1e-12 && mirrored.a + passed.a <= 1.0 + 1e-12);
                for Elements { a, b, c, s } in [mirrored, passed] {
                    assert!((a * a - b * b - c * c - s * s).abs() < 1e-9, "{front} {film}: {a} {b} {c} {s}");
                }
            }
        }
        // Beyond the angle of total reflection, all light comes back from below.
        let below = Film { front: 1.5, film: 1.3, behind: [1.0, 0.0], thickness: 0.8 };
        let (mirrored, passed) = below.elements(0.5);
        assert!((mirrored.a - 1.0).abs() < 1e-12 && passed.a == 0.0);
    }
}
