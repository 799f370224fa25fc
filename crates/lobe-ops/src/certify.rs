//! The error of a file that was converted from another one.

use lobe::Backend;
use lobe_colour::NoColour;
use lobe_formats::ENDS;
use lobe_table::{Bsdf, Channels, Directions, Scatter, Side};
use serde::Serialize;
use thiserror::Error;

use crate::compare::{Difference, difference};
use crate::pairs::eval_pairs;
use crate::{Aspect, OnBackend, Subject, direction_pairs};

/// The number of pairs of directions of [`certify`], and the default of `lobe compare`.
pub const PAIRS: usize = 100_000;
/// The largest polar angle of both directions in degrees, likewise.
pub const LIMIT: f64 = 85.0;

/// The difference of one measurement.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Certified {
    /// The measurement that was compared.
    #[serde(serialize_with = "in_words")]
    pub aspect: Aspect,
    /// The difference between source and file.
    pub difference: Difference,
}

fn in_words<S: serde::Serializer>(aspect: &Aspect, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_str(aspect)
}

/// Why a file cannot be compared with its source.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum Incomparable {
    /// The sides and kinds of scatter differ.
    #[error("the file has none of the measurements of the source")]
    Aspects,
    /// One of them does not have the channel.
    #[error("the file has no channel {0}")]
    Channel(String),
    /// The channels differ, and those of one have no colour.
    #[error(transparent)]
    Colour(#[from] NoColour),
}

/// Compares the measurements that both files have, at `pairs` pairs of directions up to [`LIMIT`]: the first ones of a
/// fixed sequence ([`direction_pairs`]), which are the nodes of no grid. If `channel` names a
/// channel of the source, only this one is compared, as [`Channel::of`] finds it in both.
///
/// # Errors
/// [`Incomparable`] if they have no measurement, or no such channel, in common, or no colour in which different channels
/// could be compared. So there is at least one difference.
pub fn certify(
    source: &Subject,
    written: &Subject,
    channel: Option<&str>,
    pairs: usize,
) -> Result<Vec<Certified>, Incomparable> {
    let theirs = written.aspects();
    let mut aspects: Vec<Aspect> = source.aspects().into_iter().filter(|aspect| theirs.contains(aspect)).collect();
    aspects.dedup();
    if aspects.is_empty() {
        return Err(Incomparable::Aspects);
    }
    let [a, b] = [source, written].map(|subject| OnBackend::from(&subject.material));
    let picked = match channel {
        None => None,
        Some(name) => match (Channel::of(a, name), Channel::of(b, name)) {
            (Some(a), Some(b)) => Some((a, b)),
            _ => return Err(Incomparable::Channel(name.into())),
        },
    };
    let limit = LIMIT.to_radians();
    let certified = |aspect: Aspect| {
        let difference = match &picked {
            Some((a, b)) => difference(a, b, aspect, limit, pairs)?,
            None => difference(a, b, aspect, limit, pairs)?,
        };
        Ok(Certified { aspect, difference })
    };
    aspects.into_iter().map(certified).collect()
}

/// The largest of the relative differences (root mean square).
pub fn worst(certified: &[Certified]) -> f64 {
    certified.iter().map(|of_aspect| of_aspect.difference.relative_rms).fold(0.0, f64::max)
}

/// One channel of a material.
#[derive(Debug)]
pub struct Channel<'a> {
    scattering: OnBackend<'a>,
    index: usize,
}

impl<'a> Channel<'a> {
    /// The channel of this name, ignoring case, or the only one, which may have been written as [`ENDS`], or as R, G
    /// and B that are equal everywhere; `None` if there is neither.
    pub fn of(scattering: impl Into<OnBackend<'a>>, name: &str) -> Option<Self> {
        let scattering = scattering.into();
        let names = scattering.channels().names();
        let index = names.iter().position(|known| known.eq_ignore_ascii_case(name));
        let is_one = names.len() == 1 || *scattering.channels() == Channels::Spectral(ENDS.into());
        let index = index.or_else(|| (is_one || is_grey(scattering)).then_some(0))?;
        Some(Channel { scattering, index })
    }
}

/// `true` if R, G and B are equal wherever there are values, except for rounding.
fn is_grey(scattering: OnBackend<'_>) -> bool {
    /// Half of them are near the mirror direction.
    const PAIRS: usize = 4096;
    const ROUNDING: f32 = 1e-5;
    if *scattering.channels() != Channels::Rgb {
        return false;
    }
    let pairs = direction_pairs(PAIRS, LIMIT.to_radians());
    let is_equal = |texel: &[f32]| texel.iter().all(|f| (f - texel[0]).abs() <= ROUNDING * texel[0].abs());
    let sides = [Side::Front, Side::Back];
    let aspects = [Scatter::Reflection, Scatter::Transmission]
        .into_iter()
        .flat_map(|scatter| sides.map(|light| Aspect { scatter, light }))
        .filter(|aspect| scattering.bsdf.holds(*aspect));
    let mut values = aspects.map(|aspect| {
        let placed: Vec<_> = pairs.iter().map(|&(wi, wo)| aspect.place(wi, wo)).collect();
        eval_pairs(scattering, &placed)
    });
    values.all(|values| values.chunks_exact(3).all(is_equal))
}

impl<'a> From<&'a Channel<'_>> for OnBackend<'a> {
    fn from(channel: &'a Channel<'_>) -> Self {
        OnBackend::new(channel, channel.scattering.backend)
    }
}

impl Bsdf for Channel<'_> {
    fn channels(&self) -> &Channels {
        &Channels::Mono
    }

    fn holds(&self, aspect: Aspect) -> bool {
        self.scattering.bsdf.holds(aspect)
    }

    fn eval_batch(&self, backend: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) {
        let count = self.scattering.channels().count();
        let mut values = vec![0.0; wi.count() * count];
        self.scattering.bsdf.eval_batch(backend, wi, wo, &mut values);
        out.iter_mut().zip(values.iter().skip(self.index).step_by(count)).for_each(|(out, value)| *out = *value);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::Exact;
    use lobe_model::Lambert;

    #[test]
    fn a_channel_is_found_by_name_or_as_the_only_one() {
        let index = |albedo: [f64; 3], name: &str| {
            let lambert = Exact(Lambert { albedo });
            Channel::of(&lambert, name).map(|channel| channel.index)
        };
        assert_eq!(index([0.1, 0.2, 0.3], "g"), Some(1));
        assert_eq!(index([0.1, 0.2, 0.3], "360nm"), None);
        assert_eq!(index([0.2, 0.2, 0.2001], "360nm"), None);
        assert_eq!(index([0.2, 0.2, 0.2 + 1e-7], "360nm"), Some(0));
    }
}
