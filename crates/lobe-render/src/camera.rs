//! Where the picture is taken from.

use lobe_lane::Lanes;
use lobe_scalar::Reference;

use crate::vec3::{Vec3, add, cross, length, scale, sub, unit};
use crate::vectors::disk;

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

impl Filter {
    /// Where in the picture, in pixels from the centre of the pixel.
    fn offset(self, u: f32) -> f32 {
        match self {
            Filter::Box => u - 0.5,
            Filter::Tent if u < 0.5 => (2.0 * u).sqrt() - 1.0,
            Filter::Tent => 1.0 - (2.0 - 2.0 * u).sqrt(),
        }
    }
}

/// What is wrong with a camera.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum CameraError {
    /// The target is where the camera is, or too far to tell a direction.
    #[error("a target in the camera itself; expected one in front of it")]
    Target,
    /// The direction up is none, or along the view.
    #[error("a direction up that is none across the view; expected one that is not along it")]
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

    /// The ray through a pixel: origin, and direction of length 1.
    pub fn ray(&self, [x, y]: [u32; 2], u: [f32; 4]) -> (Vec3, Vec3) {
        let place = |pixel: u32, u: f32, size: f32| 2.0 * ((pixel as f32 + 0.5 + self.filter.offset(u)) / size) - 1.0;
        let (px, py) = (place(x, u[0], self.size[0]), -place(y, u[1], self.size[1]));
        let through = add(self.forward, add(scale(self.right, px), scale(self.top, py)));
        if self.focus == f32::INFINITY {
            return (self.position, unit(through).unwrap_or(self.forward));
        }
        let lanes = Reference::default();
        let [lx, ly] = disk(lanes, [u[2], u[3]].map(|u| lanes.splat(u))).map(|x| lanes.extract(x, 0));
        let aside = add(scale(self.lens[0], lx), scale(self.lens[1], ly));
        let direction = sub(scale(through, self.focus), aside);
        // A focus that is not finite or not positive is refused before; the length is that of a vector along the view.
        (add(self.position, aside), unit(direction).unwrap_or(self.forward))
    }
}
