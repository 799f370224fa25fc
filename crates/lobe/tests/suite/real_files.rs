//! Every file of the shared folder of measurements opens, or is refused for a reason that the message says.

use std::path::{Path, PathBuf};

use lobe::Kind::{self, Klems, Mueller, Rgl, Scattered, Sheet, Specular, Spherical, TensorTree};
use lobe::Material;
use lobe_testing::files::{files, shared};

/// What is to become of a file.
#[derive(Clone, Copy, Debug)]
enum Outcome {
    /// It opens as this, with so many channels.
    Opens(Kind, usize),
    /// It is refused, and the message has this in it.
    Refused(&'static str),
}
use Outcome::{Opens, Refused};

const UNKNOWN: Outcome = Refused("content of no known format");

/// Folders, beginnings of names, and their outcome; the first that fits counts.
const OUTCOMES: &[(&str, &str, Outcome)] = &[
    ("alta_dat", "retro", Opens(Scattered, 1)),
    ("cornell_brdf", "", Opens(Scattered, 31)),
    // Fourier series, compressed.
    ("fourier_bsdf", "", UNKNOWN),
    ("fred_txt", "", Opens(Scattered, 1)),
    ("kaist_pbsdf", "", Opens(Mueller, 5)),
    ("klems_xml", "me", Opens(Klems, 1)),
    ("klems_xml", "mcs6216", Opens(Klems, 1)),
    ("klems_xml", "", Opens(Klems, 2)),
    ("lumos_csv", "", Opens(Scattered, 1)),
    ("mdl_mbsdf", "test_file_format_error", UNKNOWN),
    ("mdl_mbsdf", "test_none", Refused("the end of the file")),
    ("mdl_mbsdf", "test_rgb", Opens(Spherical, 3)),
    ("mdl_mbsdf", "test_reflection_scalar_theta_2_phi_3_transmission", Opens(Sheet, 1)),
    ("mdl_mbsdf", "test", Opens(Spherical, 1)),
    ("mdl_mbsdf", "", Opens(Spherical, 3)),
    // Weights of networks, and a table without a header.
    ("merl_derived", "", UNKNOWN),
    ("nist_mueller_csv", "PTFE.data", Opens(Scattered, 4)),
    // Coefficients of a fit, and a description.
    ("nist_mueller_csv", "", UNKNOWN),
    ("openmaterial3d_json", "asphalt", Opens(Scattered, 32)),
    ("openmaterial3d_json", "material_brdf_schema", UNKNOWN),
    ("rgl_bsdf", "", Opens(Rgl, 3)),
    ("rpc_txt", "EDS10", Opens(Scattered, 1)),
    // A script.
    ("rpc_txt", "construct", UNKNOWN),
    ("speos_anisotropicbsdf", "Gaussian_Fresnel", Opens(Sheet, 2)),
    ("speos_anisotropicbsdf", "", Opens(Scattered, 2)),
    ("tensortree_xml", "", Opens(TensorTree, 1)),
    ("zemax_bsdf", "", Opens(Specular, 1)),
];

/// Folders without measurements.
const OTHERS: [&str; 2] = ["LICENSES", "geometry"];

fn name(path: &Path) -> String {
    path.file_name().expect("a name").to_string_lossy().into_owned()
}

/// A value at directions that every material above the horizon has.
fn check_values(material: &Material, path: &Path) {
    let (wi, wo) = ([[0.48, 0.0, 0.877_268_5]; 2], [[-0.48, 0.0, 0.877_268_5], [-0.48, 0.0, -0.877_268_5]]);
    let mut values = vec![f32::NAN; 2 * material.channel_count()];
    material.eval_batch(&wi, &wo, &mut values);
    assert!(values.iter().all(|value| value.is_finite()), "{}: {values:?}", path.display());
    assert!(values.iter().any(|value| *value > 0.0), "{}: dark at the mirror and straight through", path.display());
}

#[test]
fn every_file_has_its_outcome() {
    let Some(shared) = shared() else { return };
    let folders: Vec<PathBuf> = files(&shared.join("data")).into_iter().filter(|path| path.is_dir()).collect();
    let (mut opened, mut refused, mut failures) = (0, 0, Vec::new());
    for folder in folders.iter().filter(|folder| !OTHERS.contains(&name(folder).as_str())) {
        for path in files(folder) {
            let (below, file) = (name(folder), name(&path));
            let outcome = OUTCOMES.iter().find(|(folder, start, _)| *folder == below && file.starts_with(start));
            let shown = match (Material::open(&path), outcome.map(|outcome| outcome.2)) {
                (Ok(material), Some(Opens(kind, channels))) => {
                    if (material.kind(), material.channel_count()) != (kind, channels) {
                        failures.push(format!("{below}/{file}: {kind} with {channels} channels was expected"));
                    }
                    check_values(&material, &path);
                    opened += 1;
                    let channels = material.channels().names().join(" ");
                    format!("{}, {}: {channels}", material.format(), material.kind())
                }
                (Err(error), Some(Refused(why))) => {
                    let message = error.to_string();
                    if !(message.contains(why) && message.contains(&file)) {
                        failures.push(format!("{message}: {why} was expected"));
                    }
                    refused += 1;
                    format!("refused, {why}")
                }
                (result, outcome) => {
                    failures.push(format!("{below}/{file}: {outcome:?} was expected, not {result:?}"));
                    continue;
                }
            };
            println!("{below}/{file}: {shown}");
        }
    }
    println!("{opened} files opened, {refused} refused");
    assert!(failures.is_empty(), "{}", failures.join("\n"));
    assert!(opened > 50 && refused >= 12, "{opened} opened, {refused} refused");
}

#[test]
fn a_folder_of_a_diffuser_is_one_material() {
    let Some(shared) = shared() else { return };
    let material = Material::open(shared.join("data/rpc_txt")).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(material.kind(), Scattered);
    check_values(&material, Path::new("rpc_txt"));
}
