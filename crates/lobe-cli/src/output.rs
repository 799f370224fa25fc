//! The options for writing a table: the file, and the resolution.

use std::path::{Path, PathBuf};

use clap::ValueEnum;
use lobe::Scatter;
use lobe_formats::Format;
use lobe_model::goniometer::rgl;
use lobe_model::goniometer::tensor_tree::Refinement;
use lobe_ops::remeasure::{Nodes, knots, spherical_knots};
use lobe_table::window::klems::AngleBasis;
use lobe_table::window::tensor_tree::Rank;

use crate::angles::check_knots;
use crate::failure::Failure;
use crate::target::{Target, parser, target};

/// Arguments of the commands that write tables.
#[derive(clap::Args)]
pub struct Output {
    /// The file to write; an existing one is replaced.
    pub out: PathBuf,
    /// The format to write, if the extension does not determine it.
    #[arg(long, value_name = "FORMAT", value_parser = parser())]
    pub to: Option<Format>,
    /// Write only this channel, by the name that `lobe info` shows.
    #[arg(long, value_name = "NAME")]
    pub channel: Option<String>,
    /// Knots of resampled tables: angle of incidence. By default 19 from 0 to 88, or 11 if psi matters.
    #[arg(long, value_name = "DEGREES", value_delimiter = ',', help_heading = "Resampling")]
    pub sigma: Vec<f64>,
    /// Rotation of the sample; a single 0 for isotropic materials. By default every 15 degrees, if it makes a
    /// difference.
    #[arg(long, value_name = "DEGREES", value_delimiter = ',', help_heading = "Resampling")]
    pub psi: Vec<f64>,
    /// Angle to the mirror direction, by default 30 from 0 to 180, dense near 0; of grids in spherical coordinates the
    /// polar angle of the viewer.
    #[arg(long, value_name = "DEGREES", value_delimiter = ',', help_heading = "Resampling")]
    pub theta: Vec<f64>,
    /// Azimuth about the mirror direction, by default every 15 degrees; of grids in spherical coordinates that of the
    /// viewer.
    #[arg(long, value_name = "DEGREES", value_delimiter = ',', help_heading = "Resampling")]
    pub phi: Vec<f64>,
    /// Number of polar angles of the light in RGL files. By default 48, or 20 if the material is anisotropic.
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u16).range(2..=512), help_heading = "Resampling")]
    pub zeniths: Option<u16>,
    /// Number of azimuths of the light in RGL files of anisotropic materials. By default 25.
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u16).range(3..=512), help_heading = "Resampling")]
    pub azimuths: Option<u16>,
    /// Rows and columns of the images of values in RGL files. By default 64, or 40 if the material is anisotropic.
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u16).range(2..=1024), help_heading = "Resampling")]
    pub texels: Option<u16>,
    /// Patches of WINDOW XML files, or trees. By default full.
    #[arg(long, value_enum, help_heading = "Resampling")]
    pub basis: Option<Basis>,
    /// How often trees may halve each dimension. By default 6 in tree3 and 5 in tree4.
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u8).range(1..=10), help_heading = "Resampling")]
    pub depth: Option<u8>,
    /// How far values in a leaf of a tree may be from their mean, relative to it or to the mean of all values if that
    /// is larger. By default 0.05.
    #[arg(long, value_name = "SHARE", value_parser = leaf_error, help_heading = "Resampling")]
    pub leaf_error: Option<f64>,
}

fn leaf_error(text: &str) -> Result<f64, String> {
    let share = text.parse().ok().filter(|share: &f64| *share > 0.0 && share.is_finite());
    share.ok_or_else(|| format!("found `{text}`; expected a number above 0"))
}

/// The output that a resampling option applies to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// The knots of tables in specular or spherical coordinates.
    Knots,
    /// The images of RGL files.
    Images,
    /// The azimuths of the light in RGL files of anisotropic materials.
    Azimuths,
    /// The patches of Klems matrices.
    Patches,
    /// The leaves of trees.
    Leaves,
}

impl Purpose {
    fn words(self) -> &'static str {
        match self {
            Purpose::Knots => "tables in specular or spherical coordinates",
            Purpose::Images => "RGL files",
            Purpose::Azimuths => "RGL files of anisotropic materials",
            Purpose::Patches => "WINDOW XML files",
            Purpose::Leaves => "trees in WINDOW XML files",
        }
    }
}

/// The standard bases of Klems matrices, and trees.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Basis {
    /// 145 patches.
    Full,
    /// 77 patches.
    Half,
    /// 41 patches.
    Quarter,
    /// A tensor tree of an isotropic material.
    Tree3,
    /// A tensor tree of any material.
    Tree4,
}

impl Basis {
    /// The patches; `None` of trees.
    pub fn patches(self) -> Option<AngleBasis> {
        match self {
            Basis::Full => Some(AngleBasis::full()),
            Basis::Half => Some(AngleBasis::half()),
            Basis::Quarter => Some(AngleBasis::quarter()),
            Basis::Tree3 | Basis::Tree4 => None,
        }
    }

    /// The dimensions; `None` of patches.
    pub fn rank(self) -> Option<Rank> {
        match self {
            Basis::Tree3 => Some(Rank::Three),
            Basis::Tree4 => Some(Rank::Four),
            Basis::Full | Basis::Half | Basis::Quarter => None,
        }
    }
}

impl Output {
    /// A file to write without further options.
    pub fn new(out: &Path, to: Option<Format>) -> Self {
        Output {
            out: out.into(),
            to,
            channel: None,
            sigma: Vec::new(),
            psi: Vec::new(),
            theta: Vec::new(),
            phi: Vec::new(),
            zeniths: None,
            azimuths: None,
            texels: None,
            basis: None,
            depth: None,
            leaf_error: None,
        }
    }

    /// The format to write. Refuses a file that has a sidecar, which would be applied to the new content.
    pub fn target(&self) -> Result<Target, Failure> {
        let sidecar = lobe_formats::sidecar::path_of(&self.out);
        if sidecar.exists() {
            return Err(Failure::File(format!(
                "{}: found the sidecar of an older {}; expected none: remove it, or write to another name",
                sidecar.display(),
                self.out.display()
            )));
        }
        target(&self.out, self.to)
    }

    /// Refuses knots that no table has.
    pub fn check_knots(&self) -> Result<(), Failure> {
        check_knots(&self.out, [&self.sigma, &self.psi, &self.theta, &self.phi])
    }

    /// The knots of a specular table in radians: the requested ones, or else defaults that suit most materials.
    pub fn knots(&self, is_isotropic: bool) -> [Vec<f64>; 4] {
        self.or_default(knots(is_isotropic))
    }

    /// The requested knots, and default ones for the other axes.
    fn or_default(&self, knots: [Vec<f64>; 4]) -> [Vec<f64>; 4] {
        let asked = [&self.sigma, &self.psi, &self.theta, &self.phi];
        let mut chosen = asked.into_iter().zip(knots).map(|(asked, default)| match asked.as_slice() {
            [] => default,
            degrees => degrees.iter().map(|angle| angle.to_radians()).collect(),
        });
        std::array::from_fn(|_| chosen.next().unwrap_or_default())
    }

    /// The sizes of an RGL material.
    pub fn rgl(&self, is_isotropic: bool) -> rgl::Resolution {
        let default = if is_isotropic { rgl::Resolution::ISOTROPIC } else { rgl::Resolution::ANISOTROPIC };
        let or = |asked: Option<u16>, default: usize| asked.map_or(default, usize::from);
        rgl::Resolution {
            theta_i: or(self.zeniths, default.theta_i),
            phi_i: if is_isotropic { 1 } else { or(self.azimuths, default.phi_i) },
            spectra: or(self.texels, default.spectra),
            ..default
        }
    }

    /// The patches of Klems matrices, or the leaves of trees.
    pub fn window(&self) -> Nodes {
        let basis = self.basis.unwrap_or(Basis::Full);
        match (basis.patches(), basis.rank()) {
            (None, Some(rank)) => Nodes::Tree(Refinement {
                rank,
                depth: self.depth.map_or(if rank == Rank::Three { 6 } else { 5 }, u32::from),
                error: self.leaf_error.unwrap_or(0.05),
            }),
            (patches, _) => Nodes::Klems(patches.unwrap_or_else(AngleBasis::full)),
        }
    }

    /// The knots of a grid in spherical coordinates in radians: the requested ones, or ones that suit most materials.
    pub fn spherical(&self, is_isotropic: bool) -> [Vec<f64>; 4] {
        self.or_default(spherical_knots(is_isotropic))
    }

    /// The resampling options that were given.
    fn given(&self) -> impl Iterator<Item = (&'static str, Purpose)> {
        let knots = [("--sigma", &self.sigma), ("--psi", &self.psi), ("--theta", &self.theta), ("--phi", &self.phi)];
        let knots = knots.map(|(name, knots)| (name, Purpose::Knots, !knots.is_empty()));
        let others = [
            ("--zeniths", Purpose::Images, self.zeniths.is_some()),
            ("--azimuths", Purpose::Azimuths, self.azimuths.is_some()),
            ("--texels", Purpose::Images, self.texels.is_some()),
            ("--basis", Purpose::Patches, self.basis.is_some()),
            ("--depth", Purpose::Leaves, self.depth.is_some()),
            ("--leaf-error", Purpose::Leaves, self.leaf_error.is_some()),
        ];
        knots.into_iter().chain(others).filter(|(.., is_given)| *is_given).map(|(name, purpose, _)| (name, purpose))
    }

    /// Refuses resampling options that would have no effect.
    pub fn refuse_others(&self, used: &[Purpose]) -> Result<(), Failure> {
        let Some((name, purpose)) = self.given().find(|(_, purpose)| !used.contains(purpose)) else { return Ok(()) };
        let (out, what) = (self.out.display(), purpose.words());
        let message = format!("{out}: found {name}, which is for {what}; expected only options that have an effect");
        Err(Failure::Usage(message))
    }

    /// Refuses resampling options if values and nodes are written unchanged.
    pub fn refuse_all(&self) -> Result<(), Failure> {
        let Some((name, _)) = self.given().next() else { return Ok(()) };
        let message = format!(
            "{}: found {name}, but this format keeps the values and nodes of the file; expected no such option (`lobe \
             resample` chooses other nodes)",
            self.out.display()
        );
        Err(Failure::Usage(message))
    }
}

/// The name of a side, for messages.
pub fn side(scatter: Scatter) -> &'static str {
    match scatter {
        Scatter::Reflection => "reflection",
        Scatter::Transmission => "transmission",
    }
}
