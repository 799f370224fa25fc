//! Where the picture is taken from.

use lobe::{Backend, Floats, Kernel, Lanes};
use lobe_trace::RaySoA;

use crate::random::Numbers;
use crate::vec3::{Vec3, cross, length, scale, sub, unit};
use crate::vectors::{self, add, disk, unit_or};

/// A thin-lens camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// The middle of the lens.
    pub position: [f32; 3],
    /// What is in the middle of the picture.
    pub target: [f32; 3],
    /// What is up in the picture, not along the view.
    pub up: [f32; 3],
    /// Angle of view from the bottom to the top of the picture, in radians, in `(0, pi)`.
    pub field_of_view: f32,
    /// Radius of the lens in the units of the scene; 0 for a pinhole.
    pub lens_radius: f32,
    /// Distance along the axis at which points are sharp; that of `target` where it is `None`.
    pub focus_distance: Option<f32>,
}

/// How the samples of a pixel are spread. A sample counts in its own pixel only.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Filter {
    /// Over the square of the pixel.
    Box,
    /// With a density that falls linearly to 0 at the centres of the neighbours.
    #[default]
    Tent,
}

/// What is wrong with a camera.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum CameraError {
    /// The target is at the camera, or too far away for a direction.
    #[error("`target` is at `position`, or too far away; expected a point in front of the camera")]
    Target,
    /// `up` is zero or parallel to the view direction.
    #[error("`up` is zero or parallel to the view direction")]
    Up,
}

/// A camera and the film behind it, ready to make rays.
#[derive(Clone, Copy, Debug)]
pub(crate) struct View {
    position: Vec3,
    /// From the camera to the middle of the picture, to its right edge from there, and to its top, at distance 1.
    forward: Vec3,
    right: Vec3,
    top: Vec3,
    /// The axes of the lens.
    lens: [Vec3; 2],
    focus: f32,
    size: [f32; 2],
    filter: Filter,
}

impl View {
    pub fn new(camera: &Camera, [width, height]: [u32; 2], filter: Filter) -> Result<Self, CameraError> {
        let toward = sub(camera.target, camera.position);
        let forward = unit(toward).ok_or(CameraError::Target)?;
        let up = unit(camera.up).ok_or(CameraError::Up)?;
        let across = cross(forward, up);
        let right = unit(across).filter(|_| length(across) > 1e-4).ok_or(CameraError::Up)?;
        let top = cross(right, forward);
        // All is sharp for a pinhole.
        let pinhole = camera.lens_radius == 0.0;
        let tangent = libm::tanf(0.5 * camera.field_of_view);
        let aspect = width as f32 / height as f32;
        Ok(View {
            position: camera.position,
            forward,
            right: scale(right, tangent * aspect),
            top: scale(top, tangent),
            lens: [scale(right, camera.lens_radius), scale(top, camera.lens_radius)],
            focus: if pinhole { f32::INFINITY } else { camera.focus_distance.unwrap_or_else(|| length(toward)) },
            size: [width as f32, height as f32],
            filter,
        })
    }

    /// Rays through the pixels of these columns and rows, one for each set of numbers; directions have length 1. The
    /// columns, the rows and the rays are as many as fill the lanes.
    pub fn rays(&self, backend: Backend, pixels: &[Vec<f32>; 2], numbers: &Numbers, out: &mut RaySoA) {
        backend.run(Viewing { view: self, pixels, numbers, out });
    }

    /// InteractionBlock in the picture along an axis, from -1 to 1, of pixels and numbers drawn for them.
    #[inline(always)]
    fn place<L: Lanes>(&self, lanes: L, pixel: L::F, u: L::F, size: f32) -> L::F {
        let (one, two, half) = (lanes.splat(1.0), lanes.splat(2.0), lanes.splat(0.5));
        let offset = match self.filter {
            Filter::Box => u - half,
            Filter::Tent => {
                let (left, right) = ((two * u).sqrt() - one, one - (two - two * u).sqrt());
                lanes.select(u.lt(half), left, right)
            }
        };
        two * ((pixel + half + offset) / lanes.splat(size)) - one
    }
}

struct Viewing<'a> {
    view: &'a View,
    pixels: &'a [Vec<f32>; 2],
    numbers: &'a Numbers,
    out: &'a mut RaySoA,
}

impl Kernel for Viewing<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let Viewing { view, pixels: [x, y], numbers, out } = self;
        let [forward, right, top] =
            [lanes.splat_xyz(view.forward), lanes.splat_xyz(view.right), lanes.splat_xyz(view.top)];
        let position = lanes.splat_xyz(view.position);
        let lens = [lanes.splat_xyz(view.lens[0]), lanes.splat_xyz(view.lens[1])];
        let mut at = 0;
        while at < x.len() {
            let [u, v, lens_u, lens_v] = numbers.lanes(lanes, at);
            let px = view.place(lanes, lanes.load(&x[at..]), u, view.size[0]);
            let py = -view.place(lanes, lanes.load(&y[at..]), v, view.size[1]);
            let mut origin = position;
            let mut direction =
                add::<L>(forward, add::<L>(vectors::scale::<L>(right, px), vectors::scale::<L>(top, py)));
            if view.focus < f32::INFINITY {
                let [lx, ly] = disk(lanes, [lens_u, lens_v]);
                let aside = add::<L>(vectors::scale::<L>(lens[0], lx), vectors::scale::<L>(lens[1], ly));
                // A focus that is not positive is refused before: the direction has a length.
                direction = vectors::sub::<L>(vectors::scale::<L>(direction, lanes.splat(view.focus)), aside);
                origin = add::<L>(position, aside);
            }
            let direction = unit_or(lanes, direction, forward);
            let mut axis = 0;
            while axis < 3 {
                lanes.store(&mut out.origin[axis][at..], origin[axis]);
                lanes.store(&mut out.direction[axis][at..], direction[axis]);
                axis += 1;
            }
            at += L::LANES;
        }
    }
}
