//! Figures of small materials with known values.

use std::collections::BTreeSet;
use std::f64::consts::PI;
use std::path::Path;

use lobe::Side;
use lobe::formats::{Document, Format};
use lobe::{Channels, Scatter, specular};
use lobe_colour::encode;
use lobe_plot::{
    Figure, Scaling, Shown, Silent, Studio, Subject, View, albedos, curves, in_plane, incident, page, rasterise, shade,
};
use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};

const FIGURES: [Figure; 5] = [Figure::Curves, Figure::Channels, Figure::Polar, Figure::Slices, Figure::Sphere];

/// A figure of one material.
fn draw(subject: &Subject, view: &View, figure: Figure) -> String {
    lobe_plot::draw(&[Shown { subject, view }], figure, &Silent).expect("a figure").svg
}

fn subject(samples: specular::Data, name: &str) -> Subject {
    let document = Document::new(samples);
    Subject::new(Path::new(name), Format::Ddr, document).expect("a table")
}

/// `f = albedo / pi` for red, green and blue, measured to 60 degrees from the mirror direction.
fn lambert(albedo: [f32; 3], scatter: Scatter) -> Subject {
    let knots = [vec![0.0, 0.5, 1.0, 1.4], vec![0.0], vec![0.0, PI / 3.0], vec![0.0, PI]];
    let texel = albedo.map(|albedo| albedo / std::f32::consts::PI);
    let values = (0..4 * 2 * 2).flat_map(|_| texel).collect();
    subject(specular::Data::new(scatter, knots, Channels::Rgb, values).expect("a table"), "lambert.ddr")
}

/// A peak about the mirror direction over a constant.
fn glossy() -> Subject {
    let theta: Vec<f64> = (0..=60).map(|i| (3.0 * f64::from(i)).to_radians()).collect();
    let sigma: Vec<f64> = [0.0_f64, 20.0, 40.0, 60.0].map(f64::to_radians).into();
    let peak = |theta: &f64| (0.05 + 4.0 * (-theta * theta / 0.02).exp()) as f32;
    let values = sigma.iter().flat_map(|_| theta.iter().map(peak)).collect();
    let knots = [sigma, vec![0.0], theta, vec![0.0]];
    subject(
        specular::Data::new(Scatter::Reflection, knots, Channels::Mono, values).expect("a table"),
        "glossy <&\">.ddr",
    )
}

/// The elements of a document, which has to be well-formed.
fn elements(xml: &str) -> Vec<(String, BytesStart<'static>)> {
    let mut reader = Reader::from_str(xml);
    let mut found = Vec::new();
    let mut depth = 0;
    loop {
        match reader.read_event().expect("well-formed XML") {
            Event::Start(element) => {
                depth += 1;
                found.push((element.name().as_ref().to_string(), element.into_owned()));
            }
            Event::Empty(element) => {
                found.push((element.name().as_ref().to_string(), element.into_owned()));
            }
            Event::End(_) => depth -= 1,
            Event::Eof => break,
            _ => {}
        }
    }
    assert_eq!(depth, 0, "every element is closed");
    found
}

fn attribute(element: &BytesStart<'_>, name: &str) -> Option<String> {
    let found = element.attributes().flatten().find(|attribute| attribute.key.as_ref() == name)?;
    Some(found.value.into_owned())
}

#[test]
fn every_figure_is_an_svg_with_the_name_of_the_file() {
    for subject in [glossy(), lambert([0.6, 0.3, 0.1], Scatter::Transmission)] {
        let view = View { width: 300, ..View::new(&subject) };
        for figure in FIGURES {
            let svg = draw(&subject, &view, figure);
            let elements = elements(&svg);
            assert_eq!(elements[0].0, "svg", "{figure}");
            assert_eq!(attribute(&elements[0].1, "width").as_deref(), Some("300"), "{figure}");
            for (_, element) in &elements {
                // Pictures may contain any letters.
                let numbers = element.attributes().flatten().filter(|attribute| attribute.key.as_ref() != "href");
                for attribute in numbers {
                    assert!(
                        !attribute.value.contains("NaN") && !attribute.value.contains("inf"),
                        "{figure}: {attribute:?}"
                    );
                }
            }
            let name =
                if subject.name().starts_with("glossy") { "glossy &lt;&amp;&quot;&gt;.ddr" } else { "lambert.ddr" };
            assert!(svg.contains(&format!(">{name}</text>")), "{figure}");
            // Everything that is referred to exists exactly once.
            let ids: Vec<String> = elements.iter().filter_map(|(_, element)| attribute(element, "id")).collect();
            assert_eq!(ids.len(), ids.iter().collect::<BTreeSet<_>>().len(), "{figure}");
            for (_, element) in &elements {
                if let Some(clip) = attribute(element, "clip-path") {
                    assert!(ids.iter().any(|id| clip == format!("url(#{id})")), "{figure}: {clip}");
                }
            }
        }
    }
}

#[test]
fn curves_hold_the_values_of_the_material() {
    let subject = glossy();
    let view = View::new(&subject);
    let curves = curves(&subject, &view, &Silent);
    assert_eq!(curves.len(), 4);
    for curve in &curves {
        assert!(curve.theta.windows(2).all(|pair| pair[0] < pair[1]));
        for at in (0..curve.theta.len()).step_by(17) {
            let (wi, wo) = (
                incident(Side::Front, curve.sigma, 0.0),
                in_plane(Side::Front, Scatter::Reflection, curve.theta[at], 0.0),
            );
            let mut f = [0.0];
            subject.material().eval(wi.map(|c| c as f32), wo.map(|c| c as f32), &mut f);
            assert_eq!(curve.f[at], f[0], "sigma {}, theta {}", curve.sigma, curve.theta[at]);
        }
        // The peak is at the mirror direction, on the positive side.
        let peak = (0..curve.f.len()).max_by(|&a, &b| curve.f[a].total_cmp(&curve.f[b])).expect("values");
        assert!((curve.theta[peak] - curve.sigma).abs() < 0.001, "{} {}", curve.theta[peak], curve.sigma);
    }
}

/// The drawn line, converted back to values with the frame and the numbers along it.
#[test]
fn the_drawn_line_passes_through_the_values() {
    let subject = glossy();
    for scaling in [Scaling::Linear, Scaling::Log] {
        let view = View { scaling: Some(scaling), sigmas: vec![40_f64.to_radians()], ..View::new(&subject) };
        let svg = draw(&subject, &view, Figure::Curves);
        let elements = elements(&svg);
        let clip = elements.iter().position(|(name, _)| name == "clipPath").expect("a frame");
        let side =
            |name: &str| attribute(&elements[clip + 1].1, name).expect("a side").parse::<f64>().expect("a number");
        let (left, top, width, height) = (side("x"), side("y"), side("width"), side("height"));
        let line = elements
            .iter()
            .skip(clip)
            .filter(|(_, element)| attribute(element, "class").as_deref() == Some("s0"))
            .filter_map(|(_, element)| attribute(element, "d"))
            .max_by_key(String::len)
            .expect("a curve");
        // The largest value is 4.05: the linear axis ends at 4.5, the logarithmic one goes from 0.05 to 5.
        let value = |y: f64| match (top + height - y) / height {
            share if scaling == Scaling::Linear => 4.5 * share,
            share => 0.05 * 100_f64.powf(share),
        };
        let mut checked = 0;
        for point in line.trim_start_matches('M').split('L') {
            let (x, y) = point.split_once(' ').expect("two numbers");
            let (x, y): (f64, f64) = (x.parse().expect("a number"), y.parse().expect("a number"));
            let theta = ((x - left) / width - 0.5) * PI;
            let wi = incident(Side::Front, view.sigmas[0], 0.0).map(|c| c as f32);
            let wo = in_plane(Side::Front, Scatter::Reflection, theta, 0.0).map(|c| c as f32);
            let mut f = [0.0];
            subject.material().eval(wi, wo, &mut f);
            // Coordinates have a hundredth of a unit, and the peak is steep.
            assert!((value(y) - f64::from(f[0])).abs() < 0.02, "{scaling:?} {theta}: {} {}", value(y), f[0]);
            checked += 1;
        }
        assert!(checked > 15, "{checked} points");
    }
}

#[test]
fn unmeasured_values_are_marked() {
    let subject = lambert([0.5; 3], Scatter::Reflection);
    let view = View { sigmas: vec![0.5], ..View::new(&subject) };
    let curve = &curves(&subject, &view, &Silent)[0];
    for (theta, is_measured) in curve.theta.iter().zip(&curve.is_measured) {
        let distance = (theta - 0.5).abs();
        if (distance - PI / 3.0).abs() > 0.002 {
            assert_eq!(*is_measured, distance < PI / 3.0, "{theta}");
        }
    }
    let slice = lobe_plot::slice(&subject, &view, 0.5, Scatter::Reflection, 64, &Silent);
    assert!(slice.is_measured[32 * 64 + 40], "the mirror direction is on the right");
    assert!(!slice.is_measured[32 * 64 + 2], "the far left is 60 degrees and more away from it");
    assert_eq!(slice.f[0], None, "outside the disk");
    // At 29 degrees, all four nodes are above the horizon; at 57 degrees, one is below it.
    assert_eq!(slice.measured.len(), 4);
    assert_eq!(lobe_plot::slice(&subject, &view, 1.0, Scatter::Reflection, 16, &Silent).measured.len(), 3);
    // Light beyond the last knot was not measured at all.
    let view = View { sigmas: vec![1.5], ..view };
    assert!(curves_are_dark(&subject, &view));
}

fn curves_are_dark(subject: &Subject, view: &View) -> bool {
    curves(subject, view, &Silent).iter().all(|curve| !curve.is_measured.contains(&true))
}

#[test]
fn the_albedo_of_lambert_is_its_albedo() {
    for scatter in [Scatter::Reflection, Scatter::Transmission] {
        let subject = lambert([0.6, 0.3, 0.1], scatter);
        for albedo in albedos(&subject, &View::new(&subject), &Silent) {
            let expected = 0.2126 * 0.6 + 0.7152 * 0.3 + 0.0722 * 0.1;
            assert!((albedo.value - expected).abs() < 1e-3, "{albedo:?}");
            assert!((albedo.rgb[0] - 0.6).abs() < 2e-3, "{albedo:?}");
            assert_eq!(albedo.scatter, scatter);
        }
    }
}

/// A Lambertian sphere reflects albedo x cos: exact for a small light, and white in the right places.
#[test]
fn a_lambert_sphere_has_the_right_pixels() {
    let albedo = [0.6, 0.3, 0.1];
    let subject = lambert(albedo, Scatter::Reflection);
    let sphere = shade(&subject, &View::new(&subject), Studio::Viewer, 101, &Silent);
    let at = |x: usize, y: usize| y * 101 + x;
    // The middle faces the viewer; the light is 3 degrees away.
    let cos = 1.0 / (1.0_f32 + 0.04 * 0.04 + 0.034 * 0.034).sqrt();
    for (found, albedo) in sphere.linear[at(50, 50)].iter().zip(albedo) {
        assert!((found - albedo * cos).abs() < 2e-3, "{found}");
    }
    // At half the radius the normal is 30 degrees away from the viewer.
    let right = sphere.linear[at(75, 50)][0];
    assert!((right - 0.6 * 0.75_f32.sqrt()).abs() < 0.02, "{right}");
    let picture = sphere.picture(0.0);
    let pixel = &picture.rgba[4 * at(50, 50)..][..4];
    for (byte, albedo) in pixel.iter().zip(albedo) {
        assert!(byte.abs_diff(encode(albedo * cos)) <= 1, "{pixel:?}");
    }
    assert_eq!((pixel[3], picture.rgba[3]), (255, 0), "opaque on the sphere and clear around it");
    // One stop doubles the light.
    let brighter = sphere.picture(-1.0).rgba[4 * at(50, 50)];
    assert!(brighter.abs_diff(encode(0.3 * cos)) <= 1);
    // The key light comes from the left, so the lower right is darker, and the light from behind shows nothing.
    let key = shade(&subject, &View::new(&subject), Studio::Key, 51, &Silent);
    assert!(key.linear[18 * 51 + 18][0] > 3.0 * key.linear[38 * 51 + 38][0]);
    let behind = shade(&subject, &View::new(&subject), Studio::Behind, 21, &Silent);
    assert!(behind.linear.iter().all(|rgb| *rgb == [0.0; 3]));
}

#[test]
fn a_png_has_the_requested_size_and_is_not_blank() {
    let subject = glossy();
    let svg = draw(&subject, &View::new(&subject), Figure::Curves);
    let png = rasterise(&svg, 360).expect("a picture");
    let mut reader = png::Decoder::new(std::io::Cursor::new(png)).read_info().expect("a PNG");
    let mut pixels = vec![0; reader.output_buffer_size().expect("a size")];
    let info = reader.next_frame(&mut pixels).expect("pixels");
    assert_eq!(info.width, 360);
    assert_eq!(pixels[..4], [255; 4], "white paper");
    let dark = pixels.chunks_exact(4).filter(|pixel| pixel[0] < 100).count();
    assert!(dark > 500, "{dark} dark pixels of text, frame and curves");
    // Text is drawn without fonts of the machine: the heading is in the upper left.
    let heading =
        (8..20).flat_map(|y| (10..150).map(move |x| 4 * (y * 360 + x))).filter(|&at| pixels[at] < 100).count();
    assert!(heading > 60, "{heading} dark pixels in the heading");
    assert!(rasterise(&svg, 0).is_err() && rasterise("<p>", 10).is_err());
}

#[test]
fn the_page_holds_every_figure_and_nothing_from_outside() {
    let subject = glossy();
    let view = View { width: 200, ..View::new(&subject) };
    let facts = [lobe_plot::Facts { title: "The file".into(), rows: vec![("bytes".into(), "12 < 13".into())] }];
    let html = page(&[Shown { subject: &subject, view: &view }], &[facts.to_vec()], &Silent).html;
    let found = elements(html.trim_start_matches("<!DOCTYPE html>\n"));
    let count = |name: &str| found.iter().filter(|(element, _)| element == name).count();
    // Spheres, logarithmic and linear curves, lobes, slices, each for wide and for narrow screens; and their pictures.
    assert_eq!(count("svg"), 11);
    assert_eq!(count("figure"), 5);
    let titles =
        ["spheres of the material", "f against the viewing angle", "lobes in the plane", "f over the outgoing"];
    assert!(titles.iter().all(|title| html.contains(title)));
    assert!(html.contains("12 &lt; 13"));
    assert_eq!((count("script"), count("link")), (0, 0));
    let inside = |address: &String| address.starts_with("data:") || address.starts_with("#picture-");
    assert!(found.iter().filter_map(|(_, e)| attribute(e, "href").or(attribute(e, "src"))).all(|a| inside(&a)));
    let ids: Vec<String> = found.iter().filter_map(|(_, element)| attribute(element, "id")).collect();
    assert_eq!(ids.len(), ids.iter().collect::<BTreeSet<_>>().len(), "ids are unique on the page");
}

#[test]
fn a_view_names_what_it_cannot_find() {
    let subject = glossy();
    let view = View::new(&subject);
    let message = view.clone().channel(&subject, "green").expect_err("no such channel").to_string();
    assert_eq!(message, "found no channel green; expected one of Y");
    let message = view.lit_from(&subject, Side::Back).expect_err("one side").to_string();
    assert_eq!(message, "found no values for light from the back");
}
