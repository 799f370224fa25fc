//! Batches of rays and hits, one array per component.

/// A batch of rays. A ray is `origin + t direction` for `t` in the closed interval `[t_min, t_max]`; the direction may
/// have any length, which is the unit of `t`. A ray with a NaN anywhere, an empty interval, a zero direction, or
/// numbers beyond [`LIMIT`](crate::LIMIT) hits nothing. All arrays have one entry per ray.
#[derive(Clone, Debug, Default)]
pub struct RaySoA {
    /// Origins: all x, all y, all z.
    pub origin: [Vec<f32>; 3],
    /// Directions: all x, all y, all z.
    pub direction: [Vec<f32>; 3],
    /// The t at which the rays begin.
    pub t_min: Vec<f32>,
    /// The t at which the rays end; may be infinite.
    pub t_max: Vec<f32>,
}

impl RaySoA {
    /// No rays yet, with space for `capacity`.
    pub fn with_capacity(capacity: usize) -> Self {
        let make = || Vec::with_capacity(capacity);
        RaySoA { origin: [make(), make(), make()], direction: [make(), make(), make()], t_min: make(), t_max: make() }
    }

    /// Adds a ray.
    #[inline]
    pub fn push(&mut self, origin: [f32; 3], direction: [f32; 3], t_min: f32, t_max: f32) {
        for axis in 0..3 {
            self.origin[axis].push(origin[axis]);
            self.direction[axis].push(direction[axis]);
        }
        self.t_min.push(t_min);
        self.t_max.push(t_max);
    }

    /// The number of rays.
    pub fn len(&self) -> usize {
        self.t_min.len()
    }

    /// `true` if there are no rays.
    pub fn is_empty(&self) -> bool {
        self.t_min.is_empty()
    }

    /// All of them, borrowed.
    ///
    /// # Panics
    /// If the arrays differ in length.
    pub fn view(&self) -> Rays<'_> {
        let n = self.len();
        let all = self.origin.iter().chain(&self.direction).chain([&self.t_max]);
        assert!(all.into_iter().all(|component| component.len() == n), "components of a batch differ in length");
        Rays {
            origin: self.origin.each_ref().map(Vec::as_slice),
            direction: self.direction.each_ref().map(Vec::as_slice),
            t_min: &self.t_min,
            t_max: &self.t_max,
        }
    }
}

/// Part of a batch of rays.
#[derive(Clone, Copy, Debug)]
pub struct Rays<'a> {
    pub(crate) origin: [&'a [f32]; 3],
    pub(crate) direction: [&'a [f32]; 3],
    pub(crate) t_min: &'a [f32],
    pub(crate) t_max: &'a [f32],
}

impl<'a> Rays<'a> {
    /// The number of rays.
    pub fn len(&self) -> usize {
        self.t_min.len()
    }

    /// `true` if there are no rays.
    pub fn is_empty(&self) -> bool {
        self.t_min.is_empty()
    }

    /// The first `n` rays, and the rest.
    ///
    /// # Panics
    /// If there are fewer.
    pub fn split_at(self, n: usize) -> (Self, Self) {
        let cut = |range: std::ops::Range<usize>| Rays {
            origin: self.origin.map(|x| &x[range.clone()]),
            direction: self.direction.map(|x| &x[range.clone()]),
            t_min: &self.t_min[range.clone()],
            t_max: &self.t_max[range.clone()],
        };
        (cut(0..n), cut(n..self.len()))
    }
}

/// The primitive and instance of a ray that hits nothing.
pub const MISS: i32 = -1;

/// The nearest hits of a batch. If a ray hits nothing, `primitive` and `instance` are [`MISS`], `t` is infinite and
/// `u` and `v` are zero.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HitSoA {
    /// The position along the ray, in lengths of its direction.
    pub t: Vec<f32>,
    /// Weight of the triangle's second vertex.
    pub u: Vec<f32>,
    /// Weight of the triangle's third vertex; the first has `1 - u - v`.
    pub v: Vec<f32>,
    /// The triangle's number in its mesh, or [`MISS`].
    pub primitive: Vec<i32>,
    /// The instance's number in the scene, or [`MISS`].
    pub instance: Vec<i32>,
}

impl HitSoA {
    /// Space for the hits of `n` rays.
    pub fn new(n: usize) -> Self {
        HitSoA { t: vec![0.0; n], u: vec![0.0; n], v: vec![0.0; n], primitive: vec![MISS; n], instance: vec![MISS; n] }
    }

    /// All of them, borrowed for writing.
    ///
    /// # Panics
    /// If the arrays differ in length.
    pub fn view(&mut self) -> Hits<'_> {
        let n = self.t.len();
        let lengths = [self.u.len(), self.v.len(), self.primitive.len(), self.instance.len()];
        assert!(lengths.iter().all(|&length| length == n), "components of a batch differ in length");
        Hits {
            t: &mut self.t,
            u: &mut self.u,
            v: &mut self.v,
            primitive: &mut self.primitive,
            instance: &mut self.instance,
        }
    }
}

/// Space for part of a batch of hits.
#[derive(Debug)]
pub struct Hits<'a> {
    pub(crate) t: &'a mut [f32],
    pub(crate) u: &'a mut [f32],
    pub(crate) v: &'a mut [f32],
    pub(crate) primitive: &'a mut [i32],
    pub(crate) instance: &'a mut [i32],
}

impl Hits<'_> {
    /// The number of hits that fit.
    pub fn len(&self) -> usize {
        self.t.len()
    }

    /// `true` if none fit.
    pub fn is_empty(&self) -> bool {
        self.t.is_empty()
    }

    /// The first `n`, and the rest.
    ///
    /// # Panics
    /// If there are fewer.
    pub fn split_at(self, n: usize) -> (Self, Self) {
        let (t, u, v) = (self.t.split_at_mut(n), self.u.split_at_mut(n), self.v.split_at_mut(n));
        let (primitive, instance) = (self.primitive.split_at_mut(n), self.instance.split_at_mut(n));
        (
            Hits { t: t.0, u: u.0, v: v.0, primitive: primitive.0, instance: instance.0 },
            Hits { t: t.1, u: u.1, v: v.1, primitive: primitive.1, instance: instance.1 },
        )
    }
}
