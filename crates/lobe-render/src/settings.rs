//! What to render and how, how far it is, and why it is not done.

use std::ops::Range;
use std::sync::Arc;
use std::time::Duration;

use lobe_memory::NoRoom;

use crate::camera::{Camera, CameraError, Filter};
use crate::film::{Film, Rect};
use crate::integrator::Integrator;
use crate::shader::Backend;
use crate::transport::{Rgb, Transport};

/// What to render and how.
#[derive(Clone, Debug)]
pub struct Settings<T: Transport = Rgb> {
    /// What the picture is taken with.
    pub camera: Camera,
    /// Columns and rows of the whole picture, each in `1 ..= 65536`.
    pub size: [u32; 2],
    /// The pixels to render, inside of the picture.
    pub window: Rect,
    /// How samples are spread around a pixel.
    pub filter: Filter,
    /// How radiance is found.
    pub integrator: Arc<dyn Integrator<T>>,
    /// The numbers of the samples to render.
    pub samples: Range<u32>,
    /// The lanes that rays are traced in; materials have theirs. With both in strict form the picture is the same bits
    /// on every machine.
    pub backend: Backend,
    /// How many threads; the picture does not depend on it.
    pub threads: usize,
    /// After this time no more samples are begun, but every pixel gets one.
    pub time: Option<Duration>,
}

/// Why nothing can be rendered.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RenderError {
    /// The camera makes no rays.
    #[error(transparent)]
    Camera(#[from] CameraError),
    /// The window is empty or not inside of the picture.
    #[error("the window {window:?} of a picture of {} x {}; expected a non-empty window inside it", size[0], size[1])]
    Window {
        /// What was requested.
        window: Rect,
        /// The picture.
        size: [u32; 2],
    },
    /// The film to continue has another window.
    #[error("a film of the window {found:?}; expected {expected:?}")]
    Film {
        /// Its window.
        found: Rect,
        /// That of the settings.
        expected: Rect,
    },
    /// The film to continue was not written by a rendering of this window.
    #[error("a film whose samples differ within a tile; expected one that a rendering of the same window has begun")]
    Uneven,
    /// An integrator that begins at the lights has none to begin at.
    #[error("no light emits anything; expected one that does, as this integrator follows light from the lights")]
    Dark,
    /// The light paths of a pass are more than memory holds.
    #[error("the light paths of a pass take {0}; expected `paths` that fit")]
    Memory(NoRoom),
}

/// How far a rendering is.
pub struct Progress<'a, T: Transport = Rgb> {
    /// Samples done, including those of an earlier rendering that this one continues.
    pub done: u64,
    /// Samples to do, or as many as there would be without a time limit.
    pub total: u64,
    /// Time since the beginning.
    pub elapsed: Duration,
    pub(crate) film: &'a dyn Fn() -> Film<T>,
}

impl<T: Transport> Progress<'_, T> {
    /// A copy of the film as it is: whole samples, the first ones of each pixel.
    pub fn film(&self) -> Film<T> {
        (self.film)()
    }
}
