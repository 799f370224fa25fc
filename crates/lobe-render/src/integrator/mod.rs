//! The ways to make a picture: each composes the stages of a wavefront in a file of its own.
//!
//! One line below makes an integrator known: to scene files, to the program and its help, and to programs that render.

use std::fmt::Debug;
use std::ops::Range;
use std::sync::Arc;

use crate::camera::View;
use crate::connect::{LightPart, Pass, Unpolarised};
use crate::film::{Film, Rect};
use crate::photon::LightMap;
use crate::scene::node::{Node, SceneError};
use crate::shader::Backend;
use crate::stats::Stats;
use crate::transport::{Bands, Rgb, Stokes16, StokesRgb, Transport};
use crate::wavefront::Wavefront;
use crate::world::World;

/// Declares the modules of integrators, lists them, and compiles each for every transport with this crate, so that
/// programs that render do not compile kernels again. A transport is a line here.
macro_rules! integrators {
    ($($module:ident::$Name:ident,)+; $($light:ident::$Light:ident,)+) => {
        $(mod $module;)+
        $(pub use $module::$Name;)+
        $(mod $light;)+
        $(pub use $light::$Light;)+

        /// All integrators.
        pub static INTEGRATORS: &[IntegratorSpec] =
            &[$(IntegratorSpec::of::<$Name>(),)+ $(IntegratorSpec::of_light::<$Light>()),+];

        $(integrators!(@ $Name: Rgb);)+
        $(integrators!(@light $Light: Rgb);)+
    };
    (@ $Name:ident: $($T:ty),+) => {
        $(impl Integrator<$T> for $Name {
            fn renderer<'w>(&'w self, task: Task<'w, $T>) -> Renderer<'w, $T> {
                Renderer::Tiles(Box::new(Driven::new(self, task)))
            }
        })+
    };
    (@light $Name:ident: $($T:ty),+) => {
        $(impl Integrator<$T> for $Name {
            fn renderer<'w>(&'w self, task: Task<'w, $T>) -> Renderer<'w, $T> {
                Renderer::Passes(Box::new(Driven::new(self, task)))
            }
        })+
    };
}

/// Compiles integrators for the transports of wavelengths and of polarised light, which few of them are wanted for.
macro_rules! spectral {
    ($($Name:ident),+) => {
        $(integrators!(@ $Name: Bands<8>, Bands<16>, Bands<32>, StokesRgb, Stokes16);)+

        /// The integrators that follow wavelengths and polarised light: their names, and how each is read.
        pub(crate) static SPECTRAL: &[SpectralSpec] = &[$(SpectralSpec {
            name: <$Name as Stages>::NAME,
            read: |table| Ok(Arc::new(<$Name as Stages>::read(table)?)),
            default: || Arc::new($Name::default()),
        }),+];
    };
}

spectral!(Path);

/// An integrator that is compiled for every transport.
pub(crate) trait AnyTransport:
    Integrator<Bands<8>> + Integrator<Bands<16>> + Integrator<Bands<32>> + Integrator<StokesRgb> + Integrator<Stokes16>
{
}

impl<I> AnyTransport for I where
    I: Integrator<Bands<8>>
        + Integrator<Bands<16>>
        + Integrator<Bands<32>>
        + Integrator<StokesRgb>
        + Integrator<Stokes16>
{
}

/// An integrator that a name denotes, for wavelengths and polarised light.
pub(crate) struct SpectralSpec {
    pub name: &'static str,
    pub read: fn(&Node<'_, '_>) -> Result<Arc<dyn AnyTransport>, SceneError>,
    pub default: fn() -> Arc<dyn AnyTransport>,
}

integrators! {
    path::Path,
    whitted::Whitted,
    ao::AmbientOcclusion,
    normals::Normals,
    ;
    light::LightTracing,
    sppm::Sppm,
    bdpt::Bdpt,
    vcm::Vcm,
}

/// A way to find the radiance that arrives at a camera.
///
/// Integrators are made of the stages of this crate, and compiled with it once for each transport.
pub trait Integrator<T: Transport = Rgb>: Debug + Send + Sync {
    /// What one thread renders with.
    #[doc(hidden)]
    fn renderer<'w>(&'w self, task: Task<'w, T>) -> Renderer<'w, T>;
}

/// What one thread renders with.
#[doc(hidden)]
#[expect(missing_debug_implementations, reason = "what it does is in the integrator")]
pub enum Renderer<'w, T: Transport> {
    /// Tiles, in any order.
    Tiles(Box<dyn TileRenderer<T> + 'w>),
    /// Passes, in each of them light paths before tiles.
    Passes(Box<dyn PassRenderer<T> + Send + 'w>),
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

/// Renders tiles that need the light paths of all threads.
#[doc(hidden)]
pub trait PassRenderer<T: Transport> {
    /// How many light paths there are, and what is kept of them.
    fn plan(&self) -> Plan;

    /// Follows light paths.
    #[allow(private_interfaces, reason = "only this crate implements and calls it")]
    fn light(&mut self, paths: Range<u32>, pass: &Pass) -> LightPart<T>;

    /// Follows a sample of the pixels of a tile. Returns what they bring.
    #[allow(private_interfaces, reason = "only this crate implements and calls it")]
    fn camera(&mut self, tile: Rect, pass: &Pass, map: &LightMap<T>) -> Film<T>;

    /// What has been done so far.
    fn stats(&self) -> Stats;
}

/// How a pass uses light paths.
#[doc(hidden)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plan {
    /// The most surfaces of a path.
    pub(crate) depth: u32,
    /// Light paths per pass; as many as pixels, up to a million, if it is `None`.
    pub(crate) paths: Option<u32>,
    /// Whether the camera sees light paths.
    pub(crate) splats: bool,
    /// Whether the surfaces of light paths are kept.
    pub(crate) keeps: bool,
    /// How photons are gathered, if they are.
    pub(crate) gathering: Option<Gathering>,
}

/// How photons are gathered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Gathering {
    /// The radius of the first pass; two pixels where the camera looks at if it is `None`.
    pub radius: Option<f32>,
    /// How it shrinks, from 0 to 1: quickly or not at all.
    pub shrink: f32,
    /// How many surfaces a path has met at least that is a photon.
    pub least: u32,
}

/// The keys that integrators with light paths share.
pub(crate) fn read_depth_and_paths(table: &Node<'_, '_>, depth: u32) -> Result<(u32, Option<u32>), SceneError> {
    Ok((table.whole("depth", 1..=1000)?.unwrap_or(depth), table.whole("paths", 1..=u32::MAX)?))
}

/// The keys of gathering.
pub(crate) fn read_gathering(table: &Node<'_, '_>, default: Gathering) -> Result<Gathering, SceneError> {
    let shrink = table.number("shrink", "a number from 0.1 to 1", |x| (0.1..=1.0).contains(&x))?;
    Ok(Gathering { radius: table.positive("radius")?, shrink: shrink.map_or(default.shrink, |x| x as f32), ..default })
}

/// How an integrator with light paths composes the stages of a wavefront.
pub(crate) trait LightStages: Clone + Debug + Default + Send + Sync + 'static {
    /// The name in scene files and on the command line.
    const NAME: &'static str;
    /// What it does, in a line.
    const SUMMARY: &'static str;

    /// Reads what its table in a scene file says.
    fn read(table: &Node<'_, '_>) -> Result<Self, SceneError>;

    /// How a pass uses light paths.
    fn plan(&self) -> Plan;

    /// Follows the light paths of a wave to their ends.
    fn follow_light<T: Unpolarised>(&self, wave: &mut Wavefront<'_, T>, pass: &Pass);

    /// Follows the camera rays of a wave to their ends.
    fn follow_camera<T: Unpolarised>(&self, wave: &mut Wavefront<'_, T>, pass: &Pass, map: &LightMap<T>);
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

impl IntegratorSpec {
    const fn of_light<I: LightStages + Integrator>() -> Self {
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

impl<T: Unpolarised, I: LightStages> PassRenderer<T> for Driven<'_, T, I> {
    fn plan(&self) -> Plan {
        self.integrator.plan()
    }

    #[allow(private_interfaces, reason = "only this crate implements and calls it")]
    fn light(&mut self, paths: Range<u32>, pass: &Pass) -> LightPart<T> {
        let integrator = self.integrator;
        self.wavefront.light_paths(paths, pass, |wave| integrator.follow_light(wave, pass))
    }

    #[allow(private_interfaces, reason = "only this crate implements and calls it")]
    fn camera(&mut self, tile: Rect, pass: &Pass, map: &LightMap<T>) -> Film<T> {
        let integrator = self.integrator;
        self.wavefront.camera_paths(tile, pass, |wave| integrator.follow_camera(wave, pass, map))
    }

    fn stats(&self) -> Stats {
        self.wavefront.stats
    }
}
