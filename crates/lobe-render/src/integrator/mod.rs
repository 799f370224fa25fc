//! Integrators: ways to render a picture. Each composes the stages of a wavefront, in its own file.
//!
//! One line below registers an integrator for scene files, for the program and its help, and for programs that render.

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
use crate::transport::{Bands, Energy16, EnergyRgb, Rgb, Stokes16, StokesRgb, Transport};
use crate::wavefront::Wavefront;
use crate::world::World;

/// Declares the modules of integrators, lists them, and compiles each for every transport as part of this crate, so
/// that programs that render do not compile kernels again. Each transport is one line here.
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

/// Compiles integrators for the transports of wavelengths and of polarised light, which only few of them need.
macro_rules! spectral {
    ($($Name:ident),+) => {
        $(integrators!(@ $Name: Bands<8>, Bands<16>, Bands<32>, StokesRgb, Stokes16, EnergyRgb, Energy16);)+

        /// The integrators that follow wavelengths and polarised light: their names and readers.
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
    Integrator<Bands<8>>
    + Integrator<Bands<16>>
    + Integrator<Bands<32>>
    + Integrator<StokesRgb>
    + Integrator<Stokes16>
    + Integrator<EnergyRgb>
    + Integrator<Energy16>
{
}

impl<I> AnyTransport for I where
    I: Integrator<Bands<8>>
        + Integrator<Bands<16>>
        + Integrator<Bands<32>>
        + Integrator<StokesRgb>
        + Integrator<Stokes16>
        + Integrator<EnergyRgb>
        + Integrator<Energy16>
{
}

/// An integrator with a name, for wavelengths and polarised light.
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
/// Integrators are composed of the stages of this crate, and compiled with it once for each transport.
pub trait Integrator<T: Transport = Rgb>: Debug + Send + Sync {
    /// The state of one rendering thread.
    #[doc(hidden)]
    fn renderer<'w>(&'w self, task: Task<'w, T>) -> Renderer<'w, T>;
}

/// The state of one rendering thread.
#[doc(hidden)]
#[expect(missing_debug_implementations, reason = "the integrator says what it does")]
pub enum Renderer<'w, T: Transport> {
    /// It renders tiles, in any order.
    Tiles(Box<dyn TileRenderer<T> + 'w>),
    /// It renders passes, and in each of them light paths before tiles.
    Passes(Box<dyn PassRenderer<T> + Send + 'w>),
}

/// The scene to render, and the lanes to render on.
#[derive(Debug)]
pub struct Task<'w, T: Transport> {
    pub(crate) world: &'w World<T>,
    pub(crate) view: &'w View,
    pub(crate) backend: Backend,
}

/// Renders tiles on one thread.
pub trait TileRenderer<T: Transport> {
    /// Follows these samples of the pixels of a tile and returns their contributions.
    fn render(&mut self, tile: Rect, samples: Range<u32>) -> Film<T>;

    /// Statistics of the work done so far.
    fn stats(&self) -> Stats;
}

/// Renders tiles that need the light paths of all threads.
#[doc(hidden)]
pub trait PassRenderer<T: Transport> {
    /// How many light paths there are, and which of their surfaces are kept.
    fn plan(&self) -> Plan;

    /// Follows light paths.
    #[allow(private_interfaces, reason = "only this crate implements and calls it")]
    fn light(&mut self, paths: Range<u32>, pass: &Pass) -> LightPart<T>;

    /// Follows one sample of the pixels of a tile and returns the contributions.
    #[allow(private_interfaces, reason = "only this crate implements and calls it")]
    fn camera(&mut self, tile: Rect, pass: &Pass, map: &LightMap<T>) -> Film<T>;

    /// Statistics of the work done so far.
    fn stats(&self) -> Stats;
}

/// How a pass uses light paths.
#[doc(hidden)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plan {
    /// The largest number of surfaces of a path.
    pub(crate) depth: u32,
    /// Number of light paths per pass; if it is `None`, as many as there are pixels, up to a million.
    pub(crate) paths: Option<u32>,
    /// `true` if the camera sees light paths.
    pub(crate) splats: bool,
    /// `true` if the surfaces of light paths are kept.
    pub(crate) keeps: bool,
    /// How photons are gathered, if they are.
    pub(crate) gathering: Option<Gathering>,
}

/// How photons are gathered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Gathering {
    /// The radius of the first pass; if it is `None`, the size of two pixels at the target of the camera.
    pub radius: Option<f32>,
    /// How fast it shrinks, from 0 (fast) to 1 (not at all).
    pub shrink: f32,
    /// The least number of surfaces that a path must have met to count as a photon.
    pub least: u32,
}

/// The keys shared by integrators with light paths.
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
    /// Its name in scene files and on the command line.
    const NAME: &'static str;
    /// A description in one line.
    const SUMMARY: &'static str;

    /// Reads its table in a scene file.
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
    /// Its name in scene files and on the command line.
    const NAME: &'static str;
    /// A description in one line.
    const SUMMARY: &'static str;

    /// Reads its table in a scene file.
    fn read(table: &Node<'_, '_>) -> Result<Self, SceneError>;

    /// Follows the camera rays of a wave to their ends.
    fn follow<T: Transport>(&self, wave: &mut Wavefront<'_, T>);
}

/// An integrator with a name.
#[derive(Clone, Copy, Debug)]
pub struct IntegratorSpec {
    /// Its name in scene files and on the command line.
    pub name: &'static str,
    /// A description in one line.
    pub summary: &'static str,
    /// The integrator with its default parameters.
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
