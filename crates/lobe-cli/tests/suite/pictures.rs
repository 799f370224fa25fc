//! `lobe info` and `lobe plot` of pictures.

use crate::common::{Files, json, printed, run, text};

/// A polariser in front of a white sky, seen from above: its axis is 30 degrees from the right of the picture.
fn scene(spectrum: &str) -> String {
    format!(
        "[camera]\nposition = [0, 2, 0]\ntarget = [0, 0, 0]\nup = [0, 0, -1]\nfield_of_view = 20\n\
         [film]\nwidth = 12\nheight = 8\nfilter = \"box\"\n[integrator]\nkind = \"path\"\nsamples = 4\n{spectrum}\n\
         [material.sheet]\nmodel = \"polariser\"\nangle = 30\n\
         [[object]]\nshape = \"plane\"\nsize = 4\nmaterial = \"sheet\"\n\
         [[light]]\nkind = \"environment\"\nradiance = 1\nspectrum = \"E\"\n"
    )
}

#[test]
fn pictures_of_all_kinds_are_described() {
    let folder = Files::new();
    for (spectrum, wavelengths, stokes) in [
        ("", 0, 1),
        ("[spectrum]\nstokes = true", 0, 4),
        ("[spectrum]\nwavelengths = [450, 512.5, 600]", 3, 1),
        ("[spectrum]\nwavelengths = [450, 512.5, 600]\nstokes = true", 3, 4),
    ] {
        let scene = folder.write("scene.toml", &scene(spectrum));
        let out = folder.path("picture.exr");
        printed(&["render", text(&scene), "-o", text(&out), "--strict"]);
        let info = json(&["info", text(&out)]);
        assert_eq!((info["columns"].as_u64(), info["rows"].as_u64()), (Some(12), Some(8)), "{spectrum}");
        let count = |key: &str| info[key].as_array().expect("a list").len();
        assert_eq!((count("wavelengths"), count("stokes")), (wavelengths, stokes), "{spectrum}");
        assert_eq!(info["rendering"]["samples"], serde_json::json!([0, 4]));
        // Half of the light passes.
        for mean in info["mean"].as_array().expect("means") {
            let mean = mean.as_f64().expect("a number");
            assert!((mean - 0.5).abs() < 0.12, "{spectrum}: {mean}");
        }
        let degree = info["polarisation"]["mean"].as_f64();
        assert!(degree.map_or(stokes == 1, |degree| (degree - 1.0).abs() < 1e-5), "{spectrum}: {degree:?}");
        let said = printed(&["info", text(&out)]);
        assert!(stokes == 1 || said.contains("polarised 100.0 % in the mean, up to 100.0 %"), "{said}");
        assert!(wavelengths == 0 || said.contains("512.5nm 0."), "{said}");
    }
}

#[test]
fn pictures_are_drawn_with_their_polarisation_and_spectra() {
    let folder = Files::new();
    let scene = folder.write("scene.toml", &scene("[spectrum]\nbands = 4\nstokes = true"));
    let (picture, svg, page) = (folder.path("a.exr"), folder.path("a.svg"), folder.path("a.html"));
    printed(&["render", text(&scene), "-o", text(&picture)]);
    let said = printed(&["plot", text(&picture), "-o", text(&svg), "--at", "3,4", "--exposure", "-1"]);
    assert!(said.contains("points at 3,4") && said.contains("exposed at \u{2212}1 EV"), "{said}");
    let drawn = std::fs::read_to_string(&svg).expect("a figure");
    assert!(drawn.contains("1: column 3, row 4: sRGB ") && drawn.contains(", 100.0 % polarised at 30°"), "{drawn}");
    assert!(drawn.contains("4 wavelengths, 400 to 700 nm, Stokes components S0 to S3"), "{drawn}");
    assert!(drawn.contains("wavelength (nm)"), "{drawn}");
    printed(&["plot", text(&picture), "-o", text(&page)]);
    let page = std::fs::read_to_string(&page).expect("a page");
    assert!(page.contains("spectral OpenEXR picture") && page.contains("degree of polarisation (%)"));
    for (more, code, words) in [
        (vec!["--at", "12,0"], 2, "expected a pixel of the 12 x 8"),
        (vec!["--sigma", "30"], 2, "found --sigma, which is for materials"),
        (vec!["--kind", "slices"], 2, "found --kind"),
        (vec!["--unit", "deg"], 2, "found options for tables, but the file is a picture"),
    ] {
        let mut args = vec!["plot", text(&picture), "-o", text(&svg)];
        args.extend(more);
        let (found, _, error) = run(&args);
        assert!(found == code && error.contains(words), "{args:?}: {error}");
    }
    let broken = folder.path("b.exr");
    let bytes = std::fs::read(&picture).expect("bytes");
    std::fs::write(&broken, &bytes[..bytes.len() / 2]).expect("a file");
    assert_eq!(run(&["info", text(&broken)]).0, 1);
}
