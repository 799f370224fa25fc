//! The renderer for each number of channels that there is one for.
//!
//! All of it is generic in that number, and generic code is compiled by whoever calls it: every program that renders
//! would compile each kernel for each backend again, for minutes. So it is called here.

use std::ops::Range;

use crate::camera::View;
use crate::film::{Film, Rect};
use crate::integrator::Integrator;
use crate::shader::Backend;
use crate::stats::Stats;
use crate::wavefront::Wavefront;
use crate::world::World;

/// Worlds that [`render`](crate::render()) takes: those of three channels. For another number of channels, a line in the
/// module of this trait makes the renderer.
pub trait Renderable<const C: usize>: Sync {
    /// What one thread renders with.
    #[doc(hidden)]
    fn painter<'w>(&'w self, task: &'w Task) -> Painter<'w, C>;
}

/// What to render, and how.
#[derive(Debug)]
pub struct Task {
    pub(crate) view: View,
    pub(crate) integrator: Integrator,
    pub(crate) backend: Backend,
}

/// One thread's renderer.
pub struct Painter<'w, const C: usize>(Box<dyn Paint<C> + 'w>);

impl<const C: usize> Painter<'_, C> {
    /// Follows the samples of a tile. Returns what they see.
    pub(crate) fn paint(&mut self, tile: Rect, samples: Range<u32>) -> Film<C> {
        self.0.paint(tile, samples)
    }

    /// What has been done so far.
    pub(crate) fn stats(&self) -> Stats {
        self.0.stats()
    }
}

trait Paint<const C: usize> {
    fn paint(&mut self, tile: Rect, samples: Range<u32>) -> Film<C>;
    fn stats(&self) -> Stats;
}

impl<const C: usize> Paint<C> for Wavefront<'_, C> {
    fn paint(&mut self, tile: Rect, samples: Range<u32>) -> Film<C> {
        self.render(tile, samples)
    }

    fn stats(&self) -> Stats {
        self.stats
    }
}

impl Renderable<3> for World<3> {
    fn painter<'w>(&'w self, task: &'w Task) -> Painter<'w, 3> {
        Painter(Box::new(Wavefront::new(self, &task.view, task.integrator, task.backend)))
    }
}
