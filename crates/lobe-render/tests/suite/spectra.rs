//! Tests of pictures of wavelengths and of polarised light.

use std::path::Path;

use lobe_render::picture::{Light as Followed, Meta, inspect, read_partial_in, write_exr_in};
use lobe_render::scene::{AnyScene, Scene};
use lobe_render::shader::Backend;
use lobe_render::{Bands, Channels, Film, Rect, Rgb, Settings, StokesRgb, Transport, merge_in, render};

const FIXTURES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures");

pub fn parse(text: &str, backend: Backend) -> AnyScene {
    AnyScene::parse(Path::new("scene.toml"), Path::new(FIXTURES), text, backend)
        .unwrap_or_else(|error| panic!("{error}"))
}

pub fn refused(text: &str) -> String {
    match AnyScene::parse(Path::new("scene.toml"), Path::new(FIXTURES), text, Backend::best()) {
        Ok(_) => panic!("not refused: {text}"),
        Err(error) => error.to_string(),
    }
}

pub fn bands16(text: &str, backend: Backend) -> Scene<Bands<16>> {
    match parse(text, backend) {
        AnyScene::Bands16(scene) => scene,
        other => panic!("{other:?}"),
    }
}

fn stokes(text: &str, backend: Backend) -> Scene<StokesRgb> {
    match parse(text, backend) {
        AnyScene::StokesRgb(scene) => scene,
        other => panic!("{other:?}"),
    }
}

pub fn settings<T: Transport>(scene: &Scene<T>, samples: u32, backend: Backend) -> Settings<T> {
    let window = Rect { x: 0, y: 0, width: scene.size[0], height: scene.size[1] };
    Settings {
        camera: scene.camera,
        size: scene.size,
        window,
        filter: scene.filter,
        integrator: scene.integrator.clone(),
        samples: 0..samples,
        backend,
        threads: 2,
        time: None,
    }
}

pub fn picture<T: Transport>(scene: &Scene<T>, settings: &Settings<T>) -> Film<T> {
    let (film, stats) = render(&scene.world, settings, Film::new(settings.window), |_| true).unwrap();
    assert_eq!(stats.invalid, 0, "samples that are not numbers");
    film
}

/// The mean of each channel over all pixels.
pub fn means<T: Transport>(film: &Film<T>) -> Vec<f64> {
    let mut means = vec![0.0; T::Radiance::COUNT];
    for pixel in 0..film.pixels().len() {
        means.iter_mut().zip(film.radiance(pixel).as_ref()).for_each(|(sum, x)| *sum += f64::from(*x));
    }
    means.iter().map(|sum| sum / film.pixels().len() as f64).collect()
}

pub fn mean_colour<T: Transport>(scene: &Scene<T>, film: &Film<T>) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for colour in film.colours_in(scene.world.basis()) {
        sum.iter_mut().zip(colour).for_each(|(sum, c)| *sum += f64::from(c));
    }
    sum.map(|c| c / film.pixels().len() as f64)
}

const CAMERA: &str = "[camera]\nposition = [0, 1.4, 3.5]\ntarget = [0, 0.5, 0]\n[film]\nwidth = 48\nheight = 36\n";

/// Cloth, a coloured floor, glass, a rough metal, a lamp and a sky.
fn mixed(head: &str) -> String {
    format!(
        "{CAMERA}{head}[integrator]\nsamples = 8\n\
        [material.cloth]\nfile = \"cloth-17x7x17x13.ddr\"\n[material.floor]\nmodel = \"lambert\"\nalbedo = [0.6, 0.3, 0.1]\n\
        [material.glass]\nmodel = \"glass\"\nglass = \"SF11\"\n[material.gold]\nmodel = \"conductor\"\nmetal = \"gold\"\nalpha = 0.3\n\
        [material.paint]\nmodel = \"plastic\"\nalbedo = [0.1, 0.2, 0.5]\nalpha = 0.2\n\
        [[object]]\nshape = \"plane\"\nsize = 6\nmaterial = \"floor\"\n\
        [[object]]\nshape = \"sphere\"\nradius = 0.5\ntranslate = [-1, 0.5, 0]\nmaterial = \"cloth\"\n\
        [[object]]\nshape = \"sphere\"\nradius = 0.5\ntranslate = [0, 0.5, 0.3]\nmaterial = \"glass\"\n\
        [[object]]\nshape = \"sphere\"\nradius = 0.4\ntranslate = [1, 0.4, 0]\nmaterial = \"gold\"\n\
        [[object]]\nshape = \"sphere\"\nradius = 0.3\ntranslate = [0.5, 0.3, 1]\nmaterial = \"paint\"\n\
        [[object]]\nshape = \"sphere\"\nradius = 0.4\ntranslate = [1, 3, 1]\nmaterial = \"floor\"\nradiance = 12\nspectrum = \"A\"\n\
        [[light]]\nkind = \"environment\"\nzenith = [0.2, 0.3, 0.8]\nhorizon = 0.6\n"
    )
}

#[test]
fn colours_agree_with_red_green_and_blue() {
    // With one surface between the lamp and the eye, only the upsampling makes a difference.
    let text = |head: &str| {
        format!(
            "{CAMERA}{head}[integrator]\ndepth = 1\nsamples = 16\n[material.floor]\nmodel = \"lambert\"\nalbedo = [0.6, 0.3, 0.1]\n\
            [[object]]\nshape = \"plane\"\nsize = 40\nmaterial = \"floor\"\n\
            [[light]]\nkind = \"environment\"\nradiance = 1\n"
        )
    };
    let rgb = match parse(&text(""), Backend::best()) {
        AnyScene::Rgb(scene) => scene,
        other => panic!("{other:?}"),
    };
    let expected = mean_colour(&rgb, &picture(&rgb, &settings(&rgb, 16, Backend::best())));
    let scene = bands16(&text("[spectrum]\nbands = 16\n"), Backend::best());
    let found = mean_colour(&scene, &picture(&scene, &settings(&scene, 16, Backend::best())));
    for (found, expected) in found.into_iter().zip(expected) {
        // Under white light, spectra multiply like colours.
        assert!((found - expected).abs() < 1e-3, "{found}, not {expected}");
    }
    // Polarised or not, it is the same light.
    let polarised = stokes(&text("[spectrum]\nstokes = true\n"), Backend::best());
    let film = picture(&polarised, &settings(&polarised, 16, Backend::best()));
    for (found, expected) in mean_colour(&polarised, &film).into_iter().zip(expected) {
        assert!((found - expected).abs() < 1e-5, "{found}, not {expected}");
    }
}

#[test]
fn white_surfaces_vanish_in_every_band() {
    let text = format!(
        "{CAMERA}[spectrum]\nwavelengths = [420, 480, 500.5, 550, 590, 610, 640, 680, 700]\n[integrator]\nsamples = 16\n\
        [material.white]\nmodel = \"lambert\"\nalbedo = 1\n[material.glass]\nmodel = \"glass\"\nglass = \"diamond\"\n\
        [[object]]\nshape = \"sphere\"\nradius = 0.5\ntranslate = [-0.6, 0.5, 0]\nmaterial = \"white\"\n\
        [[object]]\nshape = \"sphere\"\nradius = 0.5\ntranslate = [0.6, 0.5, 0]\nmaterial = \"glass\"\n\
        [[light]]\nkind = \"environment\"\nradiance = 1\nspectrum = \"E\"\n"
    );
    let scene = bands16(&text, Backend::best());
    let film = picture(&scene, &settings(&scene, 64, Backend::best()));
    let means = means(&film);
    for mean in &means[..9] {
        assert!((mean / means[0] - 1.0).abs() < 0.02 && (mean - 1.0).abs() < 0.1, "{means:?}");
    }
    assert!(means[9..].iter().all(|mean| *mean == 0.0), "bands that are not there: {means:?}");
}

#[test]
fn pictures_are_the_same_bits_on_every_backend_and_for_any_number_of_threads() {
    for stokes_too in [false, true] {
        let head = format!("[spectrum]\nbands = 12\nstokes = {stokes_too}\n");
        fn films<T: Transport>(open: impl Fn(Backend) -> Scene<T>) {
            let mut first: Option<Film<T>> = None;
            for backend in Backend::available().into_iter().map(|backend| backend.strict()) {
                let scene = open(backend);
                let settings = settings(&scene, 3, backend);
                let film = picture(&scene, &settings);
                let alone = picture(&scene, &Settings { threads: 1, ..settings });
                assert!(film == alone, "threads on {}", backend.name());
                assert!(*first.get_or_insert_with(|| film.clone()) == film, "{}", backend.name());
            }
        }
        if stokes_too {
            films(|backend| match parse(&mixed(&head), backend) {
                AnyScene::Stokes16(scene) => scene,
                other => panic!("{other:?}"),
            });
        } else {
            films(|backend| bands16(&mixed(&head), backend));
        }
    }
}

#[test]
fn parts_are_written_read_and_merged_exactly() {
    let folder = crate::common::folder();
    let scene = stokes(&mixed("[spectrum]\nstokes = true\n"), Backend::best());
    let basis = scene.world.basis();
    let all = settings(&scene, 6, Backend::best());
    let whole = picture(&scene, &all);
    let meta = |samples| Meta {
        scene: scene.hash.clone(),
        size: scene.size,
        window: all.window,
        samples,
        total: 6,
        timed: false,
        exposure: 0.0,
        version: Meta::VERSION.into(),
        arithmetic: "strict".into(),
    };
    let mut paths = Vec::new();
    for (k, samples) in [0..2, 2..6].into_iter().enumerate() {
        let part = picture(&scene, &Settings { samples: samples.clone(), ..all.clone() });
        let path = folder.path().join(format!("{k}.exr"));
        write_exr_in(&path, &part, basis, &meta(samples), true).unwrap();
        assert!(read_partial_in::<StokesRgb>(&path, basis).unwrap().0 == part);
        let inspected = inspect(&path).unwrap();
        assert!(inspected.has_sums && inspected.light == Followed { wavelengths: vec![], stokes: true });
        paths.push(path);
    }
    assert!(merge_in::<StokesRgb>(&paths, false, basis).unwrap().0 == whole);
    // A part of a picture with another kind of light does not belong to this one.
    assert!(merge_in::<Rgb>(&paths, false, &()).is_err());
}

#[test]
fn files_say_which_wavelengths_they_have() {
    let folder = crate::common::folder();
    let text = mixed("[spectrum]\nwavelengths = [410, 450, 480, 512.5, 530, 550, 580, 600, 620, 700]\n");
    let scene = bands16(&text, Backend::best());
    let all = settings(&scene, 1, Backend::best());
    let film = picture(&scene, &all);
    let meta = Meta {
        scene: "ab".into(),
        size: scene.size,
        window: all.window,
        samples: 0..1,
        total: 1,
        timed: false,
        exposure: 0.0,
        version: Meta::VERSION.into(),
        arithmetic: "strict".into(),
    };
    let path = folder.path().join("bands.exr");
    write_exr_in(&path, &film, scene.world.basis(), &meta, false).unwrap();
    let light = inspect(&path).unwrap().light;
    assert_eq!(light.wavelengths, [410.0, 450.0, 480.0, 512.5, 530.0, 550.0, 580.0, 600.0, 620.0, 700.0]);
    let bytes = std::fs::read(&path).unwrap();
    for name in [&b"S0.512,5nm"[..], b"S0.700nm", b"spectralLayoutVersion"] {
        assert!(bytes.windows(name.len()).any(|window| window == name), "{}", String::from_utf8_lossy(name));
    }
    let basis = light.bands().unwrap().expect("wavelengths");
    assert_eq!(basis.wavelengths(), scene.world.basis().wavelengths());
    // The same bytes every time.
    write_exr_in(&folder.path().join("again.exr"), &film, scene.world.basis(), &meta, false).unwrap();
    assert!(bytes == std::fs::read(folder.path().join("again.exr")).unwrap());
}

/// Sheets across the view, each a plane that faces the camera, in front of a white sky.
pub fn sheets(sheets: &str) -> String {
    format!(
        "[camera]\nposition = [0, 0, 4]\ntarget = [0, 0, 0]\nfield_of_view = 1\n[film]\nwidth = 4\nheight = 4\n\
        [spectrum]\nstokes = true\n[integrator]\nsamples = 4\n{sheets}[[light]]\nkind = \"environment\"\nradiance = 1\n"
    )
}

pub fn sheet(name: &str, model: &str, at: f64) -> String {
    format!(
        "[material.{name}]\n{model}\n[[object]]\nshape = \"plane\"\nsize = 4\nrotate = [90, 0, 0]\ntranslate = [0, 0, {at}]\n\
        material = \"{name}\"\n"
    )
}

/// The mean of the Stokes components of green.
pub fn seen(text: &str) -> [f64; 4] {
    let scene = stokes(text, Backend::best());
    let film = picture(&scene, &settings(&scene, 4, Backend::best()));
    let means = means(&film);
    [0, 1, 2, 3].map(|component| means[3 * component + 1])
}

#[test]
fn two_polarisers_pass_light_by_the_law_of_malus() {
    for degrees in [0.0, 20.0, 45.0, 70.0, 90.0] {
        let near = sheet("near", "model = \"polariser\"\nangle = 0", 1.0);
        let far = sheet("far", &format!("model = \"polariser\"\nangle = {degrees}"), 0.0);
        let [s0, s1, s2, s3] = seen(&sheets(&(near + &far)));
        let expected = 0.5 * f64::to_radians(degrees).cos().powi(2);
        assert!((s0 - expected).abs() < 1e-5, "{degrees} degrees: {s0}, not {expected}");
        // Light that passes the nearer one is polarised along its axis, the right of the picture.
        assert!((s1 - s0).abs() < 1e-5 && s2.abs() < 1e-5 && s3.abs() < 1e-5, "{s0} {s1} {s2} {s3}");
    }
}

#[test]
fn a_quarter_wave_plate_makes_circular_light() {
    let quarter = sheet("quarter", "model = \"retarder\"\nangle = 0\nretardance = 90", 1.0);
    let polariser = sheet("polariser", "model = \"polariser\"\nangle = 45", 0.0);
    let [s0, s1, s2, s3] = seen(&sheets(&(quarter + &polariser)));
    // The upward part of light along the diagonal is delayed by a quarter of a wave, so the field turns from the right to
    // the top, counterclockwise: left circular light.
    assert!((s0 - 0.5).abs() < 1e-5 && (s3 + 0.5).abs() < 1e-5, "{s0} {s1} {s2} {s3}");
    assert!(s1.abs() < 1e-5 && s2.abs() < 1e-5, "{s0} {s1} {s2} {s3}");
}

#[test]
fn a_pane_at_brewsters_angle_mirrors_light_of_one_plane() {
    let angle = 1.5f64.atan();
    let (y, z) = (4.0 * angle.cos(), 4.0 * angle.sin());
    let text = format!(
        "[camera]\nposition = [0, {y}, {z}]\ntarget = [0, 0, 0]\nfield_of_view = 0.02\n[film]\nwidth = 4\nheight = 4\n\
        [spectrum]\nstokes = true\n[integrator]\nsamples = 16\n[material.water]\nmodel = \"glass\"\neta = 1.5\n\
        [material.black]\nmodel = \"lambert\"\nalbedo = 0\n\
        [[object]]\nshape = \"plane\"\nsize = 4\nmaterial = \"water\"\n\
        [[object]]\nshape = \"plane\"\nsize = 40\ntranslate = [0, -1, 0]\nmaterial = \"black\"\n\
        [[light]]\nkind = \"environment\"\nradiance = 1\n"
    );
    let [s0, s1, s2, s3] = seen(&text);
    // The reflectance there, half of ((n^2 - 1) / (n^2 + 1))^2, with noise from the choice between reflection and
    // refraction.
    assert!(s0 > 0.02 && s0 < 0.2, "{s0}");
    // The direction across the plane of incidence is the right of the picture.
    assert!((s1 / s0 - 1.0).abs() < 1e-5 && (s2 / s0).abs() < 1e-4 && (s3 / s0).abs() < 1e-4, "{s0} {s1} {s2} {s3}");
}

#[test]
fn the_degree_of_polarisation_is_at_most_one() {
    let scene = stokes(&mixed("[spectrum]\nstokes = true\n"), Backend::best());
    let film = picture(&scene, &settings(&scene, 16, Backend::best()));
    let mut polarised = 0;
    for pixel in 0..film.pixels().len() {
        let radiance = film.radiance(pixel);
        for channel in 0..3 {
            let [s0, s1, s2, s3] = radiance.0.map(|component| f64::from(component[channel]));
            let degree = (s1 * s1 + s2 * s2 + s3 * s3).sqrt();
            assert!(degree <= s0 * (1.0 + 1e-4) + 1e-6, "{s0} {s1} {s2} {s3}");
            polarised += usize::from(degree > 0.05 * s0);
        }
    }
    assert!(polarised > 200, "{polarised} values are polarised");
    // The light of both is the same.
    let AnyScene::Rgb(plain) = parse(&mixed(""), Backend::best()) else { panic!("not red, green and blue") };
    let expected = mean_colour(&plain, &picture(&plain, &settings(&plain, 64, Backend::best())));
    let scene = stokes(&mixed("[spectrum]\nstokes = true\n"), Backend::best());
    let found = mean_colour(&scene, &picture(&scene, &settings(&scene, 64, Backend::best())));
    for (found, expected) in found.into_iter().zip(expected) {
        assert!((found / expected - 1.0).abs() < 0.05, "{found}, not {expected}");
    }
}

#[test]
fn limited_light_is_not_more_polarised_than_it_is_bright() {
    let text = mixed("[spectrum]\nstokes = true\n").replace("samples = 8", "samples = 8\nlimit = 0.05");
    let scene = stokes(&text, Backend::best());
    let film = picture(&scene, &settings(&scene, 8, Backend::best()));
    for pixel in 0..film.pixels().len() {
        let radiance = film.radiance(pixel);
        for channel in 0..3 {
            let [s0, s1, s2, s3] = radiance.0.map(|component| f64::from(component[channel]));
            let degree = (s1 * s1 + s2 * s2 + s3 * s3).sqrt();
            assert!(degree <= s0 * (1.0 + 1e-4) + 1e-6, "{s0} {s1} {s2} {s3}");
        }
    }
}

#[test]
fn a_sensor_that_counts_energy_sees_the_first_component() {
    let whole = stokes(&mixed("[spectrum]\nstokes = true\n"), Backend::best());
    let whole = picture(&whole, &settings(&whole, 8, Backend::best()));
    let text = mixed("[spectrum]\nstokes = true\nsensor = \"energy\"\n");
    let AnyScene::EnergyRgb(scene) = parse(&text, Backend::best()) else { panic!("not the energy") };
    let energy = picture(&scene, &settings(&scene, 8, Backend::best()));
    // The same numbers, so the same bits.
    for (energy, whole) in energy.pixels().iter().zip(whole.pixels()) {
        assert_eq!(energy.radiance.0[0], whole.radiance.0[0]);
    }
    assert_eq!(energy.pixels()[0].radiance.0.len(), 1);
    // Crossed polarisers are dark for it, too.
    let near = sheet("near", "model = \"polariser\"\nangle = 10", 1.0);
    let crossed = sheets(&(near + &sheet("far", "model = \"polariser\"\nangle = 100", 0.0)));
    let text = crossed.replace("stokes = true", "bands = 4\nstokes = true\nsensor = \"energy\"");
    let AnyScene::Energy16(scene) = parse(&text, Backend::best()) else { panic!("not the energy") };
    assert!(means(&picture(&scene, &settings(&scene, 4, Backend::best()))).iter().all(|mean| mean.abs() < 1e-6));
}

#[test]
fn mistakes_are_named() {
    let world = "[material.a]\nmodel = \"lambert\"\nalbedo = 0.5\n";
    for (text, expected) in [
        (format!("{CAMERA}[spectrum]\nbands = 40\n"), "spectrum.bands"),
        (format!("{CAMERA}[spectrum]\nwavelengths = [500, 400]\n"), "wavelength 1 is 400"),
        (format!("{CAMERA}[spectrum]\nwavelengths = [1500, 1600]\n"), "some from 380 to 780"),
        (format!("{CAMERA}[spectrum]\nbands = 8\nwavelengths = [500]\n"), "either `bands` or `wavelengths`"),
        (format!("{CAMERA}[spectrum]\nbands = 20\nstokes = true\n"), "at most 16"),
        (format!("{CAMERA}[spectrum]\nbands = 8\nsensor = \"energy\"\n"), "expected `stokes = true` with it"),
        (format!("{CAMERA}[spectrum]\nstokes = true\nsensor = \"eye\"\n"), "expected stokes or energy"),
        (format!("{CAMERA}[spectrum]\nband = 8\n"), "did you mean `bands`?"),
        (
            format!("{CAMERA}[spectrum]\n[integrator]\nkind = \"whitted\"\n"),
            "expected path for a picture with [spectrum]",
        ),
        (format!("{CAMERA}{world}[[light]]\nkind = \"environment\"\nradiance = 1\nspectrum = \"D66\"\n"), "D66"),
        (
            format!("{CAMERA}{world}[[light]]\nkind = \"environment\"\nradiance = [1, 2, 3]\nspectrum = \"A\"\n"),
            "radiance",
        ),
        (format!("{CAMERA}{world}[[light]]\nkind = \"environment\"\nradiance = 1\ntemperature = 3\n"), "temperature"),
        (format!("{CAMERA}[material.a]\nmodel = \"glass\"\nglass = \"amber\"\n"), "expected one of BK7"),
        (format!("{CAMERA}[material.a]\nmodel = \"glass\"\nglass = \"BK7\"\neta = 1.5\n"), "one of `eta`"),
        (format!("{CAMERA}[material.a]\nmodel = \"mirror\"\nmetal = \"brass\"\n"), "expected one of aluminium"),
        (format!("{CAMERA}[material.a]\nmodel = \"lambert\"\nalbedo = \"missing.csv\"\n"), "missing.csv"),
    ] {
        let error = refused(&text);
        assert!(error.contains(expected), "{error}\nnot: {expected}");
    }
}
