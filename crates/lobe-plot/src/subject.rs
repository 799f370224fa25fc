//! A file to draw.

use std::cell::Cell;
use std::f64::consts::FRAC_PI_4;
use std::path::Path;

use lobe::formats::{Document, Format};
use lobe::{Aspect, Material, OpenError, Options, Scatter, Side};
use lobe_colour::Reduction;
use lobe_ops::check::{Finding, Thoroughness, check};

use crate::evaluate::{Progress, Silent, evaluate};
use crate::geometry::{in_plane, incident};
use crate::measured::{Part, parts};

/// A measured material, with the directions at which it was measured.
#[derive(Debug)]
pub struct Subject {
    name: String,
    measured: lobe_ops::Subject,
}

impl Subject {
    /// Opens a file of any format that `lobe` reads.
    ///
    /// # Errors
    /// The same as for [`Material::open`].
    pub fn open(path: &Path) -> Result<Self, OpenError> {
        let (format, document) = lobe::formats::open(path)?;
        Subject::new(path, format, document)
    }

    /// A document that was read from `path`, whose last component is the name in figures.
    ///
    /// # Errors
    /// The same as for [`Material::from_document`].
    pub fn new(path: &Path, format: Format, document: Document) -> Result<Self, OpenError> {
        let name = path.file_name().map_or_else(|| path.display().to_string(), |name| name.to_string_lossy().into());
        let options = Options::default();
        let material = Material::from_document(&document, &options).map_err(|error| error.in_file(path))?;
        Ok(Subject { name, measured: lobe_ops::Subject::new(format, document, material, &options) })
    }

    /// The same with another name than that of the file.
    pub fn named(self, name: &str) -> Self {
        Subject { name: name.into(), ..self }
    }

    /// The name of the file.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The material.
    pub fn material(&self) -> &Material {
        &self.measured.material
    }

    /// The file as a subject of `lobe-ops`.
    pub fn measured(&self) -> &lobe_ops::Subject {
        &self.measured
    }

    /// The findings of the checks in `lobe-ops`.
    pub fn findings(&self, progress: &dyn Progress) -> Vec<Finding> {
        const STEPS: f64 = 1000.0;
        progress.begin("checks", STEPS as u64);
        let done = Cell::new(0);
        let advance = |share: f64| {
            let now = (STEPS * share.clamp(0.0, 1.0)) as u64;
            progress.advance(now.saturating_sub(done.get()));
            done.set(done.get().max(now));
        };
        check(&self.measured, &Thoroughness::default(), advance)
    }

    /// `true` if the material is evaluated pair by pair, in microseconds each, so that pictures of it have fewer
    /// pixels.
    pub(crate) fn is_slow(&self) -> bool {
        self.measured.document.parts.iter().any(|part| part.data.representation().samples().is_some())
    }

    /// The scatters of light from `side`: reflection, transmission, both or none.
    pub fn scatters(&self, side: Side) -> Vec<Scatter> {
        let both = [Scatter::Reflection, Scatter::Transmission];
        both.into_iter().filter(|&scatter| self.part(side, scatter).is_some()).collect()
    }

    /// The sides from which light was measured.
    pub fn sides(&self) -> Vec<Side> {
        [Side::Front, Side::Back].into_iter().filter(|&side| !self.scatters(side).is_empty()).collect()
    }

    /// `true` if the value of a pair of directions in the given hemispheres is one of the measurement, rather than of
    /// its continuation; `sigma` and `psi` of the light are in radians. A test of outgoing directions of either sign of
    /// z.
    pub fn coverage(&self, side: Side, scatter: Scatter, sigma: f64, psi: f64) -> impl Fn([f64; 3]) -> bool {
        let is_covered = self.part(side, scatter).map(|part| part.coverage(sigma, psi));
        move |[x, y, z]| is_covered.as_ref().is_some_and(|is_covered| is_covered([x, y, z.abs()]))
    }

    pub(crate) fn part(&self, side: Side, scatter: Scatter) -> Option<Part<'_>> {
        let aspect = Aspect { scatter, light: side };
        parts(&self.measured.document).into_iter().find(|part| part.aspect == aspect)
    }

    /// The polar angles of the light to draw, in radians: at most `most` of the knots of the measurement, or every 15
    /// degrees if it has none.
    pub fn incidences(&self, side: Side, most: usize) -> Vec<f64> {
        let part = self.scatters(side).first().and_then(|&scatter| self.part(side, scatter));
        let mut knots: Vec<f64> = part.map(|part| part.incidences()).unwrap_or_default();
        // Values at grazing incidence are meaningless.
        knots.retain(|knot| *knot < 88.5_f64.to_radians());
        if knots.is_empty() {
            knots = [0.0, 15.0, 30.0, 45.0, 60.0, 75.0].map(f64::to_radians).into();
        }
        if knots.len() <= most {
            return knots;
        }
        // As evenly spaced in angle as the knots allow.
        let (first, last) = (knots[0], knots[knots.len() - 1]);
        let mut chosen: Vec<f64> = (0..most)
            .map(|i| first + (last - first) * i as f64 / (most - 1).max(1) as f64)
            .filter_map(|at| knots.iter().copied().min_by(|a, b| (a - at).abs().total_cmp(&(b - at).abs())))
            .collect();
        chosen.dedup();
        chosen
    }

    /// The azimuth of the light in the default view, in radians.
    pub fn psi(&self, side: Side) -> f64 {
        self.scatters(side).first().and_then(|&scatter| self.part(side, scatter)).map_or(0.0, |part| part.psi())
    }

    /// `true` if rotating the sample by an eighth or a quarter of a turn changes the colours by a twentieth or more,
    /// over a few hundred pairs of directions.
    pub fn is_anisotropic(&self, side: Side) -> bool {
        let scatters = self.scatters(side);
        let Some(&scatter) = scatters.first() else { return false };
        let psi = self.psi(side);
        const TURNS: usize = 3;
        let pair = |at: usize| {
            let (turn, sigma, theta) = (at % TURNS, at / TURNS % 8, at / (8 * TURNS));
            let (sigma, theta) = ((5.0 + 9.0 * sigma as f64).to_radians(), (-76.0 + 8.0 * theta as f64).to_radians());
            let psi = psi + FRAC_PI_4 * turn as f64;
            (incident(side, sigma, psi), in_plane(side, scatter, theta, psi))
        };
        let colour = Reduction::for_display(self.material().channels());
        let values = evaluate(self.material(), TURNS * 8 * 20, pair, |texel| colour.apply(texel), &Silent);
        let (mut difference, mut sum) = (0.0, 0.0);
        for turns in values.chunks_exact(TURNS) {
            for channel in 0..3 {
                let of = turns.iter().map(|rgb| rgb[channel]);
                let (low, high) = of.fold((f32::INFINITY, f32::NEG_INFINITY), |(l, h), c| (l.min(c), h.max(c)));
                difference += high - low;
                sum += high.abs();
            }
        }
        difference > 0.05 * sum
    }
}
