use lobe::{Backend, Edges, Soa, Table};
use lobe_benches::{baseline, clock, tables, workload::Input};
fn main() {
    for (name, samples) in [("iso", tables::isotropic()), ("aniso", tables::anisotropic())] {
        let table = Table::new(&samples, &Edges::default()).unwrap();
        let scalar = baseline::ScalarTable::new(&samples);
        for input in Input::ALL {
            let n = 65536;
            let p = input.pairs(n);
            let (vi, vo) = p.vectors();
            let (wi, wo) = (Soa::new(&p.wi[0], &p.wi[1], &p.wi[2]), Soa::new(&p.wo[0], &p.wo[1], &p.wo[2]));
            let mut o = vec![0.0f32; 3 * n];
            let mut o2 = o.clone();
            let mut o3 = o.clone();
            let mut o4 = o.clone();
            let mut o5 = o.clone();
            let mut o6 = o.clone();
            let mut o7 = o.clone();
            let avx = Backend::named("avx2").unwrap();
            let sse = Backend::named("sse2").unwrap();
            let sse4 = Backend::named("sse4.1").unwrap();
            let t = clock::interleaved(
                30,
                [
                    &mut || {
                        for i in 0..n {
                            o[3 * i..3 * i + 3].copy_from_slice(&baseline::libm::eval(&scalar, vi[i], vo[i]));
                        }
                    },
                    &mut || {
                        for i in 0..n {
                            o2[3 * i..3 * i + 3].copy_from_slice(&baseline::x87::eval(&scalar, vi[i], vo[i]));
                        }
                    },
                    &mut || avx.fused().run(table.batch(wi, wo, &mut o3)),
                    &mut || avx.strict().run(table.batch(wi, wo, &mut o4)),
                    &mut || sse.run(table.batch(wi, wo, &mut o5)),
                    &mut || sse4.run(table.batch(wi, wo, &mut o6)),
                    &mut || {
                        for i in 0..n {
                            avx.fused().run(table.single(vi[i], vo[i], &mut o7[3 * i..3 * i + 3]))
                        }
                    },
                ],
                || (),
            )
            .map(|t| t / n as f64);
            let d = |a: &[f32], b: &[f32]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
            println!(
                "{name} {:10} libm {:.1} x87 {:.1} avx2 {:.2} ({:.1}x) strict {:.2} ({:.1}x) sse2 {:.2} ({:.1}x) sse4 {:.2} ({:.1}x) single {:.1} ({:.1}x)  diff {:e} {:e} strict==sse {}",
                input.name(),
                t[0],
                t[1],
                t[2],
                t[0] / t[2],
                t[3],
                t[0] / t[3],
                t[4],
                t[0] / t[4],
                t[5],
                t[0] / t[5],
                t[6],
                t[0] / t[6],
                d(&o, &o3),
                d(&o, &o2),
                o4 == o5
            );
        }
    }
}
