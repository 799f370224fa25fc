//! The meaning of the channels of a value.

/// The meaning of the channels of a table.
#[derive(Clone, Debug, PartialEq)]
pub enum Channels {
    /// One value without colour.
    Mono,
    /// Linear red, green, blue; the file says no more about the primaries.
    Rgb,
    /// CIE tristimulus values X, Y, Z.
    Xyz,
    /// One channel per wavelength, in nm, in the file's order.
    Spectral(Vec<f64>),
    /// Bands that have only names, such as `Visible` and `Solar`.
    Named(Vec<String>),
}

impl Channels {
    /// The number of channels.
    pub fn count(&self) -> usize {
        match self {
            Channels::Mono => 1,
            Channels::Rgb | Channels::Xyz => 3,
            Channels::Spectral(wavelengths) => wavelengths.len(),
            Channels::Named(names) => names.len(),
        }
    }

    /// A name for each channel, in order: `Y`, or `R G B`, or `X Y Z`, or `550nm`, or its name in the file.
    pub fn names(&self) -> Vec<String> {
        match self {
            Channels::Mono => vec!["Y".into()],
            Channels::Rgb => ["R", "G", "B"].map(String::from).into(),
            Channels::Xyz => ["X", "Y", "Z"].map(String::from).into(),
            Channels::Spectral(wavelengths) => wavelengths.iter().map(|nm| format!("{nm}nm")).collect(),
            Channels::Named(names) => names.clone(),
        }
    }
}
