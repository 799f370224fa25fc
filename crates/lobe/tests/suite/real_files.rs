//! Every file in the shared folder of measurements opens, or is refused with a message that gives the reason.

use std::path::{Path, PathBuf};

use lobe::table::fourier::KIND as FOURIER;
use lobe::table::mueller::KIND as MUELLER;
use lobe::table::rgl::KIND as RGL;
use lobe::table::scattered::KIND as SCATTERED;
use lobe::table::specular::KIND as SPECULAR;
use lobe::table::spherical::KIND as SPHERICAL;
use lobe::table::window::klems::KIND as KLEMS;
use lobe::table::window::tensor_tree::KIND as TENSOR_TREE;
use lobe::table::zernike::KIND as ZERNIKE;
use lobe::{Kind, Material, SHEET};
use lobe_testing::files::{files, shared};

/// The expected outcome for a file.
#[derive(Clone, Copy, Debug)]
enum Outcome {
    /// It opens as this kind, with this many channels.
    Opens(Kind, usize),
    /// It is refused with a message that contains this text.
    Refused(&'static str),
}
use Outcome::{Opens, Refused};

const UNKNOWN: Outcome = Refused("content of no known format");

/// Folders, prefixes of names, and their outcome; the first match counts.
const OUTCOMES: &[(&str, &str, Outcome)] = &[
    ("alta_dat", "retro", Opens(SCATTERED, 1)),
    ("cornell_brdf", "", Opens(SCATTERED, 31)),
    // Compressed with gzip.
    ("fourier_bsdf", "roughglass", Opens(FOURIER, 1)),
    ("fourier_bsdf", "", Opens(FOURIER, 3)),
    ("fred_txt", "", Opens(SCATTERED, 1)),
    ("kaist_pbsdf", "", Opens(MUELLER, 5)),
    ("klems_xml", "me", Opens(KLEMS, 1)),
    ("klems_xml", "mcs6216", Opens(KLEMS, 1)),
    ("klems_xml", "", Opens(KLEMS, 2)),
    ("lumos_csv", "", Opens(SCATTERED, 1)),
    ("mdl_mbsdf", "test_file_format_error", UNKNOWN),
    ("mdl_mbsdf", "test_none", Refused("the end of the file")),
    ("mdl_mbsdf", "test_rgb", Opens(SPHERICAL, 3)),
    ("mdl_mbsdf", "test_reflection_scalar_theta_2_phi_3_transmission", Opens(SHEET, 1)),
    ("mdl_mbsdf", "test", Opens(SPHERICAL, 1)),
    ("mdl_mbsdf", "", Opens(SPHERICAL, 3)),
    // A table without a header, and weights of neural networks.
    ("merl_derived", "npf", UNKNOWN),
    ("merl_derived", "", Refused("a zip archive with")),
    ("nist_mueller_csv", "PTFE.data", Opens(SCATTERED, 4)),
    // A description.
    ("nist_mueller_csv", "PTFE.README", UNKNOWN),
    ("nist_mueller_csv", "PTFE.coeff", Opens(ZERNIKE, 4)),
    ("nist_mueller_csv", "", Opens(ZERNIKE, 1)),
    ("openmaterial3d_json", "asphalt", Opens(SCATTERED, 32)),
    ("openmaterial3d_json", "material_brdf_schema", Refused("a JSON file of another kind")),
    ("rgl_bsdf", "", Opens(RGL, 3)),
    ("rpc_txt", "EDS10", Opens(SCATTERED, 1)),
    // A script.
    ("rpc_txt", "construct", UNKNOWN),
    ("speos_anisotropicbsdf", "Gaussian_Fresnel", Opens(SHEET, 2)),
    ("speos_anisotropicbsdf", "", Opens(SCATTERED, 2)),
    ("tensortree_xml", "", Opens(TENSOR_TREE, 1)),
    ("zemax_bsdf", "", Opens(SPECULAR, 1)),
];

/// Folders without measurements.
const OTHERS: [&str; 2] = ["LICENSES", "geometry"];

fn name(path: &Path) -> String {
    path.file_name().expect("a name").to_string_lossy().into_owned()
}

/// A value at directions at which every material should have one.
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
                    format!("{:?}, {}: {channels}", material.format(), material.kind())
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
    assert!(opened > 60 && refused >= 9, "{opened} opened, {refused} refused");
}

#[test]
fn a_folder_of_a_diffuser_is_one_material() {
    let Some(shared) = shared() else { return };
    let material = Material::open(shared.join("data/rpc_txt")).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(material.kind(), SCATTERED);
    check_values(&material, Path::new("rpc_txt"));
}
