//! The ways to make a picture: each composes the stages of a wavefront in a file of its own.
//!
//! One line below makes an integrator known: to scene files, to the program and its help, and to programs that render.

use std::fmt::Debug;
use std::ops::Range;
use std::sync::Arc;

use crate::camera::View;
use crate::film::{Film, Rect};
use crate::scene::node::{Node, SceneError};
use crate::shader::Backend;
use crate::stats::Stats;
use crate::transport::{Rgb, Transport};
use crate::wavefront::Wavefront;
use crate::world::World;

/// Declares the modules of integrators, lists them, and compiles each for every transport with this crate, so that
/// programs that render do not compile kernels again. A transport is a line here.
macro_rules! integrators {
    ($($module:ident::$Name:ident,)+) => {
        $(mod $module;)+
        $(pub use $module::$Name;)+

        /// All integrators.
        pub static INTEGRATORS: &[IntegratorSpec] = &[$(IntegratorSpec::of::<$Name>()),+];

        $(integrators!(@ $Name: Rgb);)+
    };
    (@ $Name:ident: $($T:ty),+) => {
        $(impl Integrator<$T> for $Name {
            fn tile_renderer<'w>(&'w self, task: Task<'w, $T>) -> Box<dyn TileRenderer<$T> + 'w> {
                Box::new(Driven::new(self, task))
            }
        })+
    };
}

integrators! {
    path::Path,
    whitted::Whitted,
    ao::AmbientOcclusion,
    normals::Normals,
}

/// A way to find the radiance that arrives at a camera.
///
/// Integrators are made of the stages of this crate, and compiled with it once for each transport.
pub trait Integrator<T: Transport = Rgb>: Debug + Send + Sync {
    /// What one thread renders tiles with.
    #[doc(hidden)]
    fn tile_renderer<'w>(&'w self, task: Task<'w, T>) -> Box<dyn TileRenderer<T> + 'w>;
}

/// What to render, and on which lanes.
#[derive(Debug)]
pub struct Task<'w, T: Transport> {
    pub(crate) world: &'w World<T>,
    pub(crate) view: &'w View,
    pub(crate) backend: Backend,
}

/// Renders tiles on one thread.
pub trait TileRenderer<T: Transport> {
    /// Follows these samples of the pixels of a tile. Returns what they bring.
    fn render(&mut self, tile: Rect, samples: Range<u32>) -> Film<T>;

    /// What has been done so far.
    fn stats(&self) -> Stats;
}

/// How an integrator composes the stages of a wavefront.
pub(crate) trait Stages: Clone + Debug + Default + Send + Sync + 'static {
    /// The name in scene files and on the command line.
    const NAME: &'static str;
    /// What it does, in a line.
    const SUMMARY: &'static str;

    /// Reads what its table in a scene file says.
    fn read(table: &Node<'_, '_>) -> Result<Self, SceneError>;

    /// Follows the camera rays of a wave to their ends.
    fn follow<T: Transport>(&self, wave: &mut Wavefront<'_, T>);
}

/// An integrator that a name denotes.
#[derive(Clone, Copy, Debug)]
pub struct IntegratorSpec {
    /// The name in scene files and on the command line.
    pub name: &'static str,
    /// What it does, in a line.
    pub summary: &'static str,
    /// With its default parameters.
    pub default: fn() -> Arc<dyn Integrator>,
    pub(crate) read: fn(&Node<'_, '_>) -> Result<Arc<dyn Integrator>, SceneError>,
}

/// The integrator of that name.
pub fn named(name: &str) -> Option<&'static IntegratorSpec> {
    INTEGRATORS.iter().find(|spec| spec.name == name)
}

impl IntegratorSpec {
    const fn of<I: Stages + Integrator>() -> Self {
        IntegratorSpec {
            name: I::NAME,
            summary: I::SUMMARY,
            default: || Arc::new(I::default()),
            read: |table| Ok(Arc::new(I::read(table)?)),
        }
    }
}

/// A wavefront and the integrator that drives it.
struct Driven<'w, T: Transport, I> {
    integrator: &'w I,
    wavefront: Wavefront<'w, T>,
}

impl<'w, T: Transport, I> Driven<'w, T, I> {
    fn new(integrator: &'w I, Task { world, view, backend }: Task<'w, T>) -> Self {
        Driven { integrator, wavefront: Wavefront::new(world, view, backend) }
    }
}

impl<T: Transport, I: Stages> TileRenderer<T> for Driven<'_, T, I> {
    fn render(&mut self, tile: Rect, samples: Range<u32>) -> Film<T> {
        self.wavefront.render(self.integrator, tile, samples)
    }

    fn stats(&self) -> Stats {
        self.wavefront.stats
    }
}
