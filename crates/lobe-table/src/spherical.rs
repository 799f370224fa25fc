//! Isotropic materials on uniform grids of two zenith angles and the azimuth between them.

use crate::direction::{phi, theta};
use crate::invalid::{Invalid, count, finite};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Where on an axis of `n` values over `[0, end]` the values lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Nodes {
    /// At `i / n` of the range: the end is no node.
    LowerEdge,
    /// At `(i + 1/2) / n`: the middles of equal bins.
    Middle,
    /// At `i / (n - 1)`: both ends are nodes.
    Closed,
}

impl Nodes {
    /// The nodes below and above a place in the range, and the fraction between them. Constant beyond the nodes.
    fn cell(self, place: f64, n: usize) -> ([usize; 2], f64) {
        let x = match self {
            Nodes::LowerEdge => place * n as f64,
            Nodes::Middle => place * n as f64 - 0.5,
            Nodes::Closed => place * (n - 1) as f64,
        };
        let x = x.clamp(0.0, (n - 1) as f64);
        let low = (x as usize).min(n - 1);
        ([low, (low + 1).min(n - 1)], x - low as f64)
    }
}

/// One side of an isotropic material, on a uniform grid.
///
/// `theta_in` belongs to the light and `theta_out` to the viewer, both with the same number of nodes over `[0, pi/2]`,
/// measured from the normal of the side the direction is on; `phi` is the angle between the azimuths, in `[0, pi]`.
#[derive(Clone, Debug, PartialEq)]
pub struct Spherical {
    thetas: usize,
    phis: usize,
    channels: usize,
    values: Vec<f32>,
    theta_nodes: Nodes,
    phi_nodes: Nodes,
}

impl Spherical {
    /// Checks that there are `[theta_in][theta_out][phi][channel]` values in one or three channels, and that they are
    /// finite. Values are `f` in 1/sr, without the cosine; three channels are linear RGB.
    ///
    /// # Errors
    /// [`Invalid`] names `resolution`, `type` or `data`.
    pub fn new([thetas, phis, channels]: [usize; 3], values: Vec<f32>) -> Result<Self, Invalid> {
        if thetas == 0 || phis == 0 {
            return Err(Invalid::new("resolution", format!("{thetas} thetas, {phis} phis"), "at least one of each"));
        }
        if channels != 1 && channels != 3 {
            return Err(Invalid::new("type", format!("{channels} channels"), "one or three"));
        }
        count("data", values.len(), &[thetas, thetas, phis, channels])?;
        finite("data", &values)?;
        let (theta_nodes, phi_nodes) = (Nodes::LowerEdge, Nodes::Closed);
        Ok(Spherical { thetas, phis, channels, values, theta_nodes, phi_nodes })
    }

    /// Chooses where the values lie. Without this, zenith angles are [`Nodes::LowerEdge`], azimuths [`Nodes::Closed`].
    pub fn with_nodes(mut self, theta: Nodes, phi: Nodes) -> Self {
        (self.theta_nodes, self.phi_nodes) = (theta, phi);
        self
    }

    /// Where the values lie on the zenith axes and on the azimuth axis.
    pub fn nodes(&self) -> [Nodes; 2] {
        [self.theta_nodes, self.phi_nodes]
    }

    /// The number of zenith angles, of azimuths, and of channels.
    pub fn resolution(&self) -> [usize; 3] {
        [self.thetas, self.phis, self.channels]
    }

    /// All values: `[theta_in][theta_out][phi][channel]`, in 1/sr.
    pub fn values(&self) -> &[f32] {
        &self.values
    }

    /// `f` in 1/sr for light from `wi` seen from `wo`, linear in the three angles; a single channel in all three.
    ///
    /// Only the angles to the normal count, whichever side of the surface a direction is on: see [`Sides::eval`].
    pub fn eval(&self, wi: [f64; 3], wo: [f64; 3]) -> [f64; 3] {
        let zenith = |[x, y, z]: [f64; 3]| theta([x, y, z.abs()]) / FRAC_PI_2;
        let between = (phi(wo) - phi(wi)).abs();
        let between = if between > PI { TAU - between } else { between };
        let (i, fi) = self.theta_nodes.cell(zenith(wi), self.thetas);
        let (o, fo) = self.theta_nodes.cell(zenith(wo), self.thetas);
        let (p, fp) = self.phi_nodes.cell(between / PI, self.phis);
        let mut sum = [0.0; 3];
        for corner in 0..8 {
            let pick = |axis: usize| corner >> axis & 1;
            let part = |axis: usize, t: f64| if pick(axis) == 1 { t } else { 1.0 - t };
            let at = ((i[pick(0)] * self.thetas + o[pick(1)]) * self.phis + p[pick(2)]) * self.channels;
            let weight = part(0, fi) * part(1, fo) * part(2, fp);
            for (channel, sum) in sum.iter_mut().enumerate() {
                *sum += weight * f64::from(self.values[at + channel.min(self.channels - 1)]);
            }
        }
        sum
    }
}

/// What light does that is reflected, and what it does that passes through.
#[derive(Clone, Debug, PartialEq)]
pub struct Sides {
    /// Both directions on the same side, if the file has it.
    pub reflection: Option<Spherical>,
    /// The directions on opposite sides, if the file has it.
    pub transmission: Option<Spherical>,
}

impl Sides {
    /// `f` in 1/sr, from the part that the sides of the directions choose; 0 where there is none or a direction is
    /// in the surface.
    pub fn eval(&self, wi: [f64; 3], wo: [f64; 3]) -> [f64; 3] {
        let side = wi[2] * wo[2];
        let part = if side > 0.0 { &self.reflection } else { &self.transmission };
        match part {
            Some(part) if side != 0.0 => part.eval(wi, wo),
            _ => [0.0; 3],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::direction::spherical;

    /// `100 theta_in + 10 theta_out + phi` of the node indices: linear, so that interpolation gives the place in nodes.
    fn ramp() -> Spherical {
        let value = |i: usize| (100 * (i / 15) + 10 * (i / 5 % 3) + i % 5) as f32;
        Spherical::new([3, 5, 1], (0..45).map(value).collect()).expect("a valid table")
    }

    #[test]
    fn nodes_lie_where_they_are_said_to() {
        // At 45 degrees in, 30 out, 90 between: the fractions 1/2, 1/3 and 1/2 of the axes.
        let (wi, wo) = (spherical(PI / 4.0, 0.2), spherical(PI / 6.0, 0.2 + PI / 2.0));
        for (theta, phi, expected) in [
            (Nodes::LowerEdge, Nodes::Closed, 150.0 + 10.0 + 2.0),
            (Nodes::Middle, Nodes::Middle, 100.0 + 5.0 + 2.0),
            (Nodes::Closed, Nodes::LowerEdge, 100.0 + 20.0 / 3.0 + 2.5),
        ] {
            let value = ramp().with_nodes(theta, phi).eval(wi, wo);
            assert!((value[0] - expected).abs() < 1e-9 && value == [value[0]; 3], "{theta:?} {phi:?} {value:?}");
        }
        assert_eq!(ramp().nodes(), [Nodes::LowerEdge, Nodes::Closed]);
    }

    #[test]
    fn the_last_node_reaches_to_the_horizon() {
        let value = ramp().eval(spherical(1.57, 3.0), spherical(1.57, -3.2));
        assert!((value[0] - (220.0 + 4.0 * (TAU - 6.2) / PI)).abs() < 1e-9, "{value:?}");
    }

    #[test]
    fn sides_choose_the_part() {
        let flat = |v| Some(Spherical::new([1, 1, 3], vec![v, 2.0 * v, 3.0 * v]).expect("a valid table"));
        let sides = Sides { reflection: flat(1.0), transmission: flat(5.0) };
        let (up, down) = ([0.6, 0.0, 0.8], [0.0, 0.6, -0.8]);
        assert_eq!((sides.eval(up, up), sides.eval(down, down)), ([1.0, 2.0, 3.0], [1.0, 2.0, 3.0]));
        assert_eq!((sides.eval(up, down), sides.eval(down, up)), ([5.0, 10.0, 15.0], [5.0, 10.0, 15.0]));
        assert_eq!(sides.eval(up, [1.0, 0.0, 0.0]), [0.0; 3]);
        assert_eq!(Sides { transmission: None, ..sides }.eval(up, down), [0.0; 3]);
    }

    #[test]
    fn tables_that_do_not_fit_are_named() {
        let new = |shape, n| Spherical::new(shape, vec![1.0; n]).expect_err("no table").part;
        assert_eq!(new([0, 1, 1], 0), "resolution");
        assert_eq!(new([1, 1, 2], 2), "type");
        assert_eq!(new([2, 1, 1], 3), "data");
        assert_eq!(new([usize::MAX, 2, 1], 3), "data");
    }
}
