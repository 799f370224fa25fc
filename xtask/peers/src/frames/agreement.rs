//! Checks that both renderers make the same picture, by comparing the difference with the noise of both.

use std::path::Path;

use anyhow::bail;
use lobe::{Backend, Given};
use lobe_render::{Film, render};
use serde::Serialize;

use super::scene::{Room, settings};
use super::{Subject, VARIANTS, picture, subjects};
use crate::exchange::Exchange;
use crate::program::Programs;
use xtask_common::{Grid, replace};

/// Width and height of the pictures.
const SIZE: [u32; 2] = [320, 320];
/// Samples per pixel of each of the two pictures by each renderer.
const SAMPLES: u32 = 48;
/// Differences of a pixel that is darker than this count as if it had this radiance.
const FLOOR: f64 = 0.02;
/// By how much the difference may exceed the noise. Its own error is half a per cent.
const LIMIT: f64 = 1.03;

/// How much the pictures differ. All figures are root mean squares over pixels and channels, relative to the pixel.
#[derive(Clone, Debug, Serialize)]
pub struct Agreement {
    /// The name of the room.
    pub on: &'static str,
    /// The difference of the two pictures.
    pub difference: f64,
    /// The noise of this renderer's picture.
    pub noise: f64,
    /// The noise of the other's.
    pub peer_noise: f64,
    /// The mean of this renderer's picture divided by the mean of the other's.
    pub mean: f64,
    /// The mean if measured materials are indexed by the light, divided by the mean of the other's.
    pub mean_by_light: f64,
}

impl Agreement {
    /// The difference divided by the combined noise of both.
    fn ratio(&self) -> f64 {
        self.difference / self.noise.hypot(self.peer_noise)
    }

    fn cells(&self) -> Vec<String> {
        let percent = |share: f64| format!("{:.2} %", 100.0 * share);
        vec![
            self.on.into(),
            percent(self.noise),
            percent(self.peer_noise),
            percent(self.noise.hypot(self.peer_noise)),
            percent(self.difference),
            percent(self.mean - 1.0),
            percent(self.mean_by_light - 1.0),
        ]
    }
}

const HEADER: [&str; 7] = ["room", "noise", "Mitsuba's noise", "both", "difference", "of means", "indexed by light"];

/// The table; `None` if nothing was rendered.
pub fn grid(agreements: &[Agreement]) -> Option<Grid> {
    let rows = agreements.iter().map(Agreement::cells).collect();
    (!agreements.is_empty()).then(|| Grid::new("Pictures", READING, HEADER, rows))
}

const READING: &str = "\
Both programs path-trace the same rooms, lit by a panel and a sky, with 96 samples per pixel. Figures are root mean
squares over pixels and channels, relative to the pixel. The noise is estimated from two pictures per program,
rendered with different random numbers; a `difference` no larger than the noise of `both` together means that the
pictures agree. Measured materials are indexed by the viewer, as in Mitsuba; the last column is the difference of the
means if they are indexed by the light.";

/// The rooms and the tasks of the other renderer.
pub struct Question {
    rooms: Vec<(&'static str, Room)>,
}

impl Question {
    /// The name by which it can be selected.
    pub const NAME: &str = "picture";

    /// Requests pictures of all rooms.
    ///
    /// # Errors
    /// If a file cannot be written.
    pub fn new(data: &Path, exchange: &mut Exchange) -> anyhow::Result<Self> {
        let mut rooms = Vec::new();
        for Subject { name, surfaces, .. } in subjects(data) {
            let room = Room::new(surfaces);
            let scene = room.task(&exchange.directory().join(task(name)), SIZE, SAMPLES)?;
            exchange.task(&task(name), scene);
            rooms.push((name, room));
        }
        Ok(Question { rooms })
    }

    /// Renders and compares. The pictures of the last room go to `file`, side by side.
    ///
    /// # Errors
    /// If pictures differ by more than noise, or a program fails.
    pub fn answer(&self, programs: &mut Programs, exchange: &Exchange, file: &Path) -> anyhow::Result<Vec<Agreement>> {
        let mut agreements = Vec::new();
        let (program, _) = VARIANTS[0];
        if !programs.has(program) {
            return Ok(agreements);
        }
        for (name, room) in &self.rooms {
            let name: &'static str = name;
            let answer = exchange.answer(program, &task(name));
            programs.write(program, &task(name), &answer)?;
            let values = exchange.read(&answer, 2 * 3 * (SIZE[0] * SIZE[1]) as usize)?;
            std::fs::remove_file(&answer)?;
            let (first, second) = values.split_at(values.len() / 2);
            let theirs = Pair::new(first, second);
            // A sequence of samples restarts after 2^16 of them, scrambled differently.
            let [first, second] = [0, 1 << 16].map(|from| frame(room, Given::Viewer, from));
            let ours = Pair::new(&first?, &second?);
            let by_light = frame(room, Given::Light, 0)?;
            let mean_by_light = mean(by_light.iter().map(|x| f64::from(*x))) / mean(theirs.mean.iter().copied());
            let agreement = compare(name, &ours, &theirs, mean_by_light);
            if agreement.ratio() > LIMIT {
                let Agreement { difference, noise, peer_noise, .. } = agreement;
                bail!("{name}: pictures differ by {difference:.4}, but their noise is {noise:.4} and {peer_noise:.4}");
            }
            agreements.push(agreement);
            replace(file, picture::beside(SIZE, [&ours.mean, &theirs.mean], &deviations(&ours, &theirs)))?;
        }
        Ok(agreements)
    }
}

fn task(name: &str) -> String {
    format!("{}-{name}", Question::NAME)
}

/// A picture by this renderer, beginning with the sample of this index.
fn frame(room: &Room, known: Given, from: u32) -> anyhow::Result<Vec<f32>> {
    let backend = Backend::best().fused();
    let world = room.world(known, backend)?;
    let settings = settings(SIZE, from..from + SAMPLES, backend, 1);
    let (film, _) = render(&world, &settings, Film::new(settings.window), |_| true)?;
    Ok(picture::linear(&film))
}

/// Two pictures with independent noise.
struct Pair {
    mean: Vec<f64>,
    /// The variance of the mean, estimated from one difference.
    variance: Vec<f64>,
}

impl Pair {
    fn new(first: &[f32], second: &[f32]) -> Self {
        let pairs = || first.iter().zip(second).map(|(a, b)| (f64::from(*a), f64::from(*b)));
        Pair {
            mean: pairs().map(|(a, b)| 0.5 * (a + b)).collect(),
            variance: pairs().map(|(a, b)| 0.25 * (a - b) * (a - b)).collect(),
        }
    }
}

fn compare(on: &'static str, ours: &Pair, theirs: &Pair, mean_by_light: f64) -> Agreement {
    let scale = |at: usize| 0.5 * (ours.mean[at] + theirs.mean[at]).max(2.0 * FLOOR);
    let root = |square: &dyn Fn(usize) -> f64| {
        mean((0..ours.mean.len()).map(|at| square(at) / (scale(at) * scale(at)))).sqrt()
    };
    Agreement {
        on,
        difference: root(&|at| (ours.mean[at] - theirs.mean[at]).powi(2)),
        noise: root(&|at| ours.variance[at]),
        peer_noise: root(&|at| theirs.variance[at]),
        mean: mean(ours.mean.iter().copied()) / mean(theirs.mean.iter().copied()),
        mean_by_light,
    }
}

fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len() as f64;
    values.sum::<f64>() / count
}

/// The difference of each pixel, in standard deviations; variances are averaged over squares of seven by seven pixels,
/// because a single pixel says little about its own variance.
fn deviations(ours: &Pair, theirs: &Pair) -> Vec<f64> {
    let [width, height] = SIZE.map(|side| side as i64);
    let sum = |values: &[f64], at: usize| values[3 * at..][..3].iter().sum::<f64>();
    let pixel = |x: i64, y: i64| (y.clamp(0, height - 1) * width + x.clamp(0, width - 1)) as usize;
    let variance = |x: i64, y: i64| {
        let square = (-3..=3).flat_map(|dy| (-3..=3).map(move |dx| (x + dx, y + dy)));
        let sums = square.map(|(x, y)| sum(&ours.variance, pixel(x, y)) + sum(&theirs.variance, pixel(x, y)));
        // The channels of a pixel vary together.
        3.0 * sums.sum::<f64>() / 49.0
    };
    let deviation = |(x, y): (i64, i64)| {
        let at = pixel(x, y);
        (sum(&ours.mean, at) - sum(&theirs.mean, at)) / variance(x, y).sqrt().max(1e-9)
    };
    (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(deviation).collect()
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg32;

    use super::*;

    #[test]
    fn noise_explains_noise_and_nothing_else() {
        // One per cent of noise in each of the two pictures of a pair.
        let noisy = |seed: u64, level: f32| -> Vec<f32> {
            let mut rng = Pcg32::seed_from_u64(seed);
            (0..30_000).map(|_| level * (1.0 + 0.06 * (rng.random::<f32>() - 0.5))).collect()
        };
        let pair = |seed, level| Pair::new(&noisy(seed, level), &noisy(seed + 7, level));
        let same = compare("same", &pair(1, 1.0), &pair(1000, 1.0), 1.0);
        assert!((same.ratio() - 1.0).abs() < 0.1, "{same:?}");
        let brighter = compare("brighter", &pair(1, 1.02), &pair(1000, 1.0), 1.0);
        assert!(brighter.ratio() > 1.2, "{brighter:?}");
    }
}
