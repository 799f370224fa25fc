//! Averages of spectra over the bands of WINDOW files: X, Visible and Z under D65, and Solar.

use lobe_colour::{Channels, Reduction, Space, WHITE};

/// The averages that a WINDOW file holds of a spectrum.
pub(crate) struct Averages {
    /// The names of the bands.
    pub names: Vec<String>,
    /// One row per band: the weights of the wavelengths.
    pub rows: Vec<Vec<f64>>,
    /// The bands in words.
    pub note: String,
}

/// The range in nm that wavelengths with a visible average reach over: less than 1 % of luminance is beyond it.
const VISIBLE: [f64; 2] = [400.0, 700.0];
/// The largest distance of neighbours in this range, in nm.
const APART: f64 = 50.0;
/// The share of sunlight that wavelengths with a solar average reach over.
const SUNLIGHT: f64 = 0.95;
/// The largest share of it between neighbours.
const BETWEEN: f64 = 0.1;

/// The averages of spectra at these wavelengths in nm: visible ones and, if the wavelengths reach over sunlight, the
/// solar one. The spectrum is linear between them. `None` if they do not reach over visible light.
pub(crate) fn averages(wavelengths: &[f64]) -> Option<Averages> {
    let mut order: Vec<usize> = (0..wavelengths.len()).collect();
    order.sort_by(|&a, &b| wavelengths[a].total_cmp(&wavelengths[b]));
    let (first, last) = (wavelengths[*order.first()?], wavelengths[*order.last()?]);
    let is_near = |ends: &[usize]| {
        let [low, high] = [wavelengths[ends[0]], wavelengths[ends[1]]];
        high - low <= APART || high <= VISIBLE[0] || low >= VISIBLE[1]
    };
    if first > VISIBLE[0] || last < VISIBLE[1] || !order.windows(2).all(is_near) {
        return None;
    }
    let colour = Reduction::new(&Channels::Spectral(wavelengths.to_vec()), Space::Xyz).ok()?;
    let axis = |axis: usize| colour.weights().iter().map(|xyz| xyz[axis] / WHITE[axis]).collect::<Vec<f64>>();
    let mut names: Vec<String> = ["CIE-X", "Visible", "CIE-Z"].map(String::from).into();
    let mut rows: Vec<Vec<f64>> = [0, 1, 2].map(axis).into();
    let visible = "wavelengths as X Y Z under D65, relative to a white of X = Y = Z";
    let note = match solar(wavelengths, &order) {
        Ok(row) => {
            names.push("Solar".into());
            rows.push(row);
            format!("{visible}, and as Solar (direct sunlight of ASTM G173)")
        }
        Err(why) => format!("{visible}; no band Solar, because {why}"),
    };
    Some(Averages { names, rows, note })
}

/// The weights of wavelengths in the solar average, whose sum is 1; otherwise, the reason for leaving the average out.
fn solar(wavelengths: &[f64], order: &[usize]) -> Result<Vec<f64>, String> {
    let all: f64 = DIRECT.iter().map(|[_, _, irradiance]| irradiance).sum();
    let mut weights = vec![0.0; wavelengths.len()];
    let mut largest = 0.0_f64;
    for ends in order.windows(2) {
        let [low, high] = [wavelengths[ends[0]], wavelengths[ends[1]]];
        let mut between = 0.0;
        for [from, to, irradiance] in &DIRECT {
            let (from_here, to_here) = (from.max(low), to.min(high));
            if from_here >= to_here {
                continue;
            }
            let share = irradiance * (to_here - from_here) / (to - from) / all;
            let t = (0.5 * (from_here + to_here) - low) / (high - low);
            weights[ends[0]] += share * (1.0 - t);
            weights[ends[1]] += share * t;
            between += share;
        }
        largest = largest.max(between);
    }
    let reached: f64 = weights.iter().sum();
    if reached < SUNLIGHT {
        let (reached, least) = (100.0 * reached, 100.0 * SUNLIGHT);
        return Err(format!("the wavelengths reach over {reached:.0} % of sunlight, not {least:.0} %"));
    }
    if largest > BETWEEN {
        let (largest, most) = (100.0 * largest, 100.0 * BETWEEN);
        return Err(format!("{largest:.0} % of sunlight, more than {most:.0} %, is between two wavelengths"));
    }
    weights.iter_mut().for_each(|weight| *weight /= reached);
    Ok(weights)
}

/// Direct normal and circumsolar sunlight at air mass 1.5 (ASTM G173-03, computed by SMARTS 2.9.2): W/m2 between two
/// wavelengths in nm. Less than 1 % is outside.
#[rustfmt::skip]
static DIRECT: [[f64; 3]; 65] = [
    [300.0, 320.0, 0.83], [320.0, 340.0, 4.21], [340.0, 360.0, 6.29], [360.0, 380.0, 9.03], [380.0, 400.0, 10.17],
    [400.0, 420.0, 18.18], [420.0, 440.0, 19.14], [440.0, 460.0, 24.60], [460.0, 480.0, 26.53], [480.0, 500.0, 26.67],
    [500.0, 520.0, 26.44], [520.0, 540.0, 27.10], [540.0, 560.0, 27.08], [560.0, 580.0, 26.72], [580.0, 600.0, 26.44],
    [600.0, 620.0, 26.40], [620.0, 640.0, 25.76], [640.0, 660.0, 25.15], [660.0, 680.0, 25.46], [680.0, 700.0, 23.14],
    [700.0, 720.0, 22.64], [720.0, 740.0, 20.74], [740.0, 760.0, 22.06], [760.0, 780.0, 17.40], [780.0, 800.0, 20.63],
    [800.0, 820.0, 18.49], [820.0, 840.0, 17.40], [840.0, 860.0, 18.11], [860.0, 880.0, 17.73], [880.0, 900.0, 15.99],
    [900.0, 920.0, 12.81], [920.0, 940.0, 9.02], [940.0, 960.0, 6.54], [960.0, 980.0, 10.82], [980.0, 1000.0, 13.72],
    [1000.0, 1050.0, 32.71], [1050.0, 1100.0, 28.27], [1100.0, 1150.0, 11.40], [1150.0, 1200.0, 18.68], [1200.0, 1250.0, 21.56],
    [1250.0, 1300.0, 19.58], [1300.0, 1350.0, 11.45], [1350.0, 1400.0, 0.02], [1400.0, 1450.0, 1.18], [1450.0, 1500.0, 5.53],
    [1500.0, 1550.0, 12.52], [1550.0, 1600.0, 12.29], [1600.0, 1650.0, 11.22], [1650.0, 1700.0, 10.29], [1700.0, 1750.0, 8.70],
    [1750.0, 1800.0, 5.44], [1800.0, 1850.0, 0.22], [1850.0, 1900.0, 0.00], [1900.0, 1950.0, 0.14], [1950.0, 2000.0, 2.61],
    [2000.0, 2050.0, 3.03], [2050.0, 2100.0, 3.73], [2100.0, 2150.0, 4.41], [2150.0, 2200.0, 3.94], [2200.0, 2250.0, 3.69],
    [2250.0, 2300.0, 3.22], [2300.0, 2350.0, 2.73], [2350.0, 2400.0, 2.06], [2400.0, 2450.0, 1.52], [2450.0, 2500.0, 0.73],
];

#[cfg(test)]
mod tests {
    use super::*;

    fn every(step: usize, from: usize, to: usize) -> Vec<f64> {
        (from..=to).step_by(step).map(|nm| nm as f64).collect()
    }

    fn average(averages: &Averages, name: &str, spectrum: impl Fn(f64) -> f64, wavelengths: &[f64]) -> f64 {
        let row = averages.names.iter().position(|known| known == name).expect("the band");
        averages.rows[row].iter().zip(wavelengths).map(|(weight, nm)| weight * spectrum(*nm)).sum()
    }

    #[test]
    fn a_flat_spectrum_is_flat_in_every_band() {
        let wavelengths = every(10, 300, 2500);
        let found = averages(&wavelengths).expect("averages");
        assert_eq!(found.names, ["CIE-X", "Visible", "CIE-Z", "Solar"]);
        for name in &found.names {
            let flat = average(&found, name, |_| 0.5, &wavelengths);
            assert!((flat - 0.5).abs() < 2e-4, "{name}: {flat}");
        }
    }

    /// A filter that passes the visible range passes 52.4 % of the sunlight from 300 to 2500 nm.
    #[test]
    fn a_filter_passes_its_share() {
        let mut wavelengths = every(10, 300, 2500);
        wavelengths.reverse();
        let found = averages(&wavelengths).expect("averages");
        let filter = |nm: f64| match nm {
            380.0 | 780.0 => 0.5,
            nm => f64::from((380.0..780.0).contains(&nm)),
        };
        let solar = average(&found, "Solar", filter, &wavelengths);
        assert!((solar - 0.524).abs() < 2e-3, "{solar}");
        // The mean wavelength of sunlight is 857 nm, also if wavelengths are missing where there is little of it.
        wavelengths.retain(|nm| !(1160.0..1450.0).contains(nm));
        let gap = averages(&wavelengths).expect("averages");
        let ramp = average(&gap, "Solar", |nm| nm, &wavelengths);
        assert!((ramp - 856.7).abs() < 0.5, "{ramp}");
        // A ramp has its value at the mean wavelength of luminance under D65, near 560 nm.
        let ramp = average(&gap, "Visible", |nm| nm, &wavelengths);
        assert!((555.0..570.0).contains(&ramp), "{ramp}");
    }

    #[test]
    fn averages_need_wavelengths_that_reach_far_enough() {
        for (from, to, step, has_solar) in [
            (380, 780, 5, false),
            (400, 700, 50, false),
            (400, 1700, 50, false),
            (350, 2500, 10, true),
            (400, 2400, 50, true),
        ] {
            let found = averages(&every(step, from, to)).expect("averages");
            assert_eq!(found.names.len() == 4, has_solar, "{from} to {to}: {}", found.note);
        }
        let reason = averages(&every(5, 380, 780)).expect("averages").note;
        assert!(reason.ends_with("the wavelengths reach over 52 % of sunlight, not 95 %"), "{reason}");
        let mut gap = every(20, 300, 800);
        gap.push(2500.0);
        let reason = averages(&gap).expect("averages").note;
        assert!(reason.contains("of sunlight, more than 10 %, is between two wavelengths"), "{reason}");
        for short in [vec![], vec![550.0], every(10, 450, 700), every(10, 400, 650), every(100, 400, 700)] {
            assert!(averages(&short).is_none(), "{short:?}");
        }
    }
}
