//! Samples of representations other than specular tables, with their densities and weights, from materials. They are
//! compared with single samples on the scalar backend, and with a specular table.

use std::rc::Rc;
use std::sync::Arc;

use lobe::table::window::tensor_tree::Rank;
use lobe::table::window::{self, Band};
use lobe::{Backend, Bsdf, Data, Given, Material, Options, Sampled, Sampler, SamplerOptions};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg32;

use super::{Contender, Contest, Tolerance, backends};
use crate::tables;
use crate::workload::Input;

/// Tolerance of directions. A histogram has steps, and so has the choice of a lobe, so fused forms may decide
/// differently for a few.
const TOLERANCE: Tolerance = Tolerance { max: 2.5, rms: 3e-2 };

/// The samples: directions, densities, weights.
struct Drawn {
    directions: Vec<[f32; 3]>,
    pdfs: Vec<f32>,
    weights: Vec<f32>,
}

/// From a table of the size of the MERL database.
pub fn half_difference(input: Input, count: usize) -> Contest {
    contest(tables::half_difference([90, 90, 180]).into(), input, count)
}

/// From five wavelengths of Mueller matrices.
pub fn mueller(input: Input, count: usize) -> Contest {
    contest(tables::mueller().into(), input, count)
}

/// From half a grid in spherical coordinates.
pub fn spherical(input: Input, count: usize) -> Contest {
    contest(tables::spherical().into(), input, count)
}

/// From scattered samples.
pub fn scattered(input: Input, count: usize) -> Contest {
    contest(tables::scattered().into(), input, count)
}

/// From the full Klems basis, of reflection and of transmission.
pub fn klems(input: Input, count: usize) -> Contest {
    contest(sheet(tables::klems()), input, count)
}

/// From trees over two squares, of reflection and of transmission.
pub fn tensor_tree(input: Input, count: usize) -> Contest {
    contest(sheet(tables::tensor_tree(Rank::Four)), input, count)
}

fn sheet(window: window::Blocks) -> Data {
    window::Data { bands: vec![Band { wavelength: "Visible".into(), window }] }.into()
}

struct Setup {
    known: Vec<[f32; 3]>,
    u: Vec<[f32; 2]>,
}

fn contest(data: Data, input: Input, count: usize) -> Contest {
    let mut rng = Pcg32::seed_from_u64(2005);
    let setup = Rc::new(Setup {
        known: input.pairs(count).vectors().0,
        u: (0..count).map(|_| [rng.random(), rng.random()]).collect(),
    });
    let (sampler, table) = (Rc::new(sampler(data)), Rc::new(sampler(tables::isotropic().into())));
    let mut first = empty(&sampler, count);
    draw(&sampler, Backend::scalar().strict(), &setup, &mut first);
    let expected = first.directions.as_flattened().iter().map(|&x| f64::from(x)).collect();
    let contenders = backends().into_iter().map(|named| {
        contender(named.name, TOLERANCE, &sampler, &setup, move |sampler, setup, out| {
            draw(sampler, named.backend, setup, out);
        })
    });
    let contenders = contenders.collect();
    let one_by_one = contender("one by one", TOLERANCE, &sampler, &setup, |sampler, setup, out| {
        let channels = sampler.channels().count();
        for query in 0..setup.known.len() {
            let one = query..=query;
            let out = Sampled {
                directions: &mut out.directions[one.clone()],
                pdfs: &mut out.pdfs[one.clone()],
                weights: &mut out.weights[query * channels..][..channels],
            };
            Bsdf::sample_batch(sampler, Backend::scalar(), Given::Light, &setup.known[one.clone()], &setup.u[one], out);
        }
    });
    let table = contender("table", Contender::UNCHECKED, &table, &setup, |sampler, setup, out| {
        draw(sampler, Backend::best(), setup, out);
    });
    Contest { count, contenders, expected, baselines: vec![one_by_one, table] }
}

fn sampler(data: Data) -> Sampler {
    let material = Material::from_samples(data, &Options::default()).expect("data for lanes");
    Sampler::new(Arc::new(material), &SamplerOptions::default()).expect("options that make sense")
}

fn empty(sampler: &Sampler, count: usize) -> Drawn {
    let weights = vec![f32::NAN; count * sampler.channels().count()];
    Drawn { directions: vec![[f32::NAN; 3]; count], pdfs: vec![f32::NAN; count], weights }
}

/// All samples at once, in batches that are not shared among threads.
fn draw(
    sampler: &Sampler,
    backend: Backend,
    Setup { known, u }: &Setup,
    Drawn { directions, pdfs, weights }: &mut Drawn,
) {
    const BATCH: usize = 8192;
    let channels = sampler.channels().count();
    let known = known.chunks(BATCH).zip(u.chunks(BATCH));
    let out = directions.chunks_mut(BATCH).zip(pdfs.chunks_mut(BATCH)).zip(weights.chunks_mut(BATCH * channels));
    for ((known, u), ((directions, pdfs), weights)) in known.zip(out) {
        Bsdf::sample_batch(sampler, backend, Given::Light, known, u, Sampled { directions, weights, pdfs });
    }
}

fn contender(
    name: &'static str,
    tolerance: Tolerance,
    sampler: &Rc<Sampler>,
    setup: &Rc<Setup>,
    run: impl Fn(&Sampler, &Setup, &mut Drawn) + 'static,
) -> Contender {
    let (sampler, setup) = (sampler.clone(), setup.clone());
    let out = empty(&sampler, setup.known.len());
    Contender::new(
        name,
        tolerance,
        out,
        move |out: &mut Drawn| run(&sampler, &setup, out),
        |out| out.directions.as_flattened().to_vec(),
    )
}
