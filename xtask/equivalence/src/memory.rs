//! Loads, stores and gathers, with every length and with indices far outside.

use lobe_lane::{Block, Kernel, Lanes, MAX_LANES};

use super::Record;
use super::lanes::{floats, ints};
use lobe_testing::patterns;

/// A float that no test writes, to detect the elements that a store leaves untouched.
const UNTOUCHED: f32 = -12345.5;

/// Every operation of [`Lanes`] that touches memory.
pub(super) struct Memory;

impl Kernel for Memory {
    type Out = Vec<Record>;

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> Vec<Record> {
        let mut records = vec![
            Record::exact("load, store", whole(lanes)),
            Record::exact("load_partial, store_partial", partial(lanes)),
        ];
        load_xyz(lanes, &mut records);
        gathers(lanes, &mut records);
        records
    }
}

/// Whole vectors keep their bits, even at unaligned addresses, and stores write nothing beyond them.
#[inline(always)]
fn whole<L: Lanes>(lanes: L) -> Vec<bool> {
    let source: Vec<f32> = (0..2 * MAX_LANES).map(|i| i as f32 + 0.25).collect();
    let mut holds = Vec::new();
    for at in 0..MAX_LANES {
        let mut target = [UNTOUCHED; 2 * MAX_LANES];
        lanes.store(&mut target[at..], lanes.load(&source[at..]));
        holds.extend((0..target.len()).map(|i| {
            let inside = (at..at + L::LANES).contains(&i);
            target[i] == if inside { source[i] } else { UNTOUCHED }
        }));
        let from: Vec<i32> = patterns::INTS[at..][..MAX_LANES].to_vec();
        let mut to = [0x0bad; MAX_LANES + 1];
        lanes.store_int(&mut to[1..], lanes.load_int(&from));
        holds.extend((0..MAX_LANES).map(|i| to[1 + i] == if i < L::LANES { from[i] } else { 0x0bad }));
        holds.push(to[0] == 0x0bad);
    }
    holds
}

/// Every length from zero to more than a vector.
#[inline(always)]
fn partial<L: Lanes>(lanes: L) -> Vec<bool> {
    let source: Vec<f32> = (1..=MAX_LANES + 3).map(|i| i as f32).collect();
    let mut holds = Vec::new();
    for len in 0..=L::LANES + 3 {
        let mut lane = Vec::new();
        floats(lanes, lanes.load_partial(&source[..len]), &mut lane);
        holds.extend((0..L::LANES).map(|i| lane[i] == if i < len { source[i] } else { 0.0 }));

        let mut target = vec![UNTOUCHED; len + 2];
        lanes.store_partial(&mut target[1..=len], lanes.load(&source));
        holds.extend((0..len).map(|i| target[1 + i] == if i < L::LANES { source[i] } else { UNTOUCHED }));
        holds.push(target[0] == UNTOUCHED && target[len + 1] == UNTOUCHED);
    }
    holds
}

#[inline(always)]
fn load_xyz<L: Lanes>(lanes: L, records: &mut Vec<Record>) {
    let vectors: Vec<[f32; 3]> = (0..4 * MAX_LANES).map(|i| [0.0, 0.25, 0.5].map(|part| i as f32 + part)).collect();
    let mut columns = [const { Vec::new() }; 3];
    let mut at = 0;
    while at < vectors.len() {
        let xyz = lanes.load_xyz(&vectors[at..]);
        let mut k = 0;
        while k < 3 {
            floats(lanes, xyz[k], &mut columns[k]);
            k += 1;
        }
        at += L::LANES;
    }
    for (name, column) in ["load_xyz x", "load_xyz y", "load_xyz z"].into_iter().zip(columns) {
        records.push(Record::exact(name, column));
    }
}

#[inline(always)]
fn gathers<L: Lanes>(lanes: L, records: &mut Vec<Record>) {
    let indices = patterns::padded(patterns::INTS.to_vec());
    let (mut singles, mut firsts, mut seconds) = (Vec::new(), Vec::new(), Vec::new());
    for len in [1, 2, 3, 4, 5, 8, 31, 64, 65, 1000] {
        let table: Vec<f32> = (0..len).map(|i| i as f32 + 0.5).collect();
        let pairs: Vec<[f32; 2]> = (0..len).map(|i| [i as f32, -(i as f32) - 0.5]).collect();
        let mut at = 0;
        while at < indices.len() {
            let index = lanes.load_int(&indices[at..]);
            floats(lanes, lanes.gather(&table, index), &mut singles);
            let [first, second] = lanes.gather_pair(&pairs, index);
            floats(lanes, first, &mut firsts);
            floats(lanes, second, &mut seconds);
            at += L::LANES;
        }
    }
    records.push(Record::exact("gather", singles));
    records.push(Record::exact("gather_pair first", firsts));
    records.push(Record::exact("gather_pair second", seconds));

    let mut quads = Vec::new();
    for len in [30, 31, 64, 200] {
        let table: Vec<f32> = (0..len).map(|i| i as f32).collect();
        gather_quads(lanes, &Block::new(&table, [0]), &indices, &mut quads);
        gather_quads(lanes, &Block::new(&table, [4, 0]), &indices, &mut quads);
        gather_quads(lanes, &Block::new(&table, [0, 5, 13, 26]), &indices, &mut quads);
    }
    records.push(Record::exact("gather_quads", quads));

    let eight: [f32; 8] = std::array::from_fn(|i| i as f32 + 0.5);
    let mut looked_up = Vec::new();
    let mut at = 0;
    while at < indices.len() {
        let found = lanes.oct_lookup(lanes.oct_load(&eight), lanes.load_int(&indices[at..]));
        ints(lanes, lobe_lane::Floats::bits(found), &mut looked_up);
        at += L::LANES;
    }
    records.push(Record::exact("oct_lookup", looked_up));
    records.push(Record::exact("look_up 1", look_up::<L, 1>(lanes, &indices)));
    records.push(Record::exact("look_up 2", look_up::<L, 2>(lanes, &indices)));
    records.push(Record::exact("look_up 4", look_up::<L, 4>(lanes, &indices)));
}

/// Checks that each look-up finds its entry in a table whose length depends on the lanes.
#[inline(always)]
fn look_up<L: Lanes, const N: usize>(lanes: L, indices: &[i32]) -> Vec<bool> {
    let entries: [f32; 4 * MAX_LANES] = std::array::from_fn(|i| i as f32 + 0.5);
    let mut table = [lanes.splat(0.0); N];
    let mut register = 0;
    while register < N {
        table[register] = lanes.load(&entries[register * L::LANES..]);
        register += 1;
    }
    let mut found = Vec::new();
    let mut at = 0;
    while at < indices.len() {
        floats(lanes, lanes.look_up(table, lanes.load_int(&indices[at..])), &mut found);
        at += L::LANES;
    }
    let last = (N * L::LANES - 1) as i32;
    found.iter().zip(indices).map(|(&entry, index)| entry == entries[(index & last) as usize]).collect()
}

/// Appends corner after corner and float after float, for all bases, so that the order does not depend on the lanes.
#[inline(always)]
fn gather_quads<L: Lanes, const N: usize>(lanes: L, block: &Block<'_, N, 4>, bases: &[i32], out: &mut Vec<f32>) {
    let mut columns = vec![Vec::new(); 8 * N];
    let mut at = 0;
    while at < bases.len() {
        let corners = lanes.gather_quads(block, lanes.load_int(&bases[at..]));
        let again = lanes.gather_quads_at(block, &bases[at..]);
        let mut k = 0;
        while k < 4 * N {
            floats(lanes, corners[k / 4][k % 4], &mut columns[k]);
            floats(lanes, again[k / 4][k % 4], &mut columns[4 * N + k]);
            k += 1;
        }
        at += L::LANES;
    }
    out.extend(columns.concat());
}
