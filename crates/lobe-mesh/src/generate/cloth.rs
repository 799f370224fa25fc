//! Simulates a cloth as particles and the distances between them.
//!
//! Extended position-based dynamics with many small steps and one iteration each: Macklin, Müller and Chentanez, "XPBD:
//! Position-Based Simulation of Compliant Constrained Dynamics", 2016, and Macklin et al., "Small Steps in Physics
//! Simulation", 2019. Self-contact keeps particles apart, after Müller et al., "Detailed Rigid Body Simulation with
//! Extended Position Based Dynamics", 2020, and its authors' remarks on cloth.

mod contact;

use glam::DVec3;

use contact::Contacts;

/// Steps per second.
const RATE: f64 = 1200.0;
/// Steps between two searches for particles that may touch.
const SEARCH_EVERY: usize = 8;
const GRAVITY: DVec3 = DVec3::new(0.0, -9.81, 0.0);
/// Damping by the air, in 1/s: first the usual one, then the much stronger one of the last part of the fall, when the
/// cloth comes to rest.
const AIR: [f64; 2] = [0.6, 6.0];
/// The share of the fall after which damping is stronger.
const SETTLING: f64 = 0.7;
/// Friction against the sphere and the ground.
const FRICTION: f64 = 0.35;

/// Compliance of the threads: hardly any when stretched, more when the weave is sheared (in s^2/m^2, times the square
/// of the spacing, because particles of a finer cloth are lighter) and a great deal when it is bent (in s^2/m^4, times
/// the fourth power, because a distance over two cells shrinks with the square of the angle between them).
const STRETCH: f64 = 0.0;
const SHEAR: f64 = 0.04;
const BEND: f64 = 650.0;

/// The obstacles that the cloth falls on: the ground y = 0, and a sphere that rests on it at the origin.
pub(super) struct Obstacles {
    pub radius: f64,
}

/// Two particles and the distance between them at rest.
struct Link {
    ends: [u32; 2],
    length: f64,
    compliance: f64,
}

/// A square cloth.
pub(super) struct Cloth {
    positions: Vec<DVec3>,
    former: Vec<DVec3>,
    velocities: Vec<DVec3>,
    links: Vec<Link>,
    contacts: Contacts,
    /// Half the thickness of the cloth: the distance that particles keep from an obstacle.
    skin: f64,
    /// The farthest that a particle may move in a step; if it moved farther, it might slip through the cloth.
    fastest: f64,
}

impl Cloth {
    /// A cloth at rest; the positions are `n` rows of `n` particles, `spacing` apart.
    pub fn new(positions: Vec<DVec3>, n: usize, spacing: f64) -> Cloth {
        let mut links = Vec::new();
        let diagonal = spacing * 2f64.sqrt();
        let square = spacing * spacing;
        let (shear, bend) = (SHEAR * square, BEND * square * square);
        let kinds = [
            ([1, 0], spacing, STRETCH),
            ([0, 1], spacing, STRETCH),
            ([1, 1], diagonal, shear),
            ([-1, 1], diagonal, shear),
            ([2, 0], 2.0 * spacing, bend),
            ([0, 2], 2.0 * spacing, bend),
        ];
        for j in 0..n {
            for i in 0..n {
                for ([di, dj], length, compliance) in kinds {
                    let (k, l) = (i.wrapping_add_signed(di), j + dj as usize);
                    if k < n && l < n {
                        links.push(Link { ends: [(j * n + i) as u32, (l * n + k) as u32], length, compliance });
                    }
                }
            }
        }
        Cloth {
            former: positions.clone(),
            velocities: vec![DVec3::ZERO; positions.len()],
            contacts: Contacts::new(n, spacing),
            positions,
            links,
            skin: 0.5 * spacing,
            fastest: 0.2 * spacing,
        }
    }

    /// The positions of the particles.
    pub fn positions(&self) -> impl Iterator<Item = DVec3> {
        self.positions.iter().copied()
    }

    /// Lets the cloth fall for `duration` seconds.
    pub fn fall(&mut self, obstacles: &Obstacles, duration: f64) {
        let steps = (duration * RATE) as usize;
        for step in 0..steps {
            if step % SEARCH_EVERY == 0 {
                self.contacts.search(&self.positions);
            }
            let air = AIR[usize::from(step as f64 > SETTLING * steps as f64)];
            self.step(1.0 / RATE, air, step % 2 == 1, obstacles);
        }
    }

    fn step(&mut self, h: f64, air: f64, backward: bool, obstacles: &Obstacles) {
        for ((position, former), velocity) in self.positions.iter_mut().zip(&mut self.former).zip(&mut self.velocities)
        {
            *velocity = (*velocity + GRAVITY * h) / (1.0 + air * h);
            *former = *position;
            *position += (*velocity * h).clamp_length_max(self.fastest);
        }
        // Each link sees the effect of the links before it. Alternating the order keeps that from pulling to one side.
        let positions = &mut self.positions;
        let mut satisfy = |link: &Link| {
            let [a, b] = link.ends.map(|end| end as usize);
            let between = positions[b] - positions[a];
            let distance = between.length();
            let mismatch = (distance - link.length) / (2.0 + link.compliance / (h * h));
            if distance > 0.0 {
                let correction = between * (mismatch / distance);
                positions[a] += correction;
                positions[b] -= correction;
            }
        };
        if backward {
            self.links.iter().rev().for_each(&mut satisfy);
        } else {
            self.links.iter().for_each(&mut satisfy);
        }
        self.contacts.separate(&mut self.positions, &self.former);
        for ((position, former), velocity) in self.positions.iter_mut().zip(&self.former).zip(&mut self.velocities) {
            obstacles.keep_out(position, *former, self.skin);
            *velocity = (*position - *former) / h;
        }
    }
}

impl Obstacles {
    /// Moves a particle out of the sphere and the ground, and slows its sliding by friction.
    fn keep_out(&self, position: &mut DVec3, former: DVec3, skin: f64) {
        let from_centre = *position - DVec3::Y * self.radius;
        let distance = from_centre.length();
        if distance < self.radius + skin && distance > 0.0 {
            rest(position, former, from_centre / distance, self.radius + skin - distance);
        }
        if position.y < skin {
            rest(position, former, DVec3::Y, skin - position.y);
        }
    }
}

/// Moves a particle out by `depth` along `normal`. Coulomb's law: sliding is shortened by at most friction times depth.
fn rest(position: &mut DVec3, former: DVec3, normal: DVec3, depth: f64) {
    *position += normal * depth;
    let moved = *position - former;
    let slide = moved - normal * moved.dot(normal);
    let length = slide.length();
    *position -= if length <= FRICTION * depth { slide } else { slide * (FRICTION * depth / length) };
}
