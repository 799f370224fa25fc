//! Settings, progress and errors of a rendering.

use std::ops::Range;
use std::sync::Arc;
use std::time::Duration;

use lobe_memory::NoRoom;

use crate::camera::{Camera, CameraError, Filter};
use crate::film::{Film, Rect};
use crate::integrator::Integrator;
use crate::shader::Backend;
use crate::transport::{Rgb, Transport};

/// The settings of a rendering.
#[derive(Clone, Debug)]
pub struct Settings<T: Transport = Rgb> {
    /// The camera.
    pub camera: Camera,
    /// Columns and rows of the whole picture, each in `1 ..= 65536`.
    pub size: [u32; 2],
    /// The pixels to render, inside the picture.
    pub window: Rect,
    /// The filter that spreads samples around a pixel.
    pub filter: Filter,
    /// The integrator.
    pub integrator: Arc<dyn Integrator<T>>,
    /// The indices of the samples to render.
    pub samples: Range<u32>,
    /// The backend that traces rays; materials have their own. With both in strict form, the picture has the same bits
    /// on every machine.
    pub backend: Backend,
    /// Number of threads; the picture does not depend on it.
    pub threads: usize,
    /// After this time no more samples are started, but every pixel gets at least one.
    pub time: Option<Duration>,
}

/// The reason why nothing can be rendered.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RenderError {
    /// The camera cannot generate rays.
    #[error(transparent)]
    Camera(#[from] CameraError),
    /// The window is empty or not inside the picture.
    #[error("the window {window:?} of a picture of {} x {}; expected a non-empty window inside it", size[0], size[1])]
    Window {
        /// The requested window.
        window: Rect,
        /// The size of the picture.
        size: [u32; 2],
    },
    /// The film to continue has another window.
    #[error("a film of the window {found:?}; expected {expected:?}")]
    Film {
        /// Its window.
        found: Rect,
        /// The window of the settings.
        expected: Rect,
    },
    /// The film to continue does not come from a rendering of this window.
    #[error("a film whose samples differ within a tile; expected one from a rendering of the same window")]
    Uneven,
    /// The integrator begins paths at lights, but there are none.
    #[error("no light emits anything; expected one that does, as this integrator follows light from the lights")]
    Dark,
    /// The light paths of a pass do not fit into memory.
    #[error("the light paths of a pass take {0}; expected a number of `paths` that fits into memory")]
    Memory(NoRoom),
}

/// Progress of a rendering.
pub struct Progress<'a, T: Transport = Rgb> {
    /// Number of finished samples, including those of an earlier rendering that this one continues.
    pub done: u64,
    /// Number of samples to render, ignoring a time limit.
    pub total: u64,
    /// Time since the start.
    pub elapsed: Duration,
    pub(crate) film: &'a dyn Fn() -> Film<T>,
}

impl<T: Transport> Progress<'_, T> {
    /// A copy of the film in its current state: whole samples, the first ones of each pixel.
    pub fn film(&self) -> Film<T> {
        (self.film)()
    }
}
