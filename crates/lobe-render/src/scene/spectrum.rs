//! `[spectrum]`: the wavelengths of a picture, and whether light is polarised. Also reads spectra in place of colours.

use std::path::Path;
use std::sync::Arc;

use lobe_spectrum::{Bands, Illuminant, Spectrum};

use super::Reading;
use super::node::{Node, SceneError};
use crate::integrator::{AnyTransport, SPECTRAL};
use crate::transport::Transport;

/// The kind of light that is followed.
pub(super) struct Wanted {
    /// The wavelengths; `None` for red, green and blue.
    pub bands: Option<Arc<Bands>>,
    /// `true` if light is polarised.
    pub stokes: bool,
    /// `true` if the film sums the energy of polarised light alone.
    pub counts_energy: bool,
}

/// The largest number of wavelengths of polarised light.
const POLARISED: usize = 16;

/// Reads the table; `None` if there is none, so that red, green and blue are followed.
pub(super) fn read(root: &Node<'_, '_>) -> Result<Option<Wanted>, SceneError> {
    let Some(node) = root.child("spectrum")? else { return Ok(None) };
    let stokes = node.flag("stokes")?;
    let counts_energy = match node.text("sensor")? {
        None | Some("stokes") => false,
        Some("energy") => true,
        Some(found) => return Err(node.error("sensor", format!("found `{found}`; expected stokes or energy"))),
    };
    if node.has("sensor") && !stokes {
        return Err(node.error("sensor", "found a sensor of unpolarised light; expected `stokes = true` with it"));
    }
    let count = node.whole("bands", 2..=32)?;
    let wavelengths = node.numbers("wavelengths", "wavelengths in nm, such as [450, 550, 650]")?;
    let (key, bands) = match (count, wavelengths) {
        (Some(_), Some(_)) => return Err(node.error("", "found two keys; expected either `bands` or `wavelengths`")),
        (None, None) if stokes => ("", None),
        (None, None) => ("", Some(Bands::uniform(16))),
        (Some(count), None) => ("bands", Some(Bands::uniform(count as usize))),
        (None, Some(wavelengths)) => ("wavelengths", Some(Bands::new(wavelengths))),
    };
    let bands = bands.transpose().map_err(|error| node.error(key, error.to_string()))?;
    if let Some(bands) = bands.as_ref().filter(|bands| stokes && bands.count() > POLARISED) {
        let message = format!("found {} wavelengths; expected at most {POLARISED} for polarised light", bands.count());
        return Err(node.error(key, message));
    }
    node.finish()?;
    Ok(Some(Wanted { bands: bands.map(Arc::new), stokes, counts_energy }))
}

/// The integrator and the samples per pixel.
pub(super) fn integrator(root: &Node<'_, '_>, named: Option<&str>) -> Result<(Arc<dyn AnyTransport>, u32), SceneError> {
    const SAMPLES: u32 = 64;
    let names: Vec<&str> = SPECTRAL.iter().map(|spec| spec.name).collect();
    let find = |name: &str| SPECTRAL.iter().find(|spec| spec.name == name);
    let refused = |name: &str| format!("found `{name}`; expected {} for a picture with [spectrum]", names.join(" or "));
    let chosen = match named {
        Some(name) => Some(find(name).ok_or_else(|| root.error("integrator", refused(name)))?),
        None => None,
    };
    let Some(node) = root.child("integrator")? else {
        return Ok(((chosen.unwrap_or(&SPECTRAL[0]).default)(), SAMPLES));
    };
    let kind = node.text("kind")?.unwrap_or(SPECTRAL[0].name);
    let spec = find(kind);
    let samples = node.whole("samples", 1..=u32::MAX - 1)?.unwrap_or(SAMPLES);
    if let Some(chosen) = chosen {
        return Ok(((chosen.default)(), samples));
    }
    let Some(spec) = spec else { return Err(node.error("kind", refused(kind))) };
    let integrator = (spec.read)(&node)?;
    node.finish()?;
    Ok((integrator, samples))
}

impl<T: Transport> Reading<'_, T> {
    /// Light: a colour; or, with `spectrum` or `temperature`, a number that scales a spectrum. A standard illuminant or
    /// a black body gets this luminance; the numbers of a file are multiplied by it.
    pub(super) fn light(&self, node: &Node<'_, '_>, key: &str) -> Result<Option<T::Spectrum>, SceneError> {
        let basis = self.world.basis();
        let kelvin =
            node.number("temperature", "a temperature from 500 to 100000 K", |x| (500.0..=1e5).contains(&x))?;
        let (of, spectrum, is_file) = match (node.text("spectrum")?, kelvin) {
            (None, None) => return Ok(node.colour(key, f64::MAX)?.map(|rgb| T::emission(basis, rgb))),
            (Some(_), Some(_)) => {
                return Err(node.error("spectrum", "found two keys; expected either `spectrum` or `temperature`"));
            }
            (None, Some(kelvin)) => {
                let spectrum = Spectrum::black_body(kelvin);
                ("temperature", spectrum.map_err(|error| node.error("temperature", error.to_string()))?, false)
            }
            (Some(name), None) => match Illuminant::named(name) {
                Some(illuminant) => ("spectrum", illuminant.spectrum(), false),
                None => ("spectrum", self.spectrum(node, "spectrum", name)?, true),
            },
        };
        let number = "a number that is not negative, by which the spectrum is scaled";
        let Some(scale) = node.number(key, number, |x| (0.0..1e30).contains(&x))? else {
            let message = format!("found a spectrum without `{key}`; expected {number}");
            return Err(node.error(of, message));
        };
        if !is_file {
            return Ok(Some(T::light(basis, &spectrum, Some(scale))));
        }
        let mut light = T::light(basis, &spectrum, None);
        light.as_mut().iter_mut().for_each(|x| *x *= scale as f32);
        Ok(Some(light))
    }

    /// Light that is required.
    pub(super) fn required_light(&self, node: &Node<'_, '_>, key: &str) -> Result<T::Spectrum, SceneError> {
        let light = self.light(node, key)?;
        light.ok_or_else(|| node.error(key, "found nothing; expected a colour, three numbers or one"))
    }

    /// A share of light: a colour, or the name of a file with a spectrum from 0 to 1.
    pub(super) fn share(&self, node: &Node<'_, '_>, key: &str) -> Result<Option<T::Spectrum>, SceneError> {
        let basis = self.world.basis();
        if !node.is_text(key) {
            return Ok(node.colour(key, 1.0)?.map(|rgb| T::reflectance(basis, rgb)));
        }
        let Some(name) = node.text(key)? else { return Ok(None) };
        let spectrum = self.spectrum(node, key, name)?;
        match spectrum.values().iter().find(|value| **value > 1.0) {
            Some(value) => {
                Err(node.error(key, format!("found the share {value} in `{name}`; expected shares up to 1")))
            }
            None => Ok(Some(T::reflectance_of(basis, &spectrum))),
        }
    }

    /// A share of light that is required.
    pub(super) fn required_share(&self, node: &Node<'_, '_>, key: &str) -> Result<T::Spectrum, SceneError> {
        let share = self.share(node, key)?;
        share.ok_or_else(|| node.error(key, "found nothing; expected a colour, three numbers or one, or a file"))
    }

    fn spectrum(&self, node: &Node<'_, '_>, key: &str, name: &str) -> Result<Spectrum, SceneError> {
        let path = self.folder.join(name);
        if Path::new(name).extension().is_none() && !path.exists() {
            let names = Illuminant::ALL.map(Illuminant::name).join(", ");
            return Err(node.error(key, format!("found `{name}`; expected a file, or one of {names}")));
        }
        Spectrum::open(&path).map_err(|error| node.error(key, error.to_string()))
    }
}
