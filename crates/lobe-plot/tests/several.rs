//! Figures of several materials, of channels and spectra, and of materials with nothing to show.

use std::f64::consts::PI;
use std::path::Path;

use lobe::formats::{Document, Format};
use lobe::{Channels, Scatter, specular};
use lobe_plot::{DrawError, Figure, Scaling, Shown, Silent, Subject, View, curves, draw, page, rasterise, spectra};

const ALL: [Figure; 6] =
    [Figure::Curves, Figure::Channels, Figure::Spectra, Figure::Polar, Figure::Slices, Figure::Sphere];

/// The same texel at all nodes, measured to 60 degrees from the mirror direction.
fn flat(name: &str, channels: Channels, texel: &[f32]) -> Subject {
    let knots = [vec![0.0, 0.5, 1.0, 1.4], vec![0.0], vec![0.0, PI / 3.0], vec![0.0, PI]];
    let values = texel.repeat(4 * 2 * 2);
    let data = specular::Data::new(Scatter::Reflection, knots, channels, values).expect("a table");
    Subject::new(Path::new(name), Format::Ddr, Document::new(data)).expect("a material")
}

fn one(subject: &Subject, view: &View, figure: Figure) -> String {
    draw(&[Shown { subject, view }], figure, &Silent).expect("a figure").svg
}

fn wavelengths() -> Channels {
    Channels::Spectral(vec![450.0, 500.0, 600.0])
}

#[test]
fn figures_without_positive_values_say_so() {
    for texel in [[-1.0, -1.0, -1.0], [0.0; 3], [1.0, 0.5, -0.01], [-1e-38, 1e-38, 3e38]] {
        for channels in [Channels::Rgb, wavelengths()] {
            let subject = flat("odd.ddr", channels.clone(), &texel);
            for channel in [None, Some(2)] {
                for scaling in [None, Some(Scaling::Log), Some(Scaling::Linear)] {
                    let mut view = View { width: 100, scaling, ..View::new(&subject) };
                    if let Some(index) = channel {
                        view = view.channel(&subject, &channels.names()[index]).expect("a channel");
                    }
                    for figure in ALL {
                        if figure == Figure::Spectra && channels == Channels::Rgb {
                            continue;
                        }
                        let svg = one(&subject, &view, figure);
                        let is_odd = |line: &&str| line.contains("NaN") || line.contains("inf");
                        // Pictures may contain any letters.
                        let odd = svg.lines().filter(|line| !line.contains("href=")).find(is_odd);
                        assert_eq!(odd, None, "{texel:?} {figure}");
                    }
                    let is_dark = view.quantity.reduce(&texel) <= 0.0;
                    let log = View { scaling: Some(Scaling::Log), ..view.clone() };
                    let says = one(&subject, &log, Figure::Curves).contains("no value is above 0");
                    assert_eq!(says, is_dark, "{texel:?} {channel:?}");
                    assert_eq!(one(&subject, &log, Figure::Slices).contains("No value is above 0"), is_dark);
                }
            }
            let view = View { width: 100, ..View::new(&subject) };
            rasterise(&one(&subject, &view, Figure::Curves), 120).expect("a picture");
            if channels == Channels::Rgb {
                page(&[Shown { subject: &subject, view: &view }], &[Vec::new()], &Silent);
            }
        }
    }
}

#[test]
fn measured_points_are_marked_and_show_their_value() {
    let subject = flat("flat.ddr", Channels::Mono, &[0.25]);
    let view = View { sigmas: vec![0.5], ..View::new(&subject) };
    let curve = &curves(&subject, &view, &Silent)[0];
    // At the mirror direction, and 60 degrees from it on both sides, both just above the horizon.
    let points: Vec<f64> = curve.points.iter().map(|&at| curve.theta[at]).collect();
    assert_eq!(points.len(), 3, "{points:?}");
    assert!((points[0] - (0.5 - PI / 3.0)).abs() < 1e-9 && (points[1] - 0.5).abs() < 1e-9, "{points:?}");
    let svg = one(&subject, &view, Figure::Curves);
    let dots = svg.lines().find(|line| line.contains("class=\"dots\"")).expect("dots");
    assert_eq!(dots.matches('M').count(), 3, "{dots}");
    assert!(svg.contains("<title>σ = 28.6°, θ = 28.6°: 0.25 1/sr</title>"));
    assert!(svg.contains("<title>σ = 28.6°, θ = \u{2212}89.9°: 0.25 1/sr, not measured</title>"));
    // Light between the knots was not measured, and has no points.
    let view = View { sigmas: vec![0.7], ..view };
    assert!(curves(&subject, &view, &Silent)[0].points.is_empty());
    assert!(!one(&subject, &view, Figure::Curves).contains("class=\"dots\""));
}

#[test]
fn dark_channels_have_no_curve_and_no_influence_on_the_axis() {
    let all = flat("rgb.ddr", Channels::Rgb, &[0.3, 0.2, 1e-9]);
    let svg = one(&all, &View::new(&all), Figure::Channels);
    assert!(svg.contains("above a millionth of the largest value: B."), "B is named");
    assert!(svg.contains("class=\"c0\"") && svg.contains("class=\"c1\"") && !svg.contains("class=\"c2\""));
    let two = flat("rgb.ddr", Channels::Rgb, &[0.3, 0.2, 0.3]);
    let labels = |svg: &str| -> Vec<String> {
        let texts =
            svg.lines().filter(|line| line.contains("text-anchor=\"end\"") && line.contains("font-size=\"16\""));
        texts.map(String::from).collect()
    };
    assert_eq!(labels(&svg), labels(&one(&two, &View::new(&two), Figure::Channels)));
    assert!(one(&two, &View::new(&two), Figure::Channels).contains("class=\"c2\""));
}

#[test]
fn spectra_pass_through_the_values_of_all_wavelengths() {
    let subject = flat("film.ddr", wavelengths(), &[0.1, 0.4, 0.2]);
    let view = View { sigmas: vec![0.5, 1.0], thetas: vec![0.5, -0.9], ..View::new(&subject) };
    let found = spectra(&subject, &view, &view.sigmas, &Silent).expect("spectra");
    assert_eq!(found.len(), 4);
    for spectrum in &found {
        assert_eq!(spectrum.nm, [450.0, 500.0, 600.0]);
        assert!(
            spectrum.f.iter().zip([0.1, 0.4, 0.2]).all(|(f, expected)| (f - expected).abs() < 1e-6),
            "{spectrum:?}"
        );
    }
    assert_eq!(found.iter().map(|one| one.is_measured).collect::<Vec<_>>(), [true, false, true, false]);
    let svg = one(&subject, &view, Figure::Spectra);
    assert!(svg.contains("wavelength (nm)") && svg.contains("<title>σ = 28.6°, θ = 28.6°, 500 nm: 0.4 1/sr</title>"));
    let subject = flat("rgb.ddr", Channels::Rgb, &[0.1, 0.4, 0.2]);
    let view = View::new(&subject);
    let error = draw(&[Shown { subject: &subject, view: &view }], Figure::Spectra, &Silent).expect_err("no spectra");
    assert_eq!(error.to_string(), "found the channels R, G, B; expected at least two wavelengths");
}

#[test]
fn several_files_share_axes_and_have_different_colours() {
    let subjects = [flat("a.ddr", Channels::Mono, &[0.25]), flat("b.ddr", Channels::Rgb, &[0.5; 3])];
    let views = subjects.each_ref().map(|subject| View { sigmas: vec![0.0, 0.5], ..View::new(subject) });
    let shown = [0, 1].map(|at| Shown { subject: &subjects[at], view: &views[at] });
    let svg = |figure| draw(&shown, figure, &Silent).expect("a figure").svg;
    for figure in [Figure::Curves, Figure::Polar, Figure::Slices, Figure::Sphere] {
        assert!(svg(figure).contains("a.ddr, b.ddr</text>"), "{figure}");
        rasterise(&svg(figure), 300).expect("a picture");
    }
    let curves = svg(Figure::Curves);
    assert_eq!(curves.matches("<clipPath").count(), 2, "a panel per incidence");
    assert!(curves.contains("class=\"f0\"") && curves.contains("class=\"f1\"") && !curves.contains("class=\"f2\""));
    assert!(curves.contains("<title>b.ddr: σ = 28.6°, θ = 28.6°: 0.5 1/sr</title>"));
    // Two disks per file, and the colour bar.
    assert_eq!(svg(Figure::Slices).matches("<image").count(), 5);
    // One exposure, determined by the brighter one.
    let said = draw(&shown, Figure::Sphere, &Silent).expect("a figure").said;
    let alone = draw(&shown[1..], Figure::Sphere, &Silent).expect("a figure").said;
    assert_eq!(said[0], alone[0].split(',').next().unwrap_or_default());
    for figure in [Figure::Channels, Figure::Spectra] {
        assert_eq!(draw(&shown, figure, &Silent), Err(DrawError::Several { figure, found: 2 }));
    }
    let page = page(&shown, &[Vec::new(), Vec::new()], &Silent);
    assert_eq!(page.figures, 5);
    assert!(
        page.html.contains("<h3>a.ddr: Directional albedo</h3>") && page.html.contains("b.ddr: Directional albedo")
    );
}

#[test]
fn the_page_shows_the_findings_of_the_checks() {
    let subject = flat("bright.ddr", Channels::Mono, &[0.9]);
    let view = View { width: 240, ..View::new(&subject) };
    let page = page(&[Shown { subject: &subject, view: &view }], &[Vec::new()], &Silent);
    let failed = "<span class=\"status fail\">fail</span></td><th>energy</th><td>albedo ";
    assert!(page.html.contains(failed), "an albedo of 2.8 is impossible");
    assert!(page.said.iter().any(|said| said.starts_with("checks: 1 failed")), "{:?}", page.said);
    assert!(
        page.said.iter().any(|said| said.contains("EV")) && page.said.iter().any(|said| said.starts_with("light at"))
    );
}

#[test]
fn narrow_figures_are_legible() {
    let subject = flat("flat.ddr", wavelengths(), &[0.1, 0.4, 0.2]);
    for (width, units) in [(400, "0 0 400 "), (960, "0 0 720 ")] {
        let view = View { width, ..View::new(&subject) };
        for figure in ALL {
            let svg = one(&subject, &view, figure);
            assert!(svg.contains(&format!("viewBox=\"{units}")), "{width} {figure}");
            // The size of letters in pixels.
            let units: f64 = if width == 400 { 400.0 } else { 720.0 };
            for size in svg.split(" font-size=\"").skip(1).filter_map(|rest| rest.split('"').next()) {
                let size: f64 = size.parse().expect("a number");
                assert!(size * f64::from(width) / units > 10.0, "{width} {figure}: {size}");
            }
        }
    }
}

#[test]
fn long_numbers_leave_room_for_the_name_of_the_axis() {
    let subject = flat("dark.ddr", Channels::Mono, &[2e-5]);
    let svg = one(&subject, &View { width: 400, ..View::new(&subject) }, Figure::Curves);
    let numbers: Vec<&str> = svg.lines().filter(|line| line.contains("\u{b7}10<tspan")).collect();
    assert!(!numbers.is_empty(), "{svg}");
    for number in numbers {
        // The name is 26 wide with its margin, the number about 46; it ends here.
        assert!(attribute(number, "x") > 26.0 + 46.0, "{number}");
    }
}

#[test]
fn spectra_of_dark_directions_are_visible() {
    // Ten times as bright for light at 57 degrees; beyond two degrees from the mirror direction, a share of it.
    let drawn = |share: f32, scaling| {
        let knots = [vec![0.0, 1.0], vec![0.0], vec![0.0, 0.03, PI / 2.0], vec![0.0]];
        let values = [1.0, 10.0].iter().flat_map(|f| [*f, f * share, f * share]).flat_map(|f| [f; 3]).collect();
        let data = specular::Data::new(Scatter::Reflection, knots, wavelengths(), values).expect("a table");
        let subject = Subject::new(Path::new("peak.ddr"), Format::Ddr, Document::new(data)).expect("a material");
        let view = View { sigmas: vec![0.0, 1.0], scaling, ..View::new(&subject) };
        one(&subject, &view, Figure::Spectra)
    };
    let has_powers = |svg: &str| svg.contains(">10<tspan");
    assert!(has_powers(&drawn(1e-3, None)) && !has_powers(&drawn(0.2, None)));
    // Each linear panel has its own axis: the first one ends near 1, the other near 10.
    let linear = drawn(1e-3, Some(Scaling::Linear));
    let has_label = |label: &str| linear.contains(&format!(">{label}</text>"));
    assert!(!has_powers(&linear) && has_label("0.8") && has_label("8"), "{linear}");
}

/// The number of an attribute of the first element of a line.
fn attribute(line: &str, name: &str) -> f64 {
    let rest = line.split_once(&format!(" {name}=\"")).unwrap_or_else(|| panic!("no {name} in {line}")).1;
    rest.split('"').next().and_then(|number| number.parse().ok()).unwrap_or_else(|| panic!("{name} in {line}"))
}

#[test]
fn names_of_panels_and_legends_cover_no_line() {
    let subject = flat("flat.ddr", Channels::Rgb, &[0.25, 0.5, 0.75]);
    for width in [400, 720] {
        let view = View { sigmas: vec![0.0, 0.5], width, ..View::new(&subject) };
        let svg = one(&subject, &view, Figure::Channels);
        let panels: Vec<&str> = svg.lines().filter(|line| line.starts_with("<clipPath")).collect();
        let names: Vec<&str> =
            svg.lines().filter(|line| line.ends_with(">σ = 0°</text>") || line.contains(">σ = 28.6°<")).collect();
        assert_eq!((panels.len(), names.len()), (2, 2), "{svg}");
        let mut above = 0.0;
        for (panel, name) in panels.iter().zip(names) {
            let rect = panel.split_once("<rect").expect("a rectangle").1;
            let (top, y) = (attribute(rect, "y"), attribute(name, "y"));
            // Between the panel above and the marks of the mirror direction, which are ten units high.
            assert!(above + 16.0 < y && y < top - 10.0, "{name} at {y}, above a panel from {top}");
            above = top + attribute(rect, "height");
        }
        for figure in [Figure::Curves, Figure::Channels, Figure::Polar] {
            let svg = one(&subject, &view, figure);
            let legend = svg.lines().find(|line| line.ends_with(">not measured</text>")).expect("a legend");
            // Letters are about half as wide as high.
            assert!(attribute(legend, "x") + 12.0 * 7.7 < f64::from(width), "{figure}: {legend}");
        }
    }
}
