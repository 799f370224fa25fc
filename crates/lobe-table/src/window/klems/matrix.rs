//! Bases and matrices as measured.

use crate::Kind;
use thiserror::Error;

/// The name of the representation.
pub const KIND: Kind = Kind::new("Klems matrices");

/// Rings that cannot form a basis, or values that cannot form a matrix.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum KlemsError {
    /// A basis without rings.
    #[error("no rings; expected at least one")]
    NoRings,
    /// A ring whose bounds do not continue the ring before, or that leaves `[0, 90]` degrees.
    #[error("ring {index} spans {lower} to {upper} degrees; expected it to start at {start} and to end by 90")]
    Bounds {
        /// Position of the ring.
        index: usize,
        /// Its lower bound in degrees.
        lower: f64,
        /// Its upper bound in degrees.
        upper: f64,
        /// The upper bound of the ring before, in degrees.
        start: f64,
    },
    /// A ring without patches, or a basis with more of them than an index can count.
    #[error("ring {index} has {patches} patches; expected 1 to {}", u16::MAX)]
    Patches {
        /// Position of the ring.
        index: usize,
        /// What was found.
        patches: u32,
    },
    /// The value count is not the product of the two patch counts.
    #[error("{found} values; expected {expected} = incident patches x exit patches")]
    ValueCount {
        /// What was found.
        found: usize,
        /// What the bases require.
        expected: usize,
    },
    /// A value that is NaN or infinite.
    #[error("value {index} is {value}; expected a finite number")]
    ValueNotFinite {
        /// Position in the value array.
        index: usize,
        /// What was found.
        value: f32,
    },
}

/// One ring of a basis. Its bounds are in degrees, as in all files and tables of bases.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ring {
    /// Lower bound of the polar angle, in degrees; it belongs to the ring.
    pub lower: f64,
    /// Upper bound of the polar angle, in degrees; it belongs to the next ring.
    pub upper: f64,
    /// The number of equal sectors of azimuth in the ring.
    pub patches: u32,
}

/// A partition of a hemisphere into patches, counted ring by ring from the pole.
#[derive(Clone, Debug, PartialEq)]
pub struct AngleBasis {
    pub(super) name: String,
    pub(super) rings: Vec<Ring>,
    pub(super) patches: usize,
}

/// The largest difference, in degrees, between two bounds that count as the same.
pub(super) const SAME_BOUND: f64 = 1e-3;

impl AngleBasis {
    /// Checks that the rings follow each other from 0 to at most 90 degrees and stores them.
    ///
    /// # Errors
    /// [`KlemsError`] names the ring.
    pub fn new(name: impl Into<String>, rings: Vec<Ring>) -> Result<Self, KlemsError> {
        if rings.is_empty() {
            return Err(KlemsError::NoRings);
        }
        let (mut start, mut patches) = (0.0, 0_usize);
        for (index, ring) in rings.iter().enumerate() {
            let Ring { lower, upper, patches: count } = *ring;
            let follows = (lower - start).abs() <= SAME_BOUND && upper > lower && upper <= 90.0 + SAME_BOUND;
            if !follows {
                return Err(KlemsError::Bounds { index, lower, upper, start });
            }
            start = upper;
            patches += count as usize;
            if count == 0 || patches > usize::from(u16::MAX) {
                return Err(KlemsError::Patches { index, patches: count });
            }
        }
        Ok(AngleBasis { name: name.into(), rings, patches })
    }

    /// The basis of 145 patches, `LBNL/Klems Full`.
    pub fn full() -> Self {
        let counts = [1, 8, 16, 20, 24, 24, 24, 16, 12];
        Self::standard("LBNL/Klems Full", &[0.0, 5.0, 15.0, 25.0, 35.0, 45.0, 55.0, 65.0, 75.0, 90.0], &counts)
    }

    /// The basis of 77 patches, `LBNL/Klems Half`.
    pub fn half() -> Self {
        let counts = [1, 8, 12, 16, 20, 12, 8];
        Self::standard("LBNL/Klems Half", &[0.0, 6.5, 19.5, 32.5, 45.5, 58.5, 71.5, 90.0], &counts)
    }

    /// The basis of 41 patches, `LBNL/Klems Quarter`.
    pub fn quarter() -> Self {
        Self::standard("LBNL/Klems Quarter", &[0.0, 9.0, 27.0, 45.0, 63.0, 90.0], &[1, 8, 12, 12, 8])
    }

    fn standard(name: &str, bounds: &[f64], counts: &[u32]) -> Self {
        let ring = |(bounds, &patches): (&[f64], &u32)| Ring { lower: bounds[0], upper: bounds[1], patches };
        let rings = bounds.windows(2).zip(counts).map(ring).collect();
        AngleBasis { name: name.into(), rings, patches: counts.iter().map(|&n| n as usize).sum() }
    }

    /// The name by which files refer to the basis.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The rings, from the pole to the horizon.
    pub fn rings(&self) -> &[Ring] {
        &self.rings
    }

    /// The number of patches; at least one.
    pub fn patches(&self) -> usize {
        self.patches
    }

    /// The solid angle of a patch projected onto the surface, in sr: `pi (cos^2 lower - cos^2 upper) / patches`.
    ///
    /// # Panics
    /// If `patch` is not below [`patches`](Self::patches).
    pub fn projected_solid_angle(&self, patch: usize) -> f64 {
        assert!(patch < self.patches, "patch {patch} of a basis with {}", self.patches);
        let mut end = 0;
        let ring = self.rings.iter().find(|ring| {
            end += ring.patches as usize;
            patch < end
        });
        ring.map_or(0.0, |Ring { lower, upper, patches }| {
            let cos2 = |degrees: &f64| degrees.to_radians().cos().powi(2);
            std::f64::consts::PI * (cos2(lower) - cos2(upper)) / f64::from(*patches)
        })
    }
}

/// A BSDF on pairs of patches: one value for light that arrives through one patch and leaves through another.
///
/// Values are `f` in 1/sr, without the cosine, `[incident patch][exit patch]`. The incident patch is found by the
/// direction in which light *travels*, so that equal indices mean the straight-through ray, or the mirrored one.
#[derive(Clone, Debug, PartialEq)]
pub struct KlemsMatrix {
    pub(super) incident: AngleBasis,
    pub(super) exit: AngleBasis,
    pub(super) values: Vec<f32>,
}

impl KlemsMatrix {
    /// Checks the number of values and stores them.
    ///
    /// # Errors
    /// [`KlemsError::ValueCount`] and [`KlemsError::ValueNotFinite`].
    pub fn new(incident: AngleBasis, exit: AngleBasis, values: Vec<f32>) -> Result<Self, KlemsError> {
        let expected = incident.patches * exit.patches;
        if values.len() != expected {
            return Err(KlemsError::ValueCount { found: values.len(), expected });
        }
        if let Some(index) = values.iter().position(|v| !v.is_finite()) {
            return Err(KlemsError::ValueNotFinite { index, value: values[index] });
        }
        Ok(KlemsMatrix { incident, exit, values })
    }

    /// The basis of the side from which light arrives.
    pub fn incident(&self) -> &AngleBasis {
        &self.incident
    }

    /// The basis of the side to which light leaves.
    pub fn exit(&self) -> &AngleBasis {
        &self.exit
    }

    /// All values, `[incident patch][exit patch]`, in 1/sr.
    pub fn values(&self) -> &[f32] {
        &self.values
    }

    /// The share of the light arriving through `incident` that is scattered: the sum of `f` times projected solid
    /// angle.
    ///
    /// # Panics
    /// If `incident` is not a patch of the incident basis.
    pub fn albedo(&self, incident: usize) -> f64 {
        let row = &self.values[incident * self.exit.patches..][..self.exit.patches];
        row.iter().enumerate().map(|(exit, &f)| f64::from(f) * self.exit.projected_solid_angle(exit)).sum()
    }
}
