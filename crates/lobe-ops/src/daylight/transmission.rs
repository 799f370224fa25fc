//! Transmission matrices of WINDOW files.

use std::f64::consts::TAU;

use lobe_table::window::klems::{AngleBasis, KlemsMatrix};
use lobe_table::window::{Block, Blocks, Component, Data};
use thiserror::Error;

use super::Matrix;

/// The reason why a WINDOW file has no transmission matrix.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum Unfit {
    /// There is no visible band.
    #[error("the bands {0}; expected one called Visible")]
    Band(String),
    /// There is no block of transmission.
    #[error("no transmission; expected that of the front or of the back")]
    Transmission,
    /// The data is a tensor tree, or the bands have different patches.
    #[error(
        "{0}; expected Klems matrices on the same patches in all bands: `lobe convert --to klems --basis full` makes them"
    )]
    Patches(&'static str),
}

/// The transmission matrix of a WINDOW file for light that arrives at its front, the outside: `f` times the projected
/// solid angle of the incident patch, with a column per incident patch and a row per outgoing patch. If the file has
/// only the transmission of the back, that is used with the directions exchanged.
///
/// The visible band alone gives three equal components. Together with the bands `CIE-X` and `CIE-Z` it gives red, green
/// and blue, with Radiance's primaries and equal-energy white.
///
/// # Errors
/// [`Unfit`] if there is no such matrix.
pub fn transmission(data: &Data) -> Result<Matrix, Unfit> {
    let names = || data.bands.iter().map(|band| band.wavelength.as_str()).collect::<Vec<_>>().join(", ");
    let visible = matrix(data.band("Visible").ok_or_else(|| Unfit::Band(names()))?)?;
    let [incident, exit] = bases(&visible);
    let colours = [data.band("CIE-X"), data.band("CIE-Z")];
    let colours = match colours {
        [Some(x), Some(z)] => Some([matrix(x)?, matrix(z)?]),
        _ => None,
    };
    if let Some(others) = &colours
        && others.iter().any(|other| bases(other) != [incident, exit])
    {
        return Err(Unfit::Patches("bands with different patches"));
    }
    let (columns, rows) = (centres(incident), centres(exit));
    let mut elements = Vec::with_capacity(3 * columns.len() * rows.len());
    for [x, y, z] in &rows {
        for (patch, [u, v, w]) in columns.iter().enumerate() {
            // Light arrives from the direction opposite to its travel.
            let (wi, wo) = ([-u, -v, -w], [*x, *y, *z]);
            let area = incident.projected_solid_angle(patch);
            let visible = value(&visible, wi, wo) * area;
            let rgb = match &colours {
                None => [visible; 3],
                Some([x, z]) => radiance_rgb([value(x, wi, wo) * area, visible, value(z, wi, wo) * area]),
            };
            elements.extend(rgb);
        }
    }
    Ok(Matrix::new([rows.len(), columns.len(), 3], &elements))
}

/// The transmission of a band, and `true` if its directions must be exchanged.
struct Transmission<'a> {
    matrix: &'a KlemsMatrix,
    is_exchanged: bool,
}

fn matrix(blocks: &Blocks) -> Result<Transmission<'_>, Unfit> {
    let found = [(Block::TransmissionFront, false), (Block::TransmissionBack, true)];
    let found = found.into_iter().find_map(|(block, is_exchanged)| Some((blocks.block(block)?, is_exchanged)));
    match found {
        None => Err(Unfit::Transmission),
        Some((Component::Tree(_), _)) => Err(Unfit::Patches("a tensor tree")),
        Some((Component::Klems(matrix), is_exchanged)) => Ok(Transmission { matrix, is_exchanged }),
    }
}

/// The patches of light arriving at the front, and of light leaving the back.
fn bases<'a>(transmission: &Transmission<'a>) -> [&'a AngleBasis; 2] {
    let Transmission { matrix, is_exchanged } = transmission;
    if *is_exchanged { [matrix.exit(), matrix.incident()] } else { [matrix.incident(), matrix.exit()] }
}

fn value(transmission: &Transmission<'_>, wi: [f64; 3], wo: [f64; 3]) -> f64 {
    let (from, to) = if transmission.is_exchanged { (wo, wi) } else { (wi, wo) };
    transmission.matrix.eval(from, to)
}

/// A direction in the middle of each patch, above the surface.
fn centres(basis: &AngleBasis) -> Vec<[f64; 3]> {
    let mut centres = Vec::with_capacity(basis.patches());
    for ring in basis.rings() {
        let (sin, cos) = (0.5 * (ring.lower + ring.upper)).to_radians().sin_cos();
        for sector in 0..ring.patches {
            let (sin_phi, cos_phi) = (TAU * f64::from(sector) / f64::from(ring.patches)).sin_cos();
            centres.push([sin * cos_phi, sin * sin_phi, cos]);
        }
    }
    centres
}

/// Converts to red, green and blue as in Radiance, whose primaries are at (0.640, 0.330), (0.290, 0.600) and (0.150,
/// 0.060), with white at (1/3, 1/3).
fn radiance_rgb([x, y, z]: [f64; 3]) -> [f64; 3] {
    const FROM_XYZ: [[f64; 3]; 3] = [
        [2.565_312_8, -1.166_849_62, -0.398_463_17],
        [-1.022_108_17, 1.978_286_62, 0.043_821_54],
        [0.074_724_37, -0.251_939_55, 1.177_215_18],
    ];
    FROM_XYZ.map(|row| row[0] * x + row[1] * y + row[2] * z)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use lobe_table::window::Band;

    use super::*;

    fn sheet(block: Block, names: &[&str]) -> Data {
        let basis = AngleBasis::quarter();
        let count = basis.patches();
        let bands = names.iter().enumerate().map(|(band, name)| {
            let values = (0..count * count).map(|index| (index % 13 + band) as f32 * 0.01).collect();
            let matrix = KlemsMatrix::new(basis.clone(), basis.clone(), values).expect("a matrix");
            let mut window = Blocks::default();
            window.set(block, Component::Klems(matrix));
            Band { wavelength: (*name).into(), window }
        });
        Data { bands: bands.collect() }
    }

    #[test]
    fn elements_are_flux_from_patch_to_patch() {
        let data = sheet(Block::TransmissionFront, &["Visible"]);
        let found = transmission(&data).expect("a matrix");
        let Some(Component::Klems(matrix)) = data.bands[0].window.block(Block::TransmissionFront) else {
            panic!("no matrix")
        };
        assert_eq!(found.shape(), [41, 41, 3]);
        for patch in [0, 3, 40] {
            let albedo: f64 =
                (0..41).map(|exit| found.at(exit, patch, 1) * matrix.exit().projected_solid_angle(exit)).sum::<f64>()
                    / matrix.incident().projected_solid_angle(patch);
            assert!((albedo - matrix.albedo(patch)).abs() < 1e-6, "{albedo} of patch {patch}");
        }
        let total: f64 = (0..41).map(|patch| matrix.incident().projected_solid_angle(patch)).sum();
        assert!((total - PI).abs() < 1e-9);
    }

    #[test]
    fn the_back_serves_with_the_directions_exchanged() {
        let [front, back] = [Block::TransmissionFront, Block::TransmissionBack].map(|block| sheet(block, &["Visible"]));
        let found = transmission(&back).expect("a matrix");
        let (columns, rows) = (centres(&AngleBasis::quarter()), centres(&AngleBasis::quarter()));
        let (wi, wo) = (columns[5].map(|c| -c), rows[17]);
        let expected = back.bands[0].window.eval(wi, wo) * AngleBasis::quarter().projected_solid_angle(5);
        assert!((found.at(17, 5, 0) - expected).abs() < 1e-12);
        assert_ne!(transmission(&front).expect("a matrix"), found);
    }

    /// Equal-energy white is grey.
    #[test]
    fn colours_are_those_of_radiance() {
        for (found, expected) in radiance_rgb([0.5; 3]).into_iter().zip([0.5; 3]) {
            assert!((found - expected).abs() < 1e-6);
        }
        assert!(transmission(&sheet(Block::TransmissionFront, &["CIE-X", "Visible", "CIE-Z"])).is_ok());
        assert!(matches!(transmission(&sheet(Block::TransmissionFront, &["Solar"])), Err(Unfit::Band(_))));
        assert_eq!(transmission(&sheet(Block::ReflectionBack, &["Visible"])), Err(Unfit::Transmission));
    }
}
