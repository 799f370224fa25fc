//! What programs need from tables in specular coordinates.

use std::sync::Arc;

use super::prepared::Prepared;
use super::reference::zenith;
use super::{AXIS_NAMES, Data, Table};
use crate::bsdf::Bsdf;
use crate::data::{Grid, Kinks, Options, PrepareError, Section, pairs};
use crate::{Aspect, Channels, Edges, Kind, Representation};

/// The name of the representation.
pub const KIND: Kind = Kind::new("specular table");

impl Representation for Data {
    fn kind(&self) -> Kind {
        KIND
    }

    fn channels(&self) -> Channels {
        self.channels().clone()
    }

    fn aspects(&self) -> Vec<Aspect> {
        vec![Aspect::front(self.scatter())]
    }

    fn is_isotropic(&self) -> bool {
        Data::is_isotropic(self)
    }

    fn sections(&self) -> Vec<Section<'_>> {
        let section = Section::new(KIND, Aspect::front(self.scatter()), self.channels().clone(), self.values());
        let section = section.with_axes(AXIS_NAMES, self.knots());
        vec![match self.refraction() {
            Some(offsets) => {
                let refracted = self.knots()[0].iter().zip(offsets).map(|(sigma, offset)| sigma + offset);
                // Degrees as the file has them, which f32 can hold.
                let degrees: Vec<String> = refracted.map(|angle| (angle.to_degrees() as f32).to_string()).collect();
                section.with_fact("refracted", format!("at {} degrees for the knots of sigma", degrees.join(" ")))
            }
            None => section,
        }]
    }

    fn incidences(&self, _: Aspect) -> Vec<[f64; 2]> {
        pairs(&self.knots()[0], &self.knots()[1])
    }

    fn kinks(&self, edges: &Edges, [theta, _]: [f64; 2]) -> Option<Kinks> {
        let [.., thetas, phis] = self.knots().clone();
        Some(Kinks { zenith: zenith(self, edges, theta), thetas, phis })
    }

    fn grid(&self) -> Option<Grid<'_>> {
        Some(Grid {
            names: AXIS_NAMES,
            knots: self.knots(),
            values: self.values(),
            channels: self.channels().count(),
            is_mirrored: false,
            is_specular: true,
        })
    }

    fn prepare(&self, options: &Options) -> Result<Box<dyn Bsdf>, PrepareError> {
        Ok(Box::new(Prepared(Arc::new(Table::new(self, &options.edges)?))))
    }
}
