//! Queues of rays, each with the state of its path.

use lobe_trace::{HitSoA, MISS, RaySoA};

use crate::vec3::Vec3;

/// Origin and direction of a ray.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ray {
    pub origin: Vec3,
    pub direction: Vec3,
}

/// Rays that begin at `t` 0, each with a state.
#[derive(Debug)]
pub(crate) struct RayQueue<T> {
    pub rays: RaySoA,
    pub states: Vec<T>,
}

impl<T> Default for RayQueue<T> {
    fn default() -> Self {
        RayQueue { rays: RaySoA::default(), states: Vec::new() }
    }
}

impl<T: Copy> RayQueue<T> {
    /// Removes all rays but keeps the memory.
    pub fn clear(&mut self) {
        fill(&mut self.rays, 0);
        self.states.clear();
    }

    pub fn len(&self) -> usize {
        self.states.len()
    }

    pub fn is_empty(&self) -> bool {
        self.states.is_empty()
    }

    /// Origin and direction of a ray.
    pub fn ray(&self, ray: usize) -> Ray {
        Ray { origin: self.rays.origin.each_ref().map(|component| component[ray]), direction: self.direction(ray) }
    }

    /// The direction of a ray.
    pub fn direction(&self, ray: usize) -> Vec3 {
        self.rays.direction.each_ref().map(|component| component[ray])
    }

    /// Adds a ray.
    pub fn push(&mut self, Ray { origin, direction }: Ray, t_max: f32, state: T) {
        self.rays.push(origin, direction, 0.0, t_max);
        self.states.push(state);
    }

    /// Adds at most `more` rays: those that `write` keeps.
    #[inline(always)]
    pub fn extend(&mut self, more: usize, write: impl FnOnce(&mut Room<'_, T>)) {
        let begin = self.len();
        // One more, to be overwritten.
        let more = more + 1;
        fill(&mut self.rays, begin + more);
        let RaySoA { origin, direction, t_max, .. } = &mut self.rays;
        let mut room = Room {
            origin: origin.each_mut().map(|column| &mut column[begin..][..more]),
            direction: direction.each_mut().map(|column| &mut column[begin..][..more]),
            t_max: &mut t_max[begin..][..more],
            states: &mut self.states,
            begin,
            count: 0,
        };
        write(&mut room);
        let kept = begin + room.count;
        self.states.truncate(kept);
        fill(&mut self.rays, kept);
    }
}

/// Room for rays, written one after another.
pub(crate) struct Room<'a, T> {
    origin: [&'a mut [f32]; 3],
    direction: [&'a mut [f32]; 3],
    t_max: &'a mut [f32],
    states: &'a mut Vec<T>,
    begin: usize,
    count: usize,
}

impl<T: Copy> Room<'_, T> {
    /// Writes a ray. One that is not kept is overwritten by the next: a branch would be unpredictable.
    #[inline(always)]
    pub fn write(&mut self, Ray { origin, direction }: Ray, t_max: f32, state: T, keep: bool) {
        for axis in 0..3 {
            self.origin[axis][self.count] = origin[axis];
            self.direction[axis][self.count] = direction[axis];
        }
        self.t_max[self.count] = t_max;
        self.states.truncate(self.begin + self.count);
        self.states.push(state);
        self.count += usize::from(keep);
    }
}

/// Resizes to `n` rays; added rays have no end, and arbitrary origins and directions.
pub(super) fn fill(rays: &mut RaySoA, n: usize) {
    let RaySoA { origin, direction, t_min, t_max } = rays;
    origin.iter_mut().chain(direction).chain([t_min]).for_each(|column| column.resize(n, 0.0));
    t_max.resize(n, f32::INFINITY);
}

/// Makes room for the hits of `n` rays.
pub(super) fn fit(hits: &mut HitSoA, n: usize) {
    let HitSoA { t, u, v, primitive, instance } = hits;
    [t, u, v].into_iter().for_each(|column| column.resize(n, 0.0));
    [primitive, instance].into_iter().for_each(|column| column.resize(n, MISS));
}
