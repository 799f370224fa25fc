//! Materials of the EPFL database looked up by the direction of the viewer.

use std::path::Path;

use anyhow::{Context, bail};
use lobe::formats::{self, Document};
use lobe::table::rgl::{Drawn, RglOptions, RglTable, UniformOrder, Wanted};
use lobe::{Backend, Channels};
use lobe_render::shader::{Evaluated, Sampled, Scratch, Shader};

/// A material whose `wi` is the viewer's direction, as Mitsuba looks these files up. They are nearly reciprocal but not
/// quite, and a picture of the same file by another direction would be that of a slightly different material.
#[derive(Debug)]
pub struct ByViewer {
    table: RglTable,
    backend: Backend,
}

impl ByViewer {
    /// From an RGB file.
    ///
    /// # Errors
    /// Where the file is none.
    pub fn open(file: &Path, backend: Backend) -> anyhow::Result<Self> {
        let (_, document) = formats::open(file)?;
        let Document::Rgl(measured) = document else {
            bail!("{}: expected a material of the EPFL database", file.display());
        };
        if measured.data.parts().channels != Channels::Rgb {
            bail!("{}: expected RGB", file.display());
        }
        let table = RglTable::new(&measured.data, RglOptions::default()).with_context(|| file.display().to_string())?;
        Ok(ByViewer { table, backend })
    }
}

impl Shader<3> for ByViewer {
    fn albedo(&self) -> [f32; 3] {
        [0.5; 3]
    }

    fn eval(&self, wi: &[[f32; 3]], wo: &[[f32; 3]], out: Evaluated<'_, 3>, _: &mut Scratch) {
        let Evaluated { f, pdf } = out;
        self.backend.run(self.table.batch(wo, wi, Wanted::ValuesCos(f.as_flattened_mut())));
        self.backend.run(self.table.batch(wo, wi, Wanted::Pdf(pdf)));
    }

    fn sample(&self, wo: &[[f32; 3]], u: &[[f32; 2]], out: Sampled<'_, 3>, _: &mut Scratch) {
        let Sampled { wi, weight, pdf } = out;
        let drawn = Drawn { wo: wi, pdf, weights: weight.as_flattened_mut() };
        self.backend.run(self.table.sampling(wo, u, UniformOrder::default(), drawn));
    }
}
