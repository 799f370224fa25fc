//! Complete evaluations of tables, called in every way.

use lobe_lane::{Ints, Kernel, Lanes};
use lobe_table::{Directions, Scatter, specular};

use super::lanes::floats;
use super::machine::Machine;
use super::record::{Bound, Record};
use super::tables::{Case, Queries, cases};

/// Records the results of a case.
///
/// It is a function and not a kernel, so that each call enters the backend like the call of a user.
pub(super) fn record(machine: impl Machine) -> Vec<Record> {
    cases().iter().flat_map(|case| evaluate(machine, case)).collect()
}

fn evaluate(machine: impl Machine, case: &Case) -> Vec<Record> {
    let Case { name, table, queries, bounds, .. } = case;
    let channels = table.channel_count();
    let Queries { wi, wo } = queries;
    let mut vectors = vec![f32::NAN; wi.len() * channels];
    machine.eval_batch(table, [wi.into(), wo.into()], &mut vectors);

    let mut components = vec![f32::NAN; vectors.len()];
    let [[ix, iy, iz], [ox, oy, oz]] =
        [wi, wo].map(|w| [0, 1, 2].map(|k| w.iter().map(|v| v[k]).collect::<Vec<f32>>()));
    let columns = [Directions::columns(&ix, &iy, &iz), Directions::columns(&ox, &oy, &oz)];
    machine.eval_batch(table, columns, &mut components);

    let mut single = vec![f32::NAN; vectors.len()];
    for (out, (&wi, &wo)) in single.chunks_exact_mut(channels).zip(wi.iter().zip(wo)) {
        machine.eval(table, wi, wo, out);
    }

    let keep: Vec<i32> = (0..wi.len()).map(|query| i32::from(query * 7 % 5 != 0)).collect();
    let masked = machine.run(Masked { table, queries, keep: &keep });

    let same = |a: f32, b: f32| a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan());
    let agree = |other: &[f32]| vectors.iter().zip(other).map(|(&a, &b)| same(a, b)).collect::<Vec<bool>>();
    let lanes_agree = masked.iter().enumerate().map(|(at, &value)| {
        let expected = if keep[at / channels] == 1 { vectors[at] } else { 0.0 };
        same(value, expected)
    });
    let zeros = vectors.iter().enumerate().filter(|(at, _)| is_nothing(table, wi[at / channels], wo[at / channels]));
    let mut records = vec![
        Record::exact(format!("{name}: components as vectors"), agree(&components)),
        Record::exact(format!("{name}: single as batch"), agree(&single)),
        Record::exact(format!("{name}: lanes as batch, 0 where masked"), lanes_agree.collect::<Vec<bool>>()),
        Record::exact(format!("{name}: 0 where there is no value"), zeros.map(|(_, &x)| x == 0.0).collect::<Vec<_>>()),
    ];
    if bounds.is_some() {
        let finite = vectors.iter().map(|value| value.is_finite()).collect::<Vec<bool>>();
        records.push(Record::exact(format!("{name}: finite"), finite));
    }
    match bounds {
        None => records.push(Record::bounded(format!("{name}: values"), vectors, Bound::StrictOnly)),
        Some(bounds) => records.extend([("values", false), ("values at a step", true)].map(|(what, at_step)| {
            let texels = vectors.chunks_exact(channels).zip(bounds).filter(|(_, allowed)| allowed.at_step == at_step);
            let (values, bounds) = texels.flat_map(|(texel, a)| texel.iter().map(|&x| (x, a.difference))).unzip();
            Record::bounded(format!("{name}: {what}"), values, Bound::Each(bounds))
        })),
    }
    records
}

/// `true` if [`specular::Table`] promises that a pair of directions has no value.
fn is_nothing(table: &specular::Table, wi: [f32; 3], wo: [f32; 3]) -> bool {
    let above = |z: f32| match table.scatter() {
        Scatter::Reflection => z > 0.0,
        Scatter::Transmission => z != 0.0,
    };
    let finite = wi.iter().chain(&wo).all(|c| c.is_finite());
    !(finite && above(wi[2]) && above(wo[2]))
}

/// [`specular::Table::eval_lanes`] as a vectorised renderer calls it, under a mask.
struct Masked<'a> {
    table: &'a specular::Table,
    queries: &'a Queries,
    keep: &'a [i32],
}

impl Kernel for Masked<'_> {
    type Out = Vec<f32>;

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> Vec<f32> {
        let Masked { table, queries: Queries { wi, wo }, keep } = self;
        let channels = table.channel_count();
        // Lanes beyond the last query are also masked, whatever directions they hold.
        let whole = wi.len().next_multiple_of(L::LANES);
        let (mut wi, mut wo, mut keep) = (wi.clone(), wo.clone(), keep.to_vec());
        wi.resize(whole, [f32::NAN; 3]);
        wo.resize(whole, [0.0, 0.0, 1.0]);
        keep.resize(whole, 0);
        let mut out = vec![lanes.splat(f32::NAN); channels];
        let mut columns = vec![Vec::new(); channels];
        let mut at = 0;
        while at < whole {
            let mask = lanes.load_int(&keep[at..]).eq(lanes.splat_int(1));
            table.eval_lanes(lanes, lanes.load_xyz(&wi[at..]), lanes.load_xyz(&wo[at..]), mask, &mut out);
            let mut channel = 0;
            while channel < channels {
                floats(lanes, out[channel], &mut columns[channel]);
                channel += 1;
            }
            at += L::LANES;
        }
        (0..self.queries.wi.len()).flat_map(|query| columns.iter().map(move |column| column[query])).collect()
    }
}
