//! Requests that would lose a file, read a stream twice or change nothing are refused; what is printed is less important
//! than what is written.

use crate::common::{Files, diffuse, printed, run, text};
use crate::hardening::SCENE;

/// Two outputs of one command, and folders.
#[test]
fn no_output_replaces_another() {
    let files = Files::new();
    let table = files.write("a.ddr", &diffuse([0.5; 3]));
    let scan = files.write("scan.csv", "theta_i,theta_o,phi_o,f\n30,0,0,1\n30,60,0,2\n30,60,180,3\n");
    std::fs::create_dir(files.path("below")).expect("a folder");
    let (out, same) = (files.path("out.ddr"), files.path("below/../out.ddr"));
    let figure = files.path("out.svg");
    for args in [
        &["resample", text(&table), text(&out), "--fill", "zeros", "--mask", text(&same)][..],
        &["import", text(&scan), "-o", text(&figure), "--to", "csv", "--plot", text(&figure)],
        &["import", text(&scan), "-o", text(&figure), "--to", "csv", "--plot", text(&files.path("below/../out.svg"))],
    ] {
        let (code, _, message) = run(args);
        assert!(code == 1 && message.contains("expected another file to write"), "{args:?}: {code} {message}");
    }
    assert!(!out.exists() && !figure.exists());
    let scene = files.write("scene.toml", SCENE);
    for args in [
        &["man", "--out", text(&table)][..],
        &["farm", "openjd", text(&scene), "--parts", "2", "-o", text(&table)],
        &["man", "--out", "-"],
        &["farm", "openjd", text(&scene), "--parts", "2", "-o", "-"],
    ] {
        let (code, _, message) = run(args);
        assert!(code == 1 && message.contains("expected the name of a folder"), "{args:?}: {code} {message}");
    }
}

/// Standard input can be given to one reader of a stream, and not to other machines.
#[test]
fn standard_input_is_not_shared_with_a_stream() {
    let files = Files::new();
    for (args, expected) in [
        (&["eval", "-", "--pairs", "-"][..], "for both the material and --pairs"),
        (&["farm", "slurm", "-", "--parts", "2", "-o", text(&files.path("a.exr"))], "cannot read"),
        (&["farm", "openjd", "-", "--parts", "2", "-o", text(&files.path("job"))], "cannot read"),
    ] {
        let (code, _, message) = run(args);
        assert!(code == 2 && message.contains(expected), "{args:?}: {code} {message}");
    }
    assert!(!files.path("job").exists());
}

#[test]
fn numbers_out_of_range_and_options_without_effect() {
    let files = Files::new();
    let table = files.write("a.ddr", &diffuse([0.5; 3]));
    let pairs = files.write("pairs.csv", "0,0,1,0,0,1\n");
    let (ddr, svg, png) = (files.path("b.ddr"), files.path("b.svg"), files.path("b.png"));
    let (table, ddr, svg, png) = (text(&table), text(&ddr), text(&svg), text(&png));
    for (args, expected) in [
        (&["preview", table, "-o", png, "--exposure", "nan"][..], "expected stops from -60 to 60"),
        (&["merge", "a.exr", "-o", png, "--exposure", "1e9"], "expected stops from -60 to 60"),
        (&["fit", table, "--model", "lambert", "--limit", "nan"], "found --limit NaN"),
        (&["fit", table, "--model", "lambert", "--limit=-1"], "found --limit -1"),
        (&["fit", table, "--model", "lambert", "--wavelength", "550"], "found --wavelength with lambert"),
        (&["eval", table, "--wo", "0,0,1", "--pairs", text(&pairs)], "cannot be used with"),
        (&["plot", table, "-o", svg, "--theta", "10"], "found --theta, which is for spectra"),
        (&["plot", table, "-o", svg, "--kind", "sphere", "--theta", "10"], "found --theta, which is for spectra"),
        (&["info", table, "--unit", "deg"], "options for tables with named columns (unit)"),
        (&["import", table, "--unit", "deg", "--json"], "options for tables with named columns (unit)"),
        (&["generate", "lambert", ddr, "--sigma", "0,95"], "sigma knots at 95 degrees; expected 0 to 90"),
        (&["generate", "lambert", ddr, "--theta", "0,10,10"], "theta knots at 10 and then 10 degrees"),
        (&["generate", "lambert", ddr, "--phi", "nan"], "phi knots at NaN degrees"),
        (&["resample", table, ddr, "--sigma", "0:100:5"], "sigma knots at 95"),
        (&["resample", table, ddr, "--phi=-10,0"], "phi knots at -10"),
    ] {
        let (code, _, message) = run(args);
        assert!(code == 2 && message.contains(expected), "{args:?}: {code} {message}");
    }
    // Fits of optics programs state the wavelength.
    let csv = files.path("fit.csv");
    printed(&["fit", table, "--model", "abg", "--wavelength", "633", "-o", text(&csv)]);
    assert!(std::fs::read_to_string(csv).expect("a table").contains("0.633"));
    printed(&["resample", table, ddr, "--sigma", "0:90:30", "--phi", "0:360:90", "--theta", "0:180:45"]);
}

/// Whatever happens to what is printed.
#[cfg(target_os = "linux")]
#[test]
fn files_are_written_and_failures_seen_if_nobody_reads() {
    use crate::hardening::shell;
    let files = Files::new();
    files.write("scan.csv", "theta_i,theta_o,phi_o,f\n30,0,0,1\n30,60,0,2\n30,60,180,3\n");
    for to in ["| true", "> /dev/full", ">&-"] {
        let import = "\"$LOBE\" import scan.csv -o out.csv --plot out.svg";
        shell(&files, &format!("{import} {to}"));
        for name in ["out.csv", "out.svg"] {
            assert!(std::fs::remove_file(files.path(name)).is_ok(), "{to}: {name}");
        }
    }
    for help in ["--help", "--version", "help", "info --help"] {
        let (code, _, message) = shell(&files, &format!("\"$LOBE\" {help} > /dev/full"));
        assert!(code == 1 && message.contains("No space left"), "{help}: {code} {message}");
        assert_eq!(shell(&files, &format!("\"$LOBE\" {help} | true")).0, 0, "{help}");
    }
    assert_eq!(shell(&files, "\"$LOBE\" nonsense 2> /dev/full").0, 2);
}
