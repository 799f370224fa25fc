//! The channels of a measurement to what a transport applies: the one place where materials leave their own channels.

use std::fmt::Debug;

use lobe::Channels;
use lobe_colour::Reduction;

use crate::transport::{Rgb, Transport};

/// How the channels of a measurement become what a transport applies.
pub trait Conversion<T: Transport>: Debug + Send + Sync + Sized {
    /// The conversion from these channels.
    fn of(channels: &Channels) -> Self;

    /// How many channels the material has.
    fn count(&self) -> usize;

    /// The floats of `out`, if the values of the material can be written there as they are.
    fn in_place<'a>(&self, out: &'a mut [T::Scattering]) -> Option<&'a mut [f32]>;

    /// Converts `values`, `[query][channel]`.
    fn convert(&self, values: &[f32], out: &mut [T::Scattering]);
}

/// To linear sRGB, as everything that is displayed.
impl Conversion<Rgb> for Reduction {
    fn of(channels: &Channels) -> Self {
        Reduction::for_display(channels)
    }

    fn count(&self) -> usize {
        self.channels()
    }

    fn in_place<'a>(&self, out: &'a mut [[f32; 3]]) -> Option<&'a mut [f32]> {
        self.is_identity().then_some(out.as_flattened_mut())
    }

    fn convert(&self, values: &[f32], out: &mut [[f32; 3]]) {
        self.apply_batch(values, out);
    }
}
