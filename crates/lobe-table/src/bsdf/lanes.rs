//! Functions of pairs of directions, for use inside the caller's own kernel.

use lobe_lane::Lanes;

use crate::specular;

/// A function of pairs of directions that can be evaluated a pair per lane, without leaving the caller's kernel.
///
/// It is for programs that know their type when they are compiled; the conventions are those of [`Bsdf`](super::Bsdf).
pub trait BsdfLanes: Sync {
    /// The number of channels of a value.
    fn channel_count(&self) -> usize;

    /// The value of a pair in each lane, one number per channel; 0 in the lanes that `mask` leaves out.
    ///
    /// # Panics
    /// If the length of `out` is not the number of channels.
    fn eval_lanes<L: Lanes>(&self, lanes: L, wi: [L::F; 3], wo: [L::F; 3], mask: L::M, out: &mut [L::F]);
}

impl BsdfLanes for specular::Table {
    fn channel_count(&self) -> usize {
        specular::Table::channel_count(self)
    }

    #[inline(always)]
    fn eval_lanes<L: Lanes>(&self, lanes: L, wi: [L::F; 3], wo: [L::F; 3], mask: L::M, out: &mut [L::F]) {
        specular::Table::eval_lanes(self, lanes, wi, wo, mask, out);
    }
}
