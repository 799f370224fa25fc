//! Pictures of scenes, whole and in parts.

use std::ops::Range;
use std::path::{Path, PathBuf};
use std::time::Duration;

use lobe_files::check_output;
use lobe_render::picture::{Meta, PictureError, ToneMap, inspect, read_partial, write_exr, write_png};
use lobe_render::scene::{Scene, SceneError};
use lobe_render::{Film, Pixel, Rect, Settings, integrator};
use numpy::prelude::*;
use numpy::{Element, PyArray1, PyArray2, PyArray3};
use pyo3::exceptions::{PyOSError, PyValueError};
use pyo3::prelude::*;

use crate::errors::{Failure, check_readable};
use crate::options::backend;
use crate::threads;

/// A picture, or a part of one.
///
/// Arrays begin with the upper row. `color` is the mean radiance in linear sRGB, of shape (height, width, 3).
#[pyclass(frozen, module = "lobe_bsdf")]
pub struct Picture {
    film: Film,
    meta: Meta,
}

fn picture_error(error: PictureError) -> PyErr {
    match error {
        PictureError::Io { file, error } => PyOSError::new_err(format!("{}: {error}", file.display())),
        other => PyValueError::new_err(other.to_string()),
    }
}

impl Picture {
    fn plane<'py, T: Element>(&self, py: Python<'py>, of: impl Fn(&Pixel) -> T) -> PyResult<Bound<'py, PyArray2<T>>> {
        let Rect { width, height, .. } = self.film.window();
        let values: Vec<T> = self.film.pixels().iter().map(of).collect();
        PyArray1::from_vec(py, values).reshape([height as usize, width as usize])
    }

    fn vectors<'py>(&self, py: Python<'py>, of: impl Iterator<Item = [f32; 3]>) -> PyResult<Bound<'py, PyArray3<f32>>> {
        let Rect { width, height, .. } = self.film.window();
        PyArray1::from_iter(py, of.flatten()).reshape([height as usize, width as usize, 3])
    }
}

#[pymethods]
impl Picture {
    /// Mean radiance in linear sRGB, (height, width, 3).
    #[getter]
    fn color<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<f32>>> {
        self.vectors(py, self.film.colours())
    }

    /// The mean albedo at the first hit, (height, width, 3), for denoisers.
    #[getter]
    fn albedo<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<f32>>> {
        self.vectors(py, self.film.pixels().iter().map(Pixel::mean_albedo))
    }

    /// The mean normal at the first hit, (height, width, 3).
    #[getter]
    fn normal<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<f32>>> {
        self.vectors(py, self.film.pixels().iter().map(Pixel::mean_normal))
    }

    /// The distance to the nearest surface in the pixel, (height, width); infinite if there is none.
    #[getter]
    fn depth<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f32>>> {
        self.plane(py, Pixel::depth)
    }

    /// The index of its material, counted from 1, (height, width).
    #[getter]
    fn material<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<u32>>> {
        self.plane(py, |pixel| pixel.material)
    }

    /// The number of samples, (height, width).
    #[getter]
    fn samples<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<u32>>> {
        self.plane(py, |pixel| pixel.samples)
    }

    /// The window of the whole picture that this is: x, y, width and height.
    #[getter]
    fn window(&self) -> (u32, u32, u32, u32) {
        let Rect { x, y, width, height } = self.film.window();
        (x, y, width, height)
    }

    /// Width and height of the whole picture.
    #[getter]
    fn size(&self) -> (u32, u32) {
        (self.meta.size[0], self.meta.size[1])
    }

    /// True if every pixel has all the requested samples.
    #[getter]
    fn is_finished(&self) -> bool {
        self.film.samples().0 >= self.meta.samples.end - self.meta.samples.start
    }

    /// Writes an EXR or PNG file, like `lobe render`. With `partial`, an EXR file also has the exact sums, from which
    /// merge() and `lobe merge` put pictures together. `exposure` is for PNG, in stops; the default is the exposure of
    /// the scene.
    #[pyo3(signature = (path, *, partial=false, exposure=None))]
    fn save(&self, py: Python<'_>, path: PathBuf, partial: bool, exposure: Option<f32>) -> PyResult<()> {
        let is = |extension: &str| path.extension().is_some_and(|found| found.eq_ignore_ascii_case(extension));
        let wrong = |message: &str| Err(PyValueError::new_err(format!("{}: {message}", path.display())));
        check_output::<&Path>(&path, &[]).map_err(Failure::from)?;
        let written = match (is("exr"), is("png")) {
            (true, _) if exposure.is_some() => {
                return wrong("found an exposure, but EXR holds unchanged radiances; expected .png");
            }
            (true, _) => py.detach(|| write_exr(&path, &self.film, &self.meta, partial)),
            (_, true) if partial => return wrong("found a PNG file; expected .exr, which holds exact sums"),
            (_, true) => {
                let tone = ToneMap { exposure: exposure.unwrap_or(self.meta.exposure) };
                py.detach(|| write_png(&path, &self.film, tone))
            }
            _ => return wrong("expected a name that ends in .exr or .png"),
        };
        written.map_err(picture_error)
    }

    fn __repr__(&self) -> String {
        let Rect { width, height, .. } = self.film.window();
        let (least, most) = self.film.samples();
        format!("<lobe_bsdf.Picture: {width} x {height} pixels, {least} to {most} samples>")
    }
}

/// The part of a scene to render.
#[derive(Clone, Debug, Default)]
struct Wanted {
    samples: Option<u32>,
    samples_range: Option<Range<u32>>,
    tile: Option<(u32, u32)>,
    crop: Option<[u32; 4]>,
    integrator: Option<String>,
    is_timed: bool,
}

/// If only a time limit is given, there is no other limit.
const UNLIMITED: u32 = 1 << 20;

/// The description of a rendering of a scene, as in its files.
fn planned(scene: &Scene, wanted: &Wanted, backend: lobe::Backend) -> Result<Meta, Failure> {
    let range = wanted.samples_range.clone();
    let total = match wanted.samples {
        Some(samples) => samples,
        None if wanted.is_timed => UNLIMITED,
        None => scene.samples.max(range.as_ref().map_or(0, |range| range.end)),
    };
    let samples = range.unwrap_or(0..total);
    if samples.is_empty() || samples.end > total {
        return Err(Failure::Value(format!(
            "samples_range: found {} to {}; expected a range that is not empty, up to at most {total}",
            samples.start, samples.end
        )));
    }
    let whole = Rect { x: 0, y: 0, width: scene.size[0], height: scene.size[1] };
    let window = match (wanted.tile, wanted.crop) {
        (Some(_), Some(_)) => return Err(Failure::value("found tile and crop; expected one of them")),
        (Some((part, parts)), None) => whole.strip(part, parts).ok_or_else(|| {
            Failure::Value(format!(
                "tile: found part {part} of {parts}; expected a part from 1 to the number of parts, and at most {} parts",
                whole.height
            ))
        })?,
        (None, Some([x0, y0, x1, y1])) => {
            let crop = Rect { x: x0, y: y0, width: x1.saturating_sub(x0), height: y1.saturating_sub(y0) };
            let fits = crop.area() > 0 && whole.intersection(&crop) == Some(crop);
            fits.then_some(crop).ok_or_else(|| {
                Failure::Value(format!(
                    "crop: found {x0}, {y0}, {x1}, {y1}; expected x0 < x1 and y0 < y1, up to {} and {}",
                    whole.width, whole.height
                ))
            })?
        }
        (None, None) => whole,
    };
    let hash = match &wanted.integrator {
        // Parts of pictures by different integrators must not be merged.
        Some(name) => format!("{}-{name}", scene.hash),
        None => scene.hash.clone(),
    };
    Ok(Meta {
        scene: hash,
        size: scene.size,
        window,
        samples,
        total,
        timed: wanted.is_timed,
        exposure: scene.exposure,
        version: Meta::VERSION.into(),
        arithmetic: Meta::arithmetic_of(backend),
    })
}

fn checked_integrator(name: Option<&str>) -> PyResult<Option<&'static integrator::IntegratorSpec>> {
    let Some(name) = name else { return Ok(None) };
    let found = integrator::named(name).ok_or_else(|| {
        let names: Vec<&str> = integrator::INTEGRATORS.iter().map(|spec| spec.name).collect();
        PyValueError::new_err(format!("integrator: found {name:?}; expected one of {}", names.join(", ")))
    })?;
    Ok(Some(found))
}

fn opened(py: Python<'_>, scene: &Path, backend: lobe::Backend) -> PyResult<Scene> {
    check_readable(scene)?;
    let open = |watch: &threads::Watch| -> Result<Scene, SceneError> {
        Scene::open_with_progress(scene, backend, &mut |_| watch.check())
    };
    Ok(threads::watched(py, open)?.map_err(Failure::Scene)?)
}

/// Renders a scene file and returns a Picture.
///
/// `samples` per pixel, the pixels `crop` = (x0, y0, x1, y1) and the `integrator` are taken from the scene unless
/// given. For parts of pictures, `tile` = (i, n) renders part i of n, counted from 1, and `samples_range` = (a, b) only
/// these samples. `time` in seconds ends the rendering, but every pixel gets at least one sample. The picture does not
/// depend on `threads`, and with `strict` it does not depend on the machine.
///
/// `progress(done, total)` is called about ten times a second; if it returns False, the picture so far is returned.
/// Ctrl-C raises KeyboardInterrupt.
#[pyfunction]
#[pyo3(signature = (scene, *, samples=None, crop=None, integrator=None, time=None, tile=None, samples_range=None, threads=None,
    backend=None, strict=false, progress=None))]
#[expect(clippy::too_many_arguments, reason = "keyword arguments of Python")]
pub fn render(
    py: Python<'_>,
    scene: PathBuf,
    samples: Option<u32>,
    crop: Option<[u32; 4]>,
    integrator: Option<String>,
    time: Option<f64>,
    tile: Option<(u32, u32)>,
    samples_range: Option<(u32, u32)>,
    threads: Option<usize>,
    backend: Option<&str>,
    strict: bool,
    progress: Option<Py<PyAny>>,
) -> PyResult<Picture> {
    let time = time.map(Duration::try_from_secs_f64).transpose();
    let time = time.map_err(|error| PyValueError::new_err(format!("time: {error}; expected seconds")))?;
    if time.is_some() && samples_range.is_some() {
        return Err(PyValueError::new_err("found time and samples_range; expected one of them"));
    }
    if samples == Some(0) || threads == Some(0) {
        return Err(PyValueError::new_err("found 0 samples or threads; expected at least one"));
    }
    let spec = checked_integrator(integrator.as_deref())?;
    let backend = self::backend(backend, strict)?;
    let begun = std::time::Instant::now();
    let scene = opened(py, &scene, backend)?;
    let samples_range = samples_range.map(|(from, to)| from..to);
    let wanted = Wanted { samples, samples_range, tile, crop, integrator, is_timed: time.is_some() };
    let meta = planned(&scene, &wanted, backend)?;
    let film = Film::try_new(meta.window, 0)
        .map_err(|no_room| pyo3::exceptions::PyMemoryError::new_err(format!("found a picture that takes {no_room}")))?;
    let Scene { world, camera, size, filter, integrator, .. } = scene;
    let settings = Settings {
        camera,
        size,
        window: meta.window,
        filter,
        integrator: spec.map_or(integrator, |spec| (spec.default)()),
        samples: meta.samples.clone(),
        backend,
        threads: threads.unwrap_or_else(|| std::thread::available_parallelism().map_or(1, usize::from)),
        time: time.map(|time| time.saturating_sub(begun.elapsed())),
    };
    let mut raised = None;
    let rendered = py.detach(|| {
        lobe_render::render(&world, &settings, film, |so_far| {
            let goes_on = Python::attach(|py| {
                py.check_signals()?;
                match &progress {
                    Some(progress) => Ok(!progress.bind(py).call1((so_far.done, so_far.total))?.is(false_of(py))),
                    None => Ok(true),
                }
            });
            goes_on.unwrap_or_else(|error: PyErr| {
                raised.get_or_insert(error);
                false
            })
        })
    });
    match raised {
        Some(error) => Err(error),
        None => {
            let (film, _) = rendered.map_err(|error| PyValueError::new_err(error.to_string()))?;
            Ok(Picture { film, meta })
        }
    }
}

fn false_of(py: Python<'_>) -> Bound<'_, PyAny> {
    pyo3::types::PyBool::new(py, false).to_owned().into_any()
}

/// Puts the files of parts of a picture together and returns a Picture, with the same bits as if it had been rendered
/// in one go.
///
/// Raises ValueError if parts belong to different pictures, if samples occur twice, or if samples are missing, unless
/// `allow_gaps` is true.
#[pyfunction]
#[pyo3(signature = (parts, *, allow_gaps=false))]
pub fn merge(py: Python<'_>, parts: Vec<PathBuf>, allow_gaps: bool) -> PyResult<Picture> {
    let merged = threads::watched(py, |_| lobe_render::merge(&parts, allow_gaps))?;
    let (film, meta) = merged.map_err(|error| PyValueError::new_err(error.to_string()))?;
    Ok(Picture { film, meta })
}

/// Checks which files are finished parts of the picture that render() makes of the scene with these arguments: file i
/// of n, counted from 1, must be part `tile` = (i, n), saved with `partial`. Returns a list with one bool per file.
#[pyfunction]
#[pyo3(signature = (paths, scene, *, samples=None, integrator=None, backend=None, strict=false))]
pub fn finished_parts(
    py: Python<'_>,
    paths: Vec<PathBuf>,
    scene: PathBuf,
    samples: Option<u32>,
    integrator: Option<String>,
    backend: Option<&str>,
    strict: bool,
) -> PyResult<Vec<bool>> {
    let backend = self::backend(backend, strict)?;
    checked_integrator(integrator.as_deref())?;
    let scene = opened(py, &scene, backend)?;
    let parts = u32::try_from(paths.len()).unwrap_or(u32::MAX);
    let mut finished = Vec::new();
    for (part, path) in (1..).zip(&paths) {
        let wanted = Wanted { samples, tile: Some((part, parts)), integrator: integrator.clone(), ..Wanted::default() };
        let meta = planned(&scene, &wanted, backend)?;
        // The file of an interrupted rendering has the same description, but not all samples.
        let is_whole = |film: &Film| film.samples().0 >= meta.samples.end - meta.samples.start;
        let is_part = inspect(path).is_ok_and(|found| found.has_sums && found.meta == meta)
            && read_partial(path).is_ok_and(|(film, _)| is_whole(&film));
        finished.push(is_part);
        py.check_signals()?;
    }
    Ok(finished)
}
