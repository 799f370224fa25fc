//! The colour of named bands.

/// The meaning of the names of bands: the one rule for files whose channels have only names.
///
/// A name is compared word by word, in upper or lower case, so that `Visible`, `VISIBLE` and `Visible (D65)` are the
/// visible band, and `Invisible` is not.
///
/// - `CIE-X`, the visible band or one called `CIE-Y`, and `CIE-Z` are X, Y and Z, as in window sheets for Radiance.
///   These are relative to an equal-energy white, X = Y = Z, so they are scaled to D65.
/// - Otherwise the visible band is grey.
/// - Without a visible band, there is no colour; pictures show the first band as grey.
///
/// Chromaticities (`CIE-u`, `CIE-v`) are not a linear map of the bands and are not used. Tables with the channels X, Y,
/// Z or wavelengths say so by their kind, and their names are not treated here.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NamedBands {
    /// The visible band, `CIE-Y` if there is no band called visible.
    pub visible: Option<usize>,
    /// X and Z in addition to the visible band, if both exist.
    pub x_and_z: Option<[usize; 2]>,
}

impl NamedBands {
    /// The meaning of these names. Of several bands with the same meaning, the first counts.
    pub fn new(names: &[String]) -> Self {
        let find = |wanted: &[&str]| names.iter().position(|name| has_words(name, wanted));
        let visible = find(&["visible"]).or_else(|| find(&["cie", "y"]));
        let x_and_z = match (visible, find(&["cie", "x"]), find(&["cie", "z"])) {
            (Some(_), Some(x), Some(z)) => Some([x, z]),
            _ => None,
        };
        NamedBands { visible, x_and_z }
    }
}

/// `true` if a name contains these words in this order, one after the other.
fn has_words(name: &str, wanted: &[&str]) -> bool {
    let name = name.to_lowercase();
    let words: Vec<&str> = name.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty()).collect();
    words.windows(wanted.len()).any(|words| words == wanted)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(names: &[&str]) -> NamedBands {
        NamedBands::new(&names.iter().map(|&name| name.into()).collect::<Vec<_>>())
    }

    #[test]
    fn the_visible_band_is_recognised_by_word() {
        for name in ["Visible", "VISIBLE", " visible ", "Visible (D65)", "integral-visible"] {
            assert_eq!(of(&["Solar", name]).visible, Some(1), "{name}");
        }
        assert_eq!(of(&["Invisible", "Solar", "visibles"]).visible, None);
        assert_eq!(of(&["NIR", "CIE-Y"]).visible, Some(1));
        assert_eq!(of(&["CIE-Y", "Visible"]).visible, Some(1));
        assert_eq!(of(&[]), NamedBands { visible: None, x_and_z: None });
    }

    #[test]
    fn colour_needs_x_y_and_z() {
        assert_eq!(of(&["Solar", "CIE-X", "Visible", "CIE-Z"]), NamedBands { visible: Some(2), x_and_z: Some([1, 3]) });
        assert_eq!(of(&["cie-z", "cie-y", "cie-x"]), NamedBands { visible: Some(1), x_and_z: Some([2, 0]) });
        assert_eq!(of(&["CIE-X", "Visible"]).x_and_z, None);
        assert_eq!(of(&["Visible", "CIE-u", "CIE-v"]), NamedBands { visible: Some(0), x_and_z: None });
    }
}
