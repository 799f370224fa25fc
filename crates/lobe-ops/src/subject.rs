//! An opened file, with the information about its representation that operations need.

use std::path::Path;

use lobe::{Material, OpenError, Options};
use lobe_formats::{Document, Format, Part};
use lobe_table::{Aspect, Data, Edges};

use crate::hemisphere::Panels;

/// The contents of a file, and the material made from them.
#[derive(Debug)]
pub struct Subject {
    /// The format of the file.
    pub format: Format,
    /// The data as measured.
    pub document: Document,
    /// The same, ready to be evaluated.
    pub material: Material,
    edges: Edges,
}

/// Polar angles of the light, in degrees, for representations that have no list of them.
const DEFAULT_THETAS: [f64; 9] = [0.0, 10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0, 80.0];

/// Light at a larger polar angle than this, in radians, 0.6 degrees above the horizon, is ignored.
const LOWEST: f64 = 1.56;

impl Subject {
    /// Opens a file of any format.
    ///
    /// # Errors
    /// The same as for [`Material::open_with`].
    pub fn open(path: &Path, options: &Options) -> Result<Self, OpenError> {
        let (format, document) = lobe_formats::open(path)?;
        let material = Material::from_document(&document, options).map_err(|error| error.in_file(path))?;
        Ok(Subject::new(format, document, material, options))
    }

    /// A document that was read, and the material made from it with these options.
    pub fn new(format: Format, document: Document, material: Material, options: &Options) -> Self {
        Subject { format, document, material, edges: options.edges }
    }

    /// The measured aspects, in the order of the file.
    pub fn aspects(&self) -> Vec<Aspect> {
        self.parts().flat_map(aspects).collect()
    }

    /// `true` if values do not depend on the rotation of the sample.
    pub fn is_isotropic(&self) -> bool {
        self.document.parts.iter().all(|part| part.data.representation().is_isotropic())
    }

    /// The directions of the light that were measured, polar angle and azimuth in radians, by ascending polar angle;
    /// nine polar angles from 0 to 80 degrees if the representation has no list of them. Grazing light is left out.
    pub fn incidences(&self, aspect: Aspect) -> Vec<[f64; 2]> {
        let Some(data) = self.data(aspect) else { return Vec::new() };
        let mut incidences = data.representation().incidences(aspect);
        if incidences.is_empty() {
            incidences = DEFAULT_THETAS.iter().map(|theta| [theta.to_radians(), 0.0]).collect();
        }
        incidences.retain(|[theta, _]| *theta < LOWEST);
        incidences
    }

    /// The panels of an integral over the hemisphere for light at a polar angle and an azimuth.
    pub fn panels(&self, aspect: Aspect, [theta, phi]: [f64; 2]) -> Panels {
        let data = self.data(aspect).map(Data::representation);
        match data.and_then(|data| data.kinks(&self.edges, [theta, phi])) {
            Some(kinks) => Panels::of_knots(kinks.zenith, phi, &kinks.thetas, &kinks.phis),
            None => Panels::graded(theta, phi),
        }
    }

    /// The largest polar angle of [`incidences`](Self::incidences).
    pub fn measured_up_to(&self, aspect: Aspect) -> f64 {
        let incidences = self.incidences(aspect);
        incidences.iter().map(|[theta, _]| *theta).fold(0.0, f64::max)
    }

    /// The data for an aspect. The only measurement of a file that does not distinguish sides applies to all aspects.
    pub fn data(&self, aspect: Aspect) -> Option<&Data> {
        let answers = |part: &&Part| {
            let is_there =
                |found: Aspect| found.scatter == aspect.scatter && (part.is_of_any_side() || found == aspect);
            aspects(part).into_iter().any(is_there)
        };
        self.document.only().or_else(|| self.parts().find(answers).map(|part| &part.data))
    }

    /// `true` if an aspect was measured only in the plane of incidence, so that an integral over the hemisphere is not
    /// a measurement.
    pub fn is_in_plane(&self, aspect: Aspect) -> bool {
        self.data(aspect).is_some_and(|data| crate::check::is_in_plane(data.representation()))
    }

    /// The measurements that have values for pairs of directions.
    fn parts(&self) -> impl Iterator<Item = &Part> {
        self.document.parts.iter().filter(|part| !part.data.representation().is_delta())
    }
}

/// The aspects that a part measures, on the side that the file states.
fn aspects(part: &Part) -> Vec<Aspect> {
    let aspects = part.data.representation().aspects().into_iter();
    aspects.map(|aspect| Aspect { light: part.side.unwrap_or(aspect.light), ..aspect }).collect()
}
