//! Work that needs more memory than there is: an error says how much, before the system ends the program.

use crate::common::{Files, diffuse};
use crate::hardening::{SCENE, shell};

#[test]
fn memory_errors_say_how_much_is_needed() {
    let files = Files::new();
    files.write("a.ddr", &diffuse([0.5; 3]));
    files.write("big.toml", &SCENE.replace("width = 24\nheight = 16", "width = 30000\nheight = 4000"));
    files.write("fine.toml", &SCENE.replace("shape = \"sphere\"", "shape = \"sphere\"\nsegments = 1000\nrefine = 5"));
    let names: String = (0..100_000).map(|step| format!(",{:.2}nm", 300.0 + 0.01 * f64::from(step))).collect();
    let row = |theta| format!("10,{theta},0{}\n", ",1".repeat(100_000));
    files.write("wide.csv", &format!("theta_i,theta_o,phi_o{names}\n{}{}{}", row(0), row(40), row(60)));
    let range = "0:80:0.1";
    for command in [
        "render big.toml -o a.exr".into(),
        "render fine.toml -o a.exr".into(),
        "preview a.ddr -o a.exr --size 8192x8192".into(),
        format!("resample a.ddr b.ddr --sigma {range} --psi {range} --theta {range} --phi {range}"),
        format!("generate lambert b.ddr --sigma 0,1,2 --psi 0 --theta {} --phi {}", list(5_000), list(5_000)),
        "generate ggx b.bsdf --to rgl --alpha 0.1,0.4 --zeniths 512 --azimuths 512 --texels 1024 --channel R".into(),
        "compare a.ddr a.ddr --pairs 10000000".into(),
        "albedo a.ddr --sigma 0:80:0.001 --psi 0:90:0.001".into(),
        "check wide.csv".into(),
        "albedo wide.csv".into(),
        "import wide.csv --no-sidecar".into(),
        "plot wide.csv -o wide.svg".into(),
    ] {
        let limit = if command.starts_with("compare") { 500_000 } else { 3_000_000 };
        let (code, _, message) = shell(&files, &format!("ulimit -v {limit}; timeout 100 \"$LOBE\" {command}"));
        let short: String = message.chars().take(2000).collect();
        assert!(
            code == 1 && message.contains(" of memory, of which "),
            "{}: {code} {short}",
            command.chars().take(40).collect::<String>()
        );
    }
}

/// This many knots from 0 to 90 degrees.
fn list(count: usize) -> String {
    let knots: Vec<String> = (0..count).map(|knot| format!("{:.5}", knot as f64 * 90.0 / count as f64)).collect();
    knots.join(",")
}
