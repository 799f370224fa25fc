//! `xtask gallery`: renders the scenes in fixtures/scenes, and writes a page with the pictures.
#![forbid(unsafe_code)]

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::{Context, Result};
use clap::Parser;
use lobe::Backend;
use lobe_render::picture::{Shown, ToneMap, write_png_in};
use lobe_render::scene::{AnyScene, Scene};
use lobe_render::{Film, Rect, Settings, Transport, render};

use xtask_common::Steps;
use xtask_common::replace;

/// Render the scenes in fixtures/scenes into docs/pictures, and write docs/gallery.md.
#[derive(Parser)]
#[command(bin_name = "cargo xtask gallery")]
struct Args {
    /// Render only these scenes, given by file name; docs/gallery.md is then left unchanged
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    only: Vec<String>,
    /// Samples per pixel instead of those in the scenes, for a quick look; docs/gallery.md is then left unchanged
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..65_537))]
    samples: Option<u32>,
    /// Folder for the pictures [default: docs/pictures]
    #[arg(long, value_name = "DIR", hide_default_value = true)]
    #[arg(default_value = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/pictures"))]
    pictures: PathBuf,
}

/// A picture of the gallery.
struct Picture {
    /// File name of the scene in fixtures/scenes and of the picture, without the extensions.
    name: &'static str,
    title: &'static str,
    /// A description of the picture.
    caption: &'static str,
    /// Whether there is a second picture, of the degree of polarisation.
    is_polarised: bool,
}

const PICTURES: [Picture; 8] = [
    Picture {
        name: "cloth-metal-paint",
        title: "Cloth, metal and paint",
        caption: "This project's version of Fig. 3 of the paper. The cloth draped over a sphere is shot silk: \
                  its table of 17 x 7 x 17 x 13 angles was measured on a simulated weave of blue warp and \
                  orange weft, so each fold shows one colour or the other. The knot is brushed along its \
                  length, so its highlights run around it. The ball is car paint, a table whose clear coat \
                  mirrors the lamps. Every object casts shadows and appears in reflections.",
        is_polarised: false,
    },
    Picture {
        name: "material-balls",
        title: "Material balls",
        caption: "In front, the tables of `fixtures`: silk, dusty gold and car paint. Behind them, analytic \
                  models evaluated directly: green and white plastic, brushed aluminium and copper.",
        is_polarised: false,
    },
    Picture {
        name: "knot-at-dusk",
        title: "Knot at dusk",
        caption: "The gold table under a sky that is bright at the horizon, next to a glass ball and a silk \
                  ball on a wet floor.",
        is_polarised: false,
    },
    Picture {
        name: "caustics",
        title: "Caustics on cloth",
        caption: "A glass ball and a gold ring on the woven cloth, a measured table, rendered by `vcm`: paths from the \
                  lamp find the light that the ball focuses and the ring mirrors, and it is weighted against what paths \
                  from the camera find.",
        is_polarised: false,
    },
    Picture {
        name: "pool",
        title: "Pool",
        caption: "The sun shines through waves onto tiles and a ball with the gold table, seen through the same waves \
                  and rendered by `sppm`: paths from the camera alone never find this light.",
        is_polarised: false,
    },
    Picture {
        name: "dispersion",
        title: "Dispersion",
        caption: "A prism of dense flint glass (SF11), at 16 wavelengths. It shows a white tube that stands to the right of \
                  the picture: each wavelength is refracted by its own angle, by the formula of the catalogue.",
        is_polarised: false,
    },
    Picture {
        name: "two-lamps",
        title: "Two lamps",
        caption: "The same things under daylight on the left and under a fluorescent lamp of three narrow bands (CIE F11) \
                  on the right, at 31 wavelengths. The balls of each pair have different spectra with one colour in \
                  daylight: metamers. The bubble is a film of water 420 nm thick, and the ball in the middle is metal \
                  with a film, as in paints that change colour with the angle.",
        is_polarised: false,
    },
    Picture {
        name: "polarised",
        title: "Polarised light",
        caption: "Glass, gold, chromium and a white diffuse standard on water, under a clear sky whose light is polarised \
                  across the sun. The standard is a table of Mueller matrices, computed by `cargo xtask fixtures`. The \
                  second picture shows the degree of linear polarisation, from black to white. The sheet in front is a \
                  polariser that takes the glare off the water.",
        is_polarised: true,
    },
];

const SCENES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/scenes");
const PAGE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/gallery.md");

/// Renders, and writes the pictures and the page.
///
/// # Errors
/// If a scene is wrong or a file cannot be written.
fn main() -> anyhow::Result<()> {
    let args = Args::parse();
    std::fs::create_dir_all(&args.pictures).with_context(|| format!("making {}", args.pictures.display()))?;
    if let Some(unknown) = args.only.iter().find(|name| PICTURES.iter().all(|picture| picture.name != *name)) {
        let names: Vec<_> = PICTURES.iter().map(|picture| picture.name).collect();
        anyhow::bail!("no scene `{unknown}`; the scenes are {}", names.join(", "));
    }
    for picture in &PICTURES {
        if args.only.is_empty() || args.only.iter().any(|name| name == picture.name) {
            picture.render(&args.pictures, args.samples)?;
        }
    }
    if args.only.is_empty() && args.samples.is_none() {
        replace(Path::new(PAGE), page()?)?;
        println!("{PAGE}");
    }
    Ok(())
}

impl Picture {
    /// Renders in strict form, so that the pictures have the same bytes on every machine.
    fn scene(&self) -> Result<AnyScene> {
        let path = Path::new(SCENES).join(self.name).with_extension("toml");
        Ok(AnyScene::open_with_progress(&path, Backend::detect()?.strict(), None, &mut |_| {})?)
    }

    fn render(&self, folder: &Path, samples: Option<u32>) -> Result<()> {
        match self.scene()? {
            AnyScene::Rgb(scene) => self.render_in(scene, folder, samples),
            AnyScene::Bands8(scene) => self.render_in(scene, folder, samples),
            AnyScene::Bands16(scene) => self.render_in(scene, folder, samples),
            AnyScene::Bands32(scene) => self.render_in(scene, folder, samples),
            AnyScene::StokesRgb(scene) => self.render_in(scene, folder, samples),
            AnyScene::Stokes16(scene) => self.render_in(scene, folder, samples),
            AnyScene::EnergyRgb(scene) => self.render_in(scene, folder, samples),
            AnyScene::Energy16(scene) => self.render_in(scene, folder, samples),
        }
    }

    fn render_in<T: Transport>(&self, scene: Scene<T>, folder: &Path, samples: Option<u32>) -> Result<()> {
        let window = Rect { x: 0, y: 0, width: scene.size[0], height: scene.size[1] };
        let settings = Settings {
            camera: scene.camera,
            size: scene.size,
            window,
            filter: scene.filter,
            integrator: scene.integrator,
            samples: 0..samples.unwrap_or(scene.samples),
            backend: Backend::detect()?.strict(),
            threads: std::thread::available_parallelism().map_or(1, usize::from),
            time: None,
        };
        let steps = Steps::new(1);
        steps.begin(self.name);
        let begun = Instant::now();
        let (film, _) = render(&scene.world, &settings, Film::<T>::new(window), |progress| {
            steps.are(progress.done, progress.total);
            true
        })?;
        drop(steps);
        let (basis, tone) = (scene.world.basis(), ToneMap { exposure: scene.exposure });
        let path = folder.join(self.name).with_extension("png");
        write_png_in(&path, &film, basis, tone, Shown::Colour)?;
        if self.is_polarised {
            write_png_in(&folder.join(self.degree()), &film, basis, tone, Shown::Degree)?;
        }
        println!("{} in {:.0} s", path.display(), begun.elapsed().as_secs_f64());
        Ok(())
    }

    /// The name of the picture of the degree of polarisation.
    fn degree(&self) -> String {
        format!("{}-dolp.png", self.name)
    }
}

/// Columns and rows, samples and triangles.
fn facts(scene: &AnyScene) -> ([u32; 2], u32, usize) {
    fn of<T: Transport>(scene: &Scene<T>) -> ([u32; 2], u32, usize) {
        (scene.size, scene.samples, scene.world.triangles())
    }
    match scene {
        AnyScene::Rgb(scene) => of(scene),
        AnyScene::Bands8(scene) => of(scene),
        AnyScene::Bands16(scene) => of(scene),
        AnyScene::Bands32(scene) => of(scene),
        AnyScene::StokesRgb(scene) => of(scene),
        AnyScene::Stokes16(scene) => of(scene),
        AnyScene::EnergyRgb(scene) => of(scene),
        AnyScene::Energy16(scene) => of(scene),
    }
}

/// The text of docs/gallery.md.
fn page() -> Result<String> {
    let mut text = String::from(
        "# Gallery\n\n\
         The scenes are in [fixtures/scenes](../fixtures/scenes), and everything in them was made by this project: the \
         falling\ncloth and the weave were simulated, and the tables were computed. `cargo xtask gallery` renders the \
         pictures and\nwrites this page.\n",
    );
    for picture in &PICTURES {
        let Picture { name, title, caption, is_polarised } = picture;
        let ([width, height], samples, triangles) = facts(&picture.scene()?);
        let degree = match is_polarised {
            true => format!("![Degree of polarisation](pictures/{})\n\n", picture.degree()),
            false => String::new(),
        };
        _ = write!(
            text,
            "\n## {title}\n\n![{title}](pictures/{name}.png)\n\n{degree}{caption}\n\n\
             {width} x {height} pixels, {samples} samples each, {triangles} triangles.\n\n\
             ```sh\nlobe render fixtures/scenes/{name}.toml -o {name}.png --strict\n```\n"
        );
    }
    Ok(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_scene_is_in_the_gallery_and_the_page_is_up_to_date() {
        let mut scenes = Vec::new();
        for entry in std::fs::read_dir(SCENES).expect("fixtures/scenes") {
            let path = entry.expect("an entry").path();
            if path.extension().is_some_and(|extension| extension == "toml") {
                scenes.push(path.file_stem().expect("a name").to_string_lossy().into_owned());
            }
        }
        scenes.sort();
        let mut names: Vec<_> = PICTURES.iter().map(|picture| picture.name.to_owned()).collect();
        names.sort();
        assert_eq!(scenes, names);
        assert_eq!(std::fs::read_to_string(PAGE).expect("docs/gallery.md"), page().expect("scenes"));
        for name in names {
            let path = Path::new(SCENES).join("../../docs/pictures").join(name).with_extension("png");
            let bytes = std::fs::metadata(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display())).len();
            assert!(bytes < 400_000, "{}: {bytes} bytes", path.display());
        }
    }
}
