//! Cameras: the rays that they generate, and the importance that they give to the points they see.

use lobe::{Backend, Floats, Kernel, Lanes};
use lobe_scalar::Reference;
use lobe_trace::RaySoA;

use crate::random::Numbers;
use crate::vec3::{self, Vec3, cross, length, scale, sub, unit};
use crate::vectors::{self, add, disk, unit_or};

/// A thin-lens camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// The centre of the lens.
    pub position: [f32; 3],
    /// The point in the middle of the picture.
    pub target: [f32; 3],
    /// The direction that is up in the picture; it must not be parallel to the view.
    pub up: [f32; 3],
    /// Angle of view from the bottom to the top of the picture, in radians, in `(0, pi)`.
    pub field_of_view: f32,
    /// Radius of the lens in the units of the scene; 0 for a pinhole.
    pub lens_radius: f32,
    /// Distance along the axis at which points are in focus; the distance of `target` if it is `None`.
    pub focus_distance: Option<f32>,
}

/// How the samples of a pixel are spread. A sample counts in its own pixel only.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Filter {
    /// Uniformly over the square of the pixel.
    Box,
    /// With a density that falls linearly to 0 at the centres of the neighbours.
    #[default]
    Tent,
}

/// An error of a camera.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum CameraError {
    /// The target is at the camera, or too far away for a direction.
    #[error("`target` is at `position`, or too far away; expected a point in front of the camera")]
    Target,
    /// `up` is zero or parallel to the view direction.
    #[error("`up` is zero or parallel to the view direction")]
    Up,
}

/// A camera and its film, ready to generate rays.
#[derive(Clone, Copy, Debug)]
pub struct View {
    position: Vec3,
    /// Vectors at distance 1: from the camera to the middle of the picture, and from there to its right and to its top
    /// edge.
    forward: Vec3,
    right: Vec3,
    top: Vec3,
    /// The axes of the lens.
    lens: [Vec3; 2],
    focus: f32,
    size: [f32; 2],
    /// Area of the picture at distance 1.
    film_area: f32,
    filter: Filter,
}

/// A point of the lens in each lane, sampled from points of the scene.
#[derive(Clone, Copy, Debug)]
pub struct CameraSample<L: Lanes> {
    /// Toward the lens, unit length.
    pub wi: [L::F; 3],
    /// Distance.
    pub distance: L::F,
    /// Importance of the ray that leaves the lens for the point. Its integral, times the cosine to the axis, over the
    /// lens and over all directions is 1.
    pub importance: L::F,
    /// Density over solid angle at the point, 1/sr; for a pinhole, the squared distance over the cosine.
    pub pdf: L::F,
    /// The position in the picture at which the point appears: columns from the left and rows from the top, in pixels.
    pub raster: [L::F; 2],
    /// `true` if the point is seen; otherwise the other numbers are unspecified.
    pub valid: L::M,
}

/// Densities of camera rays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraPdf {
    /// Over the area of the lens.
    pub position: f32,
    /// Over solid angle, 1/sr.
    pub direction: f32,
}

impl View {
    /// A vector to the top of the picture, of any length.
    pub(crate) fn top(&self) -> Vec3 {
        self.top
    }

    /// The view of a camera with a film of this many columns and rows.
    ///
    /// # Errors
    /// If the camera has no viewing direction, or `up` is parallel to it.
    pub fn new(camera: &Camera, [width, height]: [u32; 2], filter: Filter) -> Result<Self, CameraError> {
        let toward = sub(camera.target, camera.position);
        let forward = unit(toward).ok_or(CameraError::Target)?;
        let up = unit(camera.up).ok_or(CameraError::Up)?;
        let across = cross(forward, up);
        let right = unit(across).filter(|_| length(across) > 1e-4).ok_or(CameraError::Up)?;
        let top = cross(right, forward);
        // A pinhole has everything in focus.
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
            film_area: 4.0 * tangent * tangent * aspect,
            filter,
        })
    }

    /// Rays through the pixels of these columns and rows, one for each set of numbers; directions are of unit length.
    /// There are enough columns, rows and rays to fill the lanes.
    pub(crate) fn rays(&self, backend: Backend, pixels: &[Vec<f32>; 2], numbers: &Numbers, out: &mut RaySoA) {
        backend.run(GenerateRays { view: self, pixels, numbers, out });
    }

    /// Samples the point of the lens through which a point of the scene is seen, from two numbers in `[0, 1)`.
    #[inline(always)]
    pub fn sample_we<L: Lanes>(&self, lanes: L, from: [L::F; 3], u: [L::F; 2]) -> CameraSample<L> {
        let (zero, one) = (lanes.splat(0.0), lanes.splat(1.0));
        let [lx, ly] = disk(lanes, u);
        let lens = [lanes.splat_xyz(self.lens[0]), lanes.splat_xyz(self.lens[1])];
        let aside = add::<L>(vectors::scale::<L>(lens[0], lx), vectors::scale::<L>(lens[1], ly));
        let position = add::<L>(lanes.splat_xyz(self.position), aside);
        let toward = vectors::sub::<L>(position, from);
        let distance = vectors::dot::<L>(toward, toward).sqrt();
        let wi = vectors::scale::<L>(toward, one / distance);
        let ([x, y], cos) = self.raster(lanes, aside, vectors::neg::<L>(wi));
        let (width, height) = (lanes.splat(self.size[0]), lanes.splat(self.size[1]));
        let inside = zero.le(x) & x.lt(width) & zero.le(y) & y.lt(height);
        let (area, lens_area) = (lanes.splat(self.film_area), lanes.splat(self.lens_area()));
        CameraSample {
            wi,
            distance,
            importance: one / (area * lens_area * cos * cos * cos * cos),
            // From area on the lens to solid angle, as seen from the point.
            pdf: distance * distance / (cos * lens_area),
            raster: [x, y],
            valid: zero.lt(distance) & zero.lt(cos) & inside,
        }
    }

    /// Like [`sample_we`](View::sample_we), but `valid` also for points from which only the filter reaches into the
    /// picture.
    #[inline(always)]
    pub(crate) fn sample_we_filtered<L: Lanes>(&self, lanes: L, from: [L::F; 3], u: [L::F; 2]) -> CameraSample<L> {
        let sample = self.sample_we(lanes, from, u);
        let margin = if self.filter == Filter::Tent { 0.5 } else { 0.0 };
        let (zero, least) = (lanes.splat(0.0), lanes.splat(-margin));
        let [x, y] = sample.raster;
        let (width, height) = (lanes.splat(self.size[0] + margin), lanes.splat(self.size[1] + margin));
        let seen = least.le(x) & x.lt(width) & least.le(y) & y.lt(height);
        // The importance contains the cosine to the fourth power, so only the density shows its sign.
        CameraSample { valid: zero.lt(sample.distance) & zero.lt(sample.pdf) & seen, ..sample }
    }

    /// The density over solid angle, 1/sr, of all rays together, as if the film continued beyond the edges of the
    /// picture.
    pub(crate) fn density(&self, direction: Vec3) -> f32 {
        let cos = vec3::dot(direction, self.forward);
        if cos > 0.0 { 1.0 / (self.film_area * cos * cos * cos) } else { 0.0 }
    }

    /// The filter by which contributions are spread over pixels.
    pub(crate) fn filter(&self) -> Filter {
        self.filter
    }

    /// The densities with which a ray that begins on the lens is generated.
    pub fn pdf_we(&self, origin: [f32; 3], direction: [f32; 3]) -> CameraPdf {
        let lanes = Reference::default();
        let aside = lanes.splat_xyz(sub(origin, self.position));
        let (raster, cos) = self.raster(lanes, aside, lanes.splat_xyz(direction));
        let [x, y] = raster.map(|x| lanes.extract(x, 0));
        let cos = lanes.extract(cos, 0);
        let inside = cos > 0.0 && (0.0..self.size[0]).contains(&x) && (0.0..self.size[1]).contains(&y);
        let direction = if inside { 1.0 / (self.film_area * cos * cos * cos) } else { 0.0 };
        CameraPdf { position: 1.0 / self.lens_area(), direction }
    }

    /// The position in the picture of a ray from a point of the lens, in pixels from its upper left corner, and the
    /// cosine to the axis. `aside` leads from the centre of the lens to the point. Unspecified for a ray that goes
    /// backward.
    #[inline(always)]
    fn raster<L: Lanes>(&self, lanes: L, aside: [L::F; 3], direction: [L::F; 3]) -> ([L::F; 2], L::F) {
        let (one, half) = (lanes.splat(1.0), lanes.splat(0.5));
        let (right, top) = (lanes.splat_xyz(self.right), lanes.splat_xyz(self.top));
        let cos = vectors::dot::<L>(direction, lanes.splat_xyz(self.forward));
        // From the centre of the lens to the same point of the plane in focus, scaled to distance 1.
        let mut central = vectors::scale::<L>(direction, one / cos);
        if self.focus < f32::INFINITY {
            central = add::<L>(central, vectors::scale::<L>(aside, lanes.splat(1.0 / self.focus)));
        }
        let x = vectors::dot::<L>(central, right) / vectors::dot::<L>(right, right);
        let y = vectors::dot::<L>(central, top) / vectors::dot::<L>(top, top);
        ([half * (one + x) * lanes.splat(self.size[0]), half * (one - y) * lanes.splat(self.size[1])], cos)
    }

    /// The area of the lens; 1 for a pinhole, whose only point has density 1.
    fn lens_area(&self) -> f32 {
        let squared = vec3::dot(self.lens[0], self.lens[0]);
        if squared > 0.0 { std::f32::consts::PI * squared } else { 1.0 }
    }

    /// Positions in the picture along an axis, from -1 to 1, of pixels and numbers sampled for them.
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

struct GenerateRays<'a> {
    view: &'a View,
    pixels: &'a [Vec<f32>; 2],
    numbers: &'a Numbers,
    out: &'a mut RaySoA,
}

impl Kernel for GenerateRays<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let GenerateRays { view, pixels: [x, y], numbers, out } = self;
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
                // A focus that is not positive has been refused before, so the direction is not zero.
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

#[cfg(test)]
mod tests {
    use lobe_lane::Mask;

    use super::*;
    use crate::random::{Dimensions, Sequence};

    const SIZE: [u32; 2] = [40, 30];

    fn views() -> [View; 2] {
        [0.0, 0.1].map(|lens_radius| {
            let camera = Camera {
                position: [1.0, 2.0, 3.0],
                target: [0.0, 0.5, -1.0],
                up: [0.1, 1.0, 0.0],
                field_of_view: 1.2,
                lens_radius,
                focus_distance: Some(2.5),
            };
            View::new(&camera, SIZE, Filter::Box).unwrap()
        })
    }

    /// Rays of a view, and the positions in the picture that they pass through.
    fn generated(view: &View) -> Vec<([f32; 3], [f32; 3], [f32; 2])> {
        let pixels: Vec<[u32; 2]> = (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| [x, y])).collect();
        let mut numbers = Numbers::default();
        let backend = Backend::named("scalar").unwrap();
        numbers.sample(backend, pixels.iter().map(|&pixel| Sequence::new(pixel, 3)), Dimensions::Camera);
        let columns = [0, 1].map(|axis| pixels.iter().map(|pixel| pixel[axis] as f32).collect::<Vec<f32>>());
        let mut rays = RaySoA::default();
        for _ in &pixels {
            rays.push([0.0; 3], [0.0; 3], 0.0, f32::INFINITY);
        }
        view.rays(backend, &columns, &numbers, &mut rays);
        let ray = |i: usize| {
            let [u, v, ..] = numbers.of(i);
            let of = |columns: &[Vec<f32>; 3]| [columns[0][i], columns[1][i], columns[2][i]];
            (of(&rays.origin), of(&rays.direction), [pixels[i][0] as f32 + u, pixels[i][1] as f32 + v])
        };
        (0..pixels.len()).map(ray).collect()
    }

    #[test]
    fn importance_is_seen_where_rays_are_generated() {
        let lanes = Reference::default();
        for view in views() {
            for (origin, direction, pixel) in generated(&view) {
                let pdf = view.pdf_we(origin, direction);
                assert!(pdf.direction > 0.0 && pdf.position > 0.0);
                let aside = lanes.splat_xyz(sub(origin, view.position));
                let (raster, cos) = view.raster(lanes, aside, lanes.splat_xyz(direction));
                let raster = raster.map(|x| lanes.extract(x, 0));
                assert!((0..2).all(|k| (raster[k] - pixel[k]).abs() < 2e-3), "{raster:?}, not {pixel:?}");
                // A point on the ray sees the lens: with a pinhole, along the same ray.
                let at = |k: usize| origin[k] + 3.7 * direction[k];
                let u = [lanes.splat(0.3), lanes.splat(0.6)];
                let sample = view.sample_we(lanes, lanes.splat_xyz([at(0), at(1), at(2)]), u);
                if view.lens_area() == 1.0 {
                    assert!(sample.valid.any());
                    let raster = sample.raster.map(|x| lanes.extract(x, 0));
                    assert!((0..2).all(|k| (raster[k] - pixel[k]).abs() < 2e-3), "{raster:?}, not {pixel:?}");
                    let wi = lanes.extract_xyz(sample.wi, 0);
                    assert!((0..3).all(|k| (wi[k] + direction[k]).abs() < 1e-5), "{wi:?}, not {direction:?}");
                    // Importance times the cosine is the density of rays.
                    let expected = lanes.extract(sample.importance * cos, 0);
                    assert!((expected / (pdf.position * pdf.direction) - 1.0).abs() < 1e-4);
                }
            }
        }
    }

    #[test]
    fn importance_integrates_to_one_over_the_lens_and_all_directions() {
        let lanes = Reference::default();
        for view in views() {
            // Cosine-weighted directions about the axis, from points of the lens.
            let (n, mut density, mut importance) = (1 << 18, 0.0, 0.0);
            let frame = vectors::frame_of(lanes, lanes.splat_xyz(view.forward));
            for i in 0..n {
                let u = [0.856_674_88, 0.733_891_86, 0.628_706_7, 0.538_596_97]
                    .map(|step: f64| lanes.splat(((f64::from(i) + 0.5) * step).fract() as f32));
                let [lx, ly] = disk(lanes, [u[0], u[1]]).map(|x| lanes.extract(x, 0));
                let origin = vec3::add(view.position, vec3::add(scale(view.lens[0], lx), scale(view.lens[1], ly)));
                let local = vectors::cosine_hemisphere(lanes, [u[2], u[3]]);
                let direction = lanes.extract_xyz(vectors::to_world::<Reference>(frame, local), 0);
                let cos = f64::from(lanes.extract(local[2], 0));
                let over = std::f64::consts::PI / cos / f64::from(n);
                let pdf = view.pdf_we(origin, direction);
                density += f64::from(pdf.direction) * over;
                // The same ray, found from a point on it.
                let from = vec3::add(origin, scale(direction, 2.0));
                let sample = view.sample_we(lanes, lanes.splat_xyz(from), [u[0], u[1]]);
                if sample.valid.any() {
                    let lens_area = f64::from(view.lens_area());
                    importance += f64::from(lanes.extract(sample.importance, 0)) * cos * lens_area * over;
                    let expected = lanes.extract(sample.distance, 0).powi(2) / (cos as f32 * view.lens_area());
                    assert!((lanes.extract(sample.pdf, 0) / expected - 1.0).abs() < 1e-3);
                }
            }
            assert!((density - 1.0).abs() < 5e-3, "{density}");
            assert!((importance - 1.0).abs() < 5e-3, "{importance}");
        }
    }
}
