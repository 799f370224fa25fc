//! Evaluates a table inside your own kernel, as a vectorised renderer does: directions never leave the registers, and
//! nothing is dispatched per query.

use std::error::Error;

use lobe::{Floats, Ints, Kernel, Lanes, Material, specular};

const FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/conductor-7x8x13.ddr");

/// f cos of the first channel for viewers in the plane of incidence, from the horizon at x = -1 to the one at x = 1.
struct Curve<'a> {
    table: &'a specular::Table,
    wi: [f32; 3],
    out: &'a mut [f32],
}

impl Kernel for Curve<'_> {
    type Out = ();

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) {
        let Curve { table, wi, out } = self;
        let step = 2.0 / (out.len() - 1) as f32;
        let mut f = [lanes.splat(0.0); 3];
        let mut at = 0;
        while at < out.len() {
            let index = (lanes.iota() + lanes.splat_int(at as i32)).to_float();
            let x = index * lanes.splat(step) - lanes.splat(1.0);
            let cos = (lanes.splat(1.0) - x * x).max(lanes.splat(0.0)).sqrt();
            let wo = [x, lanes.splat(0.0), cos];
            // Lanes beyond the end of the curve are left out.
            table.eval_lanes(lanes, lanes.splat_xyz(wi), wo, lanes.first_n(out.len() - at), &mut f);
            lanes.store_partial(&mut out[at..], f[0] * cos);
            at += L::LANES;
        }
    }
}

pub(crate) fn main() -> Result<(), Box<dyn Error>> {
    let material = Material::open(FILE)?;
    let table = material.specular_table().ok_or("not a table in specular coordinates")?;
    assert_eq!(material.channel_count(), 3);
    let mut curve = vec![0.0; 41];
    material.backend().run(Curve { table, wi: [0.6, 0.0, 0.8], out: &mut curve });
    let peak = curve.iter().cloned().fold(0.0, f32::max);
    for value in &curve {
        println!("{}", "*".repeat((60.0 * value / peak) as usize));
    }
    assert!(peak > 0.0);
    Ok(())
}
