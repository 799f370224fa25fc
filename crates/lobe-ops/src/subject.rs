//! A file, opened, with what the operations have to know about its representation.

use std::f64::consts::{PI, TAU};
use std::path::Path;

use lobe::{Material, OpenError, Options};
use lobe_formats::sheet::{Data, Side};
use lobe_formats::{Document, Format};
use lobe_table::specular::reference::zenith;
use lobe_table::window::tensor_tree::Rank;
use lobe_table::window::{Block, Component};
use lobe_table::{Edges, Scatter, specular, spherical};

use crate::Aspect;
use crate::hemisphere::Panels;
use crate::samples::{ANGLE_ROUNDING, closes_circle};

/// What a file holds, and the material made of it.
#[derive(Debug)]
pub struct Subject {
    /// The format of the file.
    pub format: Format,
    /// The data as they were measured.
    pub document: Document,
    /// The same, ready to be evaluated.
    pub material: Material,
    edges: Edges,
}

/// Polar angles of the light where the representation has no list of them, in degrees.
const DEFAULT_THETAS: [f64; 9] = [0.0, 10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0, 80.0];

/// Light at a lower elevation than this, 0.6 degrees, is as good as none.
const LOWEST: f64 = 1.56;

impl Subject {
    /// Opens a file of any format.
    ///
    /// # Errors
    /// As [`Material::open_with`].
    pub fn open(path: &Path, options: &Options) -> Result<Self, OpenError> {
        let (format, document) = lobe_formats::open(path)?;
        let material = Material::new(path, format, document.clone(), options)?;
        Ok(Subject::new(format, document, material, options))
    }

    /// A document that was read, and the material that was made of it with these options.
    pub fn new(format: Format, document: Document, material: Material, options: &Options) -> Self {
        Subject { format, document, material, edges: options.edges }
    }

    /// What was measured, in the order of the file.
    pub fn aspects(&self) -> Vec<Aspect> {
        let front = |scatter| vec![Aspect { scatter, light: Side::Front }];
        match &self.document {
            Document::Table(measured) => front(measured.data.scatter()),
            Document::Spherical(measured) => front(measured.data.scatter()),
            Document::Scattered(measured) => front(measured.data.scatter()),
            Document::Sheet(measured) => {
                let parts = measured.data.iter().filter(|part| !matches!(part.data, Data::Specular(_)));
                let aspects =
                    parts.map(|part| Aspect { scatter: part.data.scatter(), light: part.side.unwrap_or(Side::Front) });
                aspects.collect()
            }
            Document::Window(measured) => {
                let is_there = |block| measured.data.bands.iter().any(|band| band.window.block(block).is_some());
                Block::ALL.into_iter().filter(|&block| is_there(block)).map(aspect_of).collect()
            }
            _ => front(Scatter::Reflection),
        }
    }

    /// Whether a rotation of the sample changes nothing.
    pub fn is_isotropic(&self) -> bool {
        match &self.document {
            Document::Table(measured) => measured.data.is_isotropic(),
            Document::Spherical(measured) => measured.data.is_isotropic(),
            Document::Scattered(measured) => measured.data.is_isotropic(),
            Document::Sheet(measured) => measured.data.iter().all(|part| match &part.data {
                Data::Table(data) => data.is_isotropic(),
                Data::Spherical(data) => data.is_isotropic(),
                Data::Scattered(data) => data.is_isotropic(),
                Data::Specular(data) => data.knots()[1].len() == 1,
            }),
            Document::Rgl(measured) => measured.data.is_isotropic(),
            Document::Utia(_) => false,
            Document::Window(measured) => measured.data.bands.iter().all(|band| {
                let components = Block::ALL.into_iter().filter_map(|block| band.window.block(block));
                components
                    .into_iter()
                    .all(|component| matches!(component, Component::Tree(tree) if tree.rank() == Rank::Three))
            }),
            _ => true,
        }
    }

    /// The directions of the light that were measured, polar angle and azimuth in radians, by ascending polar angle; where
    /// the representation has no list of them, nine polar angles from 0 to 80 degrees. Grazing light is left out.
    pub fn incidences(&self, aspect: Aspect) -> Vec<[f64; 2]> {
        let grid = |thetas: &[f64], phis: &[f64]| {
            // The last azimuth of a full turn repeats the first.
            let open = phis.len() - usize::from(closes_circle(phis));
            thetas.iter().flat_map(|&theta| phis[..open].iter().map(move |&phi| [theta, phi])).collect()
        };
        let of_data = |data: &Data| match data {
            Data::Table(data) => grid(&data.knots()[0], &data.knots()[1]),
            Data::Spherical(data) => grid(&data.knots()[0], &data.knots()[1]),
            Data::Scattered(data) => data.incidences().collect(),
            Data::Specular(_) => Vec::new(),
        };
        let wide = |knots: &[f32]| knots.iter().map(|&knot| f64::from(knot)).collect::<Vec<_>>();
        let incidences: Vec<[f64; 2]> = match &self.document {
            Document::Table(measured) => grid(&measured.data.knots()[0], &measured.data.knots()[1]),
            Document::Spherical(measured) => grid(&measured.data.knots()[0], &measured.data.knots()[1]),
            Document::Scattered(measured) => measured.data.incidences().collect(),
            Document::Sheet(_) => self.part(aspect).map(of_data).unwrap_or_default(),
            Document::Rgl(measured) => {
                let parts = measured.data.parts();
                let phis = if measured.data.is_isotropic() { vec![0.0] } else { wide(&parts.phi_i) };
                grid(&wide(&parts.theta_i), &phis)
            }
            Document::Utia(_) => {
                let thetas: Vec<f64> = (0..6).map(|i| f64::from(i) * PI / 12.0).collect();
                grid(&thetas, &(0..8).map(|i| f64::from(i) * TAU / 8.0).collect::<Vec<_>>())
            }
            _ => DEFAULT_THETAS.iter().map(|theta| [theta.to_radians(), 0.0]).collect(),
        };
        incidences.into_iter().filter(|[theta, _]| *theta < LOWEST).collect()
    }

    /// Where to begin an integral over the hemisphere for light at a polar angle and an azimuth.
    pub fn panels(&self, aspect: Aspect, [theta, phi]: [f64; 2]) -> Panels {
        match (&self.document, self.part(aspect)) {
            (Document::Table(measured), _) => of_table(&measured.data, &self.edges, [theta, phi]),
            (Document::Spherical(measured), _) => of_grid(&measured.data, [theta, phi]),
            (_, Some(Data::Table(data))) => of_table(data, &self.edges, [theta, phi]),
            (_, Some(Data::Spherical(data))) => of_grid(data, [theta, phi]),
            _ => Panels::graded(theta, phi),
        }
    }

    /// The largest polar angle of [`incidences`](Self::incidences).
    pub fn measured_up_to(&self, aspect: Aspect) -> f64 {
        let incidences = self.incidences(aspect);
        incidences.iter().map(|[theta, _]| *theta).fold(0.0, f64::max)
    }

    /// The part of a sheet that this is.
    pub fn part(&self, aspect: Aspect) -> Option<&Data> {
        let Document::Sheet(measured) = &self.document else { return None };
        let fits = |side: Option<Side>| side.is_none_or(|side| side == aspect.light);
        let mut parts = measured.data.iter().filter(|part| !matches!(part.data, Data::Specular(_)));
        parts.find(|part| part.data.scatter() == aspect.scatter && fits(part.side)).map(|part| &part.data)
    }
}

/// The measurement that a block of a window is.
pub(crate) fn aspect_of(block: Block) -> Aspect {
    // WINDOW's front is the side of z < 0.
    let (scatter, light) = match block {
        Block::TransmissionFront => (Scatter::Transmission, Side::Back),
        Block::TransmissionBack => (Scatter::Transmission, Side::Front),
        Block::ReflectionFront => (Scatter::Reflection, Side::Back),
        Block::ReflectionBack => (Scatter::Reflection, Side::Front),
    };
    Aspect { scatter, light }
}

fn of_table(samples: &specular::Data, edges: &Edges, [theta, phi]: [f64; 2]) -> Panels {
    Panels::of_knots(zenith(samples, edges, theta), phi, &samples.knots()[2], &samples.knots()[3])
}

/// About the normal, azimuths count from the light here; in the grid they do so where it is isotropic, else from +x.
fn of_grid(grid: &spherical::Data, [_, phi]: [f64; 2]) -> Panels {
    let turn = match () {
        () if grid.is_mirrored() => 0.0,
        () if grid.is_isotropic() => grid.knots()[1][0],
        () => phi,
    };
    let signs: &[f64] = if grid.is_mirrored() { &[1.0, -1.0] } else { &[1.0] };
    let mut phis: Vec<f64> = signs
        .iter()
        .flat_map(|sign| grid.knots()[3].iter().map(move |knot| (sign * (knot - turn)).rem_euclid(TAU)))
        .collect();
    phis.sort_by(f64::total_cmp);
    phis.dedup_by(|a, b| *a - *b < ANGLE_ROUNDING);
    Panels::of_knots(0.0, phi, &grid.knots()[2], &phis)
}
