//! The interface for JavaScript: numbers, typed arrays, text and JSON in and out, and errors as text.

use serde::Serialize;
use wasm_bindgen::prelude::*;

use crate::{
    Ball, Evaluator, Map, Opened, Quantities, Request, Session, Shades, Studio, StudioRequest, albedo_rows, backends,
    compare, converted, curve, difference_map, evaluate, evaluate_into, facts, figure, findings, half_difference,
    half_probe, map, probe, spectra, surface, table, targets,
};

#[wasm_bindgen]
extern "C" {
    #[wasm_bindgen(js_namespace = console)]
    fn error(text: &str);
    #[wasm_bindgen(js_namespace = performance)]
    fn now() -> f64;
}

/// The number of pictures that are rendered side by side.
const STAGES: usize = 2;

/// The files of a page, the materials opened from them, and their pictures.
#[wasm_bindgen]
#[derive(Debug, Default)]
pub struct Explorer {
    session: Session,
    ball: Option<Ball>,
    studios: [Option<Studio>; STAGES],
}

type Answer<T> = Result<T, JsError>;

fn said(error: String) -> JsError {
    JsError::new(&error)
}

fn json<T: Serialize>(value: &T) -> Answer<String> {
    serde_json::to_string(value).map_err(|error| said(error.to_string()))
}

fn triple(values: &[f32]) -> Answer<[f32; 3]> {
    values.try_into().map_err(|_| said(format!("found {} components; expected 3", values.len())))
}

impl Explorer {
    fn opened(&self, material: u32) -> Answer<&Opened> {
        self.session.opened(material).map_err(said)
    }

    fn studio(&mut self, stage: usize) -> Answer<&mut Option<Studio>> {
        self.studios.get_mut(stage).ok_or_else(|| said(format!("found the stage {stage}; expected one below {STAGES}")))
    }
}

/// Methods take the number of a material, and a request as JSON (`side`, `scatter`, `psi`, `channel`, `scale`).
#[wasm_bindgen]
impl Explorer {
    /// Creates an explorer without files.
    #[wasm_bindgen(constructor)]
    pub fn new() -> Self {
        std::panic::set_hook(Box::new(|panic| error(&panic.to_string())));
        Explorer::default()
    }

    /// The version of the libraries.
    pub fn version() -> String {
        env!("CARGO_PKG_VERSION").into()
    }

    /// The names of the backends, separated by commas, slowest first.
    pub fn backends() -> String {
        backends().join(",")
    }

    /// Adds a file, or replaces the one at the same path.
    pub fn add(&mut self, path: &str, bytes: Vec<u8>) {
        self.session.add(path, bytes);
    }

    /// Removes a file.
    pub fn remove(&mut self, path: &str) {
        self.session.remove(path);
    }

    /// Opens a file or a folder among the added files. Returns the number of the material.
    pub fn open(&mut self, path: &str) -> Answer<u32> {
        self.session.open(path).map_err(said)
    }

    /// What a file holds that is no material, as JSON.
    pub fn held(&mut self, path: &str) -> Answer<String> {
        json(&self.session.held(path).map_err(said)?)
    }

    /// Closes a material.
    pub fn close(&mut self, material: u32) {
        self.session.close(material);
    }

    /// The facts of a material, as JSON.
    pub fn facts(&self, material: u32) -> Answer<String> {
        json(&facts(self.opened(material)?))
    }

    /// The findings of the checks, as JSON.
    pub fn findings(&self, material: u32, quickly: bool) -> Answer<String> {
        json(&findings(self.opened(material)?, quickly))
    }

    /// The values of pairs of directions, with three components each, on the backend of this name, or the best one if
    /// it is empty.
    pub fn eval(&self, material: u32, wi: &[f32], wo: &[f32], backend: &str, strict: bool) -> Answer<Vec<f32>> {
        let on = Evaluator::new(backend, strict).map_err(said)?;
        evaluate(self.opened(material)?, wi, wo, on).map_err(said)
    }

    /// The shortest time, in milliseconds, in which these values are evaluated `times` times in a row, in as many turns. It
    /// is that of the kernels: values stay in the memory of the module.
    #[allow(clippy::too_many_arguments, reason = "JavaScript passes numbers and text, not structs")]
    pub fn time(
        &self,
        material: u32,
        wi: &[f32],
        wo: &[f32],
        backend: &str,
        strict: bool,
        times: u32,
        turns: u32,
    ) -> Answer<f64> {
        let on = Evaluator::new(backend, strict).map_err(said)?;
        let opened = self.opened(material)?;
        let mut values = Vec::new();
        let mut least = f64::INFINITY;
        for _ in 0..turns {
            let begun = now();
            for _ in 0..times {
                evaluate_into(opened, wi, wo, on, &mut values).map_err(said)?;
            }
            least = least.min(now() - begun);
        }
        Ok(least)
    }

    /// The curve in the plane of incidence: the angle, the value and a flag for each point, see [`curve`].
    pub fn curve(&self, material: u32, request: &str, sigma: f64) -> Answer<Vec<f64>> {
        curve(self.opened(material)?, &Request::parse(request).map_err(said)?, sigma).map_err(said)
    }

    /// Spectra at several viewing angles, as JSON.
    pub fn spectra(&self, material: u32, request: &str, sigma: f64, thetas: &[f64]) -> Answer<String> {
        let request = Request::parse(request).map_err(said)?;
        json(&spectra(self.opened(material)?, &request, sigma, thetas).map_err(said)?)
    }

    /// Albedos: polar angle, value, red, green and blue for each incidence.
    pub fn albedos(&self, material: u32, request: &str, sigmas: &[f64]) -> Answer<Vec<f64>> {
        albedo_rows(self.opened(material)?, &Request::parse(request).map_err(said)?, sigmas).map_err(said)
    }

    /// The curve of all channels as CSV.
    pub fn table(&self, material: u32, request: &str, sigma: f64) -> Answer<String> {
        table(self.opened(material)?, &Request::parse(request).map_err(said)?, sigma).map_err(said)
    }

    /// A figure of one or more materials as SVG, with a JSON array of one request per material.
    pub fn figure(&self, materials: &[u32], requests: &str, kind: &str, sigmas: &[f64]) -> Answer<String> {
        let requests: Vec<Request> = serde_json::from_str(requests).map_err(|error| said(error.to_string()))?;
        let opened: Vec<&Opened> = materials.iter().map(|&number| self.opened(number)).collect::<Answer<_>>()?;
        figure(&opened, &requests, kind, sigmas).map_err(said)
    }

    /// A map of the hemisphere that shows `values`, `colours` or `dolp`. `range` has the two ends of the false colours of
    /// values, or is empty.
    #[allow(clippy::too_many_arguments, reason = "JavaScript passes numbers and text, not structs")]
    pub fn map(
        &self,
        material: u32,
        request: &str,
        sigma: f64,
        size: usize,
        what: &str,
        exposure: f32,
        range: &[f64],
    ) -> Answer<Picture> {
        let (request, what) = (Request::parse(request).map_err(said)?, Quantities::parse(what).map_err(said)?);
        let shades = Shades { exposure, range: range.try_into().ok() };
        map(self.opened(material)?, &request, sigma, size, what, shades).map(Picture).map_err(said)
    }

    /// The direction and the values at a point of a map, as JSON; `null` outside the disk.
    pub fn probe(&self, material: u32, request: &str, sigma: f64, x: f64, y: f64) -> Answer<String> {
        let request = Request::parse(request).map_err(said)?;
        json(&probe(self.opened(material)?, &request, sigma, [x, y]).map_err(said)?)
    }

    /// A map of the half and difference angles of reflection.
    pub fn half(&self, material: u32, request: &str, size: usize) -> Answer<Picture> {
        let request = Request::parse(request).map_err(said)?;
        half_difference(self.opened(material)?, &request, size).map(Picture).map_err(said)
    }

    /// The angles and the value at a point of that map, as JSON; `null` outside.
    pub fn half_probe(&self, material: u32, request: &str, x: f64, y: f64) -> Answer<String> {
        let request = Request::parse(request).map_err(said)?;
        json(&half_probe(self.opened(material)?, &request, [x, y]).map_err(said)?)
    }

    /// The lobe in space: x, y, z and the value of each vertex of a grid.
    pub fn surface(&self, material: u32, request: &str, sigma: f64, rows: usize, columns: usize) -> Answer<Vec<f32>> {
        surface(self.opened(material)?, &Request::parse(request).map_err(said)?, sigma, [rows, columns]).map_err(said)
    }

    /// The difference between two materials, as JSON.
    pub fn compare(&self, a: u32, b: u32, request: &str) -> Answer<String> {
        let request = Request::parse(request).map_err(said)?;
        json(&compare(self.opened(a)?, self.opened(b)?, &request).map_err(said)?)
    }

    /// A map of the visible difference between two materials in each direction.
    pub fn difference(&self, a: u32, b: u32, request: &str, sigma: f64, size: usize) -> Answer<Picture> {
        let request = Request::parse(request).map_err(said)?;
        difference_map(self.opened(a)?, self.opened(b)?, &request, sigma, size).map(Picture).map_err(said)
    }

    /// The formats in which files can be written, as JSON.
    pub fn targets(&self, material: u32) -> Answer<String> {
        json(&targets(self.opened(material)?))
    }

    /// Converts a material to a file in another format.
    pub fn convert(&self, material: u32, word: &str, channel: &str) -> Answer<File> {
        let written = converted(self.opened(material)?, word, channel).map_err(said)?;
        Ok(File { name: written.name, bytes: written.bytes, note: written.note })
    }

    /// A quick picture of a ball under a lamp: a square with four bytes per pixel.
    pub fn ball(
        &mut self,
        material: u32,
        request: &str,
        size: usize,
        toward: &[f32],
        exposure: f32,
    ) -> Answer<Vec<u8>> {
        let request = Request::parse(request).map_err(said)?;
        if self.ball.as_ref().is_none_or(|ball| ball.size() != size) {
            self.ball = Some(Ball::new(size));
        }
        let ball = self.ball.as_ref().ok_or_else(|| said("no ball".into()))?;
        ball.picture(self.session.opened(material).map_err(said)?, &request, triple(toward)?, exposure).map_err(said)
    }

    /// Puts a material on the stage of this number; the request is JSON (`form`, `sky`, `toward`, `size`, `samples`).
    pub fn stage(&mut self, stage: usize, material: u32, request: &str) -> Answer<()> {
        let request = StudioRequest::parse(request).map_err(said)?;
        *self.studio(stage)? = None;
        let studio = Studio::new(self.opened(material)?, &request).map_err(said)?;
        *self.studio(stage)? = Some(studio);
        Ok(())
    }

    /// Restarts a picture with another lamp, sky or size. Returns `false` if that takes another stage.
    pub fn relight(&mut self, stage: usize, request: &str) -> Answer<bool> {
        let request = StudioRequest::parse(request).map_err(said)?;
        self.studio(stage)?.as_mut().map_or(Ok(false), |studio| studio.change(&request)).map_err(said)
    }

    /// Renders for about this many milliseconds. Returns the number of samples that every pixel has.
    pub fn render(&mut self, stage: usize, milliseconds: f64) -> Answer<u32> {
        let end = now() + milliseconds;
        self.studio(stage)?.as_mut().map_or(Ok(0), |studio| studio.step(|| now() < end)).map_err(said)
    }

    /// Returns `true` if a picture has all of its samples, or if there is no picture.
    pub fn rendered(&mut self, stage: usize) -> Answer<bool> {
        Ok(self.studio(stage)?.as_ref().is_none_or(Studio::is_done))
    }

    /// A picture so far, with four bytes per pixel.
    pub fn picture(&mut self, stage: usize, exposure: f32) -> Answer<Vec<u8>> {
        Ok(self.studio(stage)?.as_ref().map(|studio| studio.picture(exposure)).unwrap_or_default())
    }
}

/// A map of the outgoing hemisphere.
#[wasm_bindgen]
#[derive(Debug)]
pub struct Picture(Map);

#[wasm_bindgen]
impl Picture {
    /// Pixels along each side.
    #[wasm_bindgen(getter)]
    pub fn size(&self) -> usize {
        self.0.size
    }

    /// The value of each pixel; NaN outside the disk.
    #[wasm_bindgen(getter)]
    pub fn values(&self) -> Vec<f32> {
        self.0.values.clone()
    }

    /// Four bytes per pixel.
    #[wasm_bindgen(getter)]
    pub fn rgba(&self) -> Vec<u8> {
        self.0.rgba.clone()
    }

    /// The values at the two ends of the false colours.
    #[wasm_bindgen(getter)]
    pub fn range(&self) -> Vec<f64> {
        self.0.range.into()
    }

    /// The positions of the light and of the mirror direction: x and y of both.
    #[wasm_bindgen(getter)]
    pub fn marks(&self) -> Vec<f64> {
        self.0.marks.as_flattened().into()
    }

    /// 1 for each pixel within the measurement, and 0 elsewhere.
    #[wasm_bindgen(getter)]
    pub fn measured(&self) -> Vec<u8> {
        self.0.measured.clone()
    }
}

/// A file that was written.
#[wasm_bindgen]
#[derive(Debug)]
pub struct File {
    name: String,
    bytes: Vec<u8>,
    note: String,
}

#[wasm_bindgen]
impl File {
    /// The name of the file.
    #[wasm_bindgen(getter)]
    pub fn name(&self) -> String {
        self.name.clone()
    }

    /// The contents of the file.
    #[wasm_bindgen(getter)]
    pub fn bytes(&self) -> Vec<u8> {
        self.bytes.clone()
    }

    /// How the channels were changed; empty if they were not.
    #[wasm_bindgen(getter)]
    pub fn note(&self) -> String {
        self.note.clone()
    }
}
