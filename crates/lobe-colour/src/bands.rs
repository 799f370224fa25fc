//! Which of several named bands show colour.

/// The meaning of the names of bands: the one rule for files whose channels have names only.
///
/// A name is compared in any case of letters, by its words, so that `Visible`, `VISIBLE` and `Visible (D65)` are the
/// visible band, and `Invisible` is not.
///
/// - `CIE-X`, `CIE-Z` and between them the visible band, or one called `CIE-Y`, are X, Z and Y, as window sheets for
///   Radiance have them. These are relative to a white of equal energy, X = Y = Z, so they are scaled to D65.
/// - Otherwise the visible band is grey.
/// - Without one there is no colour; pictures show the first band as grey.
///
/// Chromaticities (`CIE-u`, `CIE-v`) are not a linear map of the bands and are not used. A table that has the channels
/// X, Y, Z or wavelengths says so by its kind: such names do not get here.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NamedBands {
    /// The visible band, `CIE-Y` if there is no band called visible.
    pub visible: Option<usize>,
    /// X and Z in addition to the visible band, if both exist.
    pub x_and_z: Option<[usize; 2]>,
}

impl NamedBands {
    /// The meaning of these names. Of bands with the same meaning the first counts.
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

/// Whether the words of a name begin, somewhere, with these in their order.
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
    fn the_visible_band_is_a_word() {
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
