//! Pictures of a material: path-traced while they are shown, and a quick one while the lamp is dragged.

use std::sync::Arc;

use lobe::{Backend, Lookup, Material, Options, SamplerOptions};
use lobe_colour::ToneMap;
use lobe_render::integrator::Path;
use lobe_render::shader::{BsdfShader, Shader};
use lobe_render::stage::{Form, Lighting, Sky, lights, stage};
use lobe_render::{Camera, Film, Filter, Rect, Settings, World, render_until};
use serde::Deserialize;

use crate::request::word;
use crate::{Opened, Request};

/// What a page asks a picture to show.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct StudioRequest {
    /// `ball`, `cloth` or `flat`.
    pub form: String,
    /// `studio`, `overcast`, `dusk` or `dark`.
    pub sky: String,
    /// The direction toward the lamp: right, up, toward the viewer.
    pub toward: [f32; 3],
    /// The columns and rows of pixels.
    pub size: [u32; 2],
    /// Samples per pixel.
    pub samples: u32,
}

impl StudioRequest {
    /// Parses JSON.
    ///
    /// # Errors
    /// If `json` is not valid JSON, or has unknown keys.
    pub fn parse(json: &str) -> Result<Self, String> {
        serde_json::from_str(json).map_err(|error| format!("found an invalid request ({error}); expected JSON"))
    }

    fn form(&self) -> Result<Form, String> {
        Ok(word(&self.form, &[("ball", Form::Ball), ("cloth", Form::Cloth), ("flat", Form::Flat)])?.unwrap_or_default())
    }

    fn lighting(&self) -> Result<Lighting, String> {
        let skies = [("studio", Sky::Studio), ("overcast", Sky::Overcast), ("dusk", Sky::Dusk), ("dark", Sky::Dark)];
        Ok(Lighting { toward: self.toward, sky: word(&self.sky, &skies)?.unwrap_or_default() })
    }
}

/// The largest number of columns or rows, and of samples per pixel.
const LARGEST: u32 = 2048;
const MOST: u32 = 4096;

/// A picture that is rendered in steps.
#[derive(Debug)]
pub struct Studio {
    world: Option<World>,
    camera: Camera,
    form: Form,
    lighting: Lighting,
    settings: Settings,
    film: Option<Film>,
    is_done: bool,
}

/// The size in bytes of the distributions that directions are sampled from: enough for sharp lobes, and built within a
/// second.
const DISTRIBUTIONS: usize = 4 << 20;

impl Studio {
    /// Puts a material on the stage.
    ///
    /// # Errors
    /// If the material cannot be sampled, or the request is invalid.
    pub fn new(opened: &Opened, request: &StudioRequest) -> Result<Self, String> {
        let backend = Backend::detect().map_err(|error| error.to_string())?;
        // As in `lobe preview`: bins are interpolated, and paths begin at the camera.
        let options = Options { lookup: Lookup::Linear, indexed_by: lobe::Given::Viewer, ..Options::default() };
        let document = &opened.subject.measured().document;
        let material = Material::from_document(document, &options).map_err(|error| error.to_string())?;
        let sampling = SamplerOptions { bytes: Some(DISTRIBUTIONS), ..SamplerOptions::default() };
        let shader = BsdfShader::measured_with(material.with_backend(backend), &sampling, &mut |_, _| {})
            .map_err(|error| format!("{}: {error}", opened.subject.name()))?;
        let (form, lighting) = (request.form()?, request.lighting()?);
        let shader: Arc<dyn Shader> = Arc::new(shader);
        let (world, camera) = stage(shader, form, &lighting, backend).map_err(|error| error.to_string())?;
        let settings = settings(camera, request, backend)?;
        let film = Some(Film::new(settings.window));
        Ok(Studio { world: Some(world), camera, form, lighting, settings, film, is_done: false })
    }

    /// Restarts the picture with another lamp, sky or size. Returns `false` if the shape differs, which takes a new
    /// studio.
    ///
    /// # Errors
    /// If the request is invalid.
    pub fn change(&mut self, request: &StudioRequest) -> Result<bool, String> {
        if request.form()? != self.form {
            return Ok(false);
        }
        let lighting = request.lighting()?;
        let settings = settings(self.camera, request, self.settings.backend)?;
        if lighting != self.lighting {
            let lights = lights(&lighting).map_err(|error| error.to_string())?;
            self.world = self.world.take().map(|world| world.lit_by(lights));
            self.lighting = lighting;
        }
        self.film = Some(Film::new(settings.window));
        (self.settings, self.is_done) = (settings, false);
        Ok(true)
    }

    /// Adds samples as long as `goes_on` returns `true`. Returns the number of samples that every pixel has.
    ///
    /// # Errors
    /// If the picture cannot be rendered.
    pub fn step(&mut self, goes_on: impl FnMut() -> bool) -> Result<u32, String> {
        let (Some(world), Some(film)) = (&self.world, self.film.take()) else { return Ok(0) };
        let step = render_until(world, &self.settings, film, goes_on).map_err(|error| error.to_string())?;
        self.is_done = step.is_done;
        let samples = step.film.samples().0;
        self.film = Some(step.film);
        Ok(samples)
    }

    /// Returns `true` if every pixel has all of its samples.
    pub fn is_done(&self) -> bool {
        self.is_done
    }

    /// The picture so far, at an exposure in stops: four bytes per pixel, rows from the top. Pixels without samples are
    /// transparent.
    pub fn picture(&self, exposure: f32) -> Vec<u8> {
        let tone = ToneMap { exposure };
        let Some(film) = &self.film else { return Vec::new() };
        let pixel = |(colour, pixel): ([f32; 3], &lobe_render::Pixel)| {
            let [r, g, b] = colour.map(|c| tone.byte(c));
            [r, g, b, if pixel.samples > 0 { 255 } else { 0 }]
        };
        film.colours().zip(film.pixels()).flat_map(pixel).collect()
    }

    /// The columns and rows of pixels.
    pub fn size(&self) -> [u32; 2] {
        self.settings.size
    }
}

fn settings(camera: Camera, request: &StudioRequest, backend: Backend) -> Result<Settings, String> {
    let StudioRequest { size, samples, .. } = *request;
    if !size.iter().all(|n| (1..=LARGEST).contains(n)) || !(1..=MOST).contains(&samples) {
        let [width, height] = size;
        return Err(format!(
            "found {width} x {height} pixels, {samples} samples; expected 1 to {LARGEST} per side, 1 to {MOST} samples"
        ));
    }
    Ok(Settings {
        camera,
        size,
        window: Rect { x: 0, y: 0, width: size[0], height: size[1] },
        filter: Filter::Tent,
        integrator: Arc::new(Path { depth: 4, limit: 4.0 }),
        samples: 0..samples,
        backend,
        threads: 1,
        time: None,
    })
}

/// A ball that is redrawn for every position of the lamp.
#[derive(Clone, Debug)]
pub struct Ball {
    size: usize,
    ball: lobe_plot::Ball,
}

/// The radius of the ball over half the height of the picture, roughly that of the ball on the stage.
const SHARE: f32 = 0.6;

impl Ball {
    /// A ball in a square picture with `size` pixels along each side.
    pub fn new(size: usize) -> Self {
        let size = size.clamp(1, LARGEST as usize);
        Ball { size, ball: lobe_plot::Ball::new(size, SHARE) }
    }

    /// Pixels along each side.
    pub fn size(&self) -> usize {
        self.size
    }

    /// The picture of the ball: four bytes per pixel, rows from the top, transparent around the ball.
    ///
    /// # Errors
    /// If the request does not fit the material, or the lamp has no direction.
    pub fn picture(
        &self,
        opened: &Opened,
        request: &Request,
        toward: [f32; 3],
        exposure: f32,
    ) -> Result<Vec<u8>, String> {
        let view = request.of(opened)?.view;
        let length = toward.iter().map(|c| c * c).sum::<f32>().sqrt();
        if !(length.is_finite() && length > 0.0) {
            return Err(format!("found the lamp toward {toward:?}; expected a finite direction other than 0"));
        }
        Ok(self.ball.picture(&opened.subject, &view, toward.map(|c| c / length), exposure).rgba)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Session;

    #[test]
    fn a_picture_is_refined_and_follows_the_lamp() {
        let mut session = Session::new();
        session.add("paint.ddr", std::fs::read(lobe_testing::files::fixture("paint-12x21x13.ddr")).unwrap());
        let number = session.open("paint.ddr").unwrap();
        let opened = session.opened(number).unwrap();
        let request =
            StudioRequest { toward: [-0.6, 0.7, 0.6], size: [40, 40], samples: 3, ..StudioRequest::default() };
        let mut studio = Studio::new(opened, &request).unwrap();
        let mut calls = 0;
        while !studio.is_done() {
            studio.step(|| false).unwrap();
            calls += 1;
        }
        assert!(calls > 1, "{calls}");
        let left = studio.picture(0.0);
        assert_eq!(left.len(), 4 * 40 * 40);
        let brightness = |picture: &[u8], columns: std::ops::Range<usize>| {
            let of = |at: usize| u64::from(picture[4 * at]);
            (12..24).flat_map(|row| columns.clone().map(move |column| 40 * row + column)).map(of).sum::<u64>()
        };
        assert!(brightness(&left, 8..18) > brightness(&left, 22..32));
        let request = StudioRequest { toward: [0.6, 0.7, 0.6], ..request };
        assert!(studio.change(&request).unwrap() && !studio.is_done());
        studio.step(|| true).unwrap();
        let right = studio.picture(0.0);
        assert!(brightness(&right, 8..18) < brightness(&right, 22..32));
        assert!(!studio.change(&StudioRequest { form: "cloth".into(), ..request.clone() }).unwrap());
        assert!(studio.change(&StudioRequest { toward: [0.0; 3], ..request.clone() }).is_err());
        assert!(studio.change(&StudioRequest { size: [9999, 1], ..request }).is_err());

        let ball = Ball::new(32);
        let picture = ball.picture(opened, &Request::default(), [-0.6, 0.4, 0.6], 0.0).unwrap();
        let of = |row: usize, column: usize| picture[4 * (32 * row + column)];
        assert!(of(10, 10) > of(20, 22) && picture[3] == 0);
        assert!(ball.picture(opened, &Request::default(), [0.0; 3], 0.0).is_err());
    }
}
