//! Sheets prepared for evaluation in SIMD lanes.

use lobe_backend::Backend;
use lobe_lane::{Floats, Ints, Kernel, Lanes, Mask};

use super::blocks::{Block, Blocks, Component};
use super::klems::KlemsMatrix;
use super::klems::lanes::{PatchScratch, Patches};
use super::tensor_tree::lanes::{Walk, positions};
use super::tensor_tree::{Rank, TensorTree};
use crate::directions::Directions;
use crate::invalid::Invalid;
use crate::passes::block::Column;
use crate::passes::pairs::{Evaluate, Pairs, evaluation};
use crate::passes::unit::unit;

/// The bands of wavelengths of a sheet, prepared for evaluation in SIMD lanes.
///
/// The values are those of [`Blocks::eval`], `f` in 1/sr, one channel per band. The directions need not be unit
/// vectors, but their lengths have to be between 1e-15 and 1e15. A query that is within rounding of the border of two
/// patches or cells may get the value of either; see [`Blocks::candidates`].
///
/// In strict form ([`Lanes::strict`](lobe_lane::Lanes::strict)) all backends give the same bits.
#[derive(Clone, Debug)]
pub struct Table {
    bands: Vec<Blocks>,
    /// By [`Block`]: the groups of bands for it.
    groups: [Vec<Group>; 4],
}

/// Bands that share the lookup, for light from one side to one side.
#[derive(Clone, Debug)]
struct Group {
    source: Source,
    members: Members,
}

/// The source of the values of a block.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Source {
    /// The block itself, or the reverse one.
    block: Block,
    /// `true` if this is the reverse one, with the directions exchanged.
    exchanged: bool,
}

#[derive(Clone, Debug)]
enum Members {
    /// The patches of light arriving and leaving, and the bands.
    Klems(Box<[Patches; 2]>, Vec<usize>),
    /// The bands, each with its own tree.
    Trees(Rank, Vec<(usize, Walk)>),
}

impl Table {
    /// Prepares the bands. The values are not copied.
    ///
    /// # Errors
    /// [`Invalid`] if there are more values than a 32-bit index can address, or the rings of a basis are too narrow.
    pub fn new(bands: Vec<Blocks>) -> Result<Self, Invalid> {
        let mut groups: [Vec<Group>; 4] = Default::default();
        for (groups, block) in groups.iter_mut().zip(Block::ALL) {
            for (band, window) in bands.iter().enumerate() {
                let own = Source { block, exchanged: false };
                let reverse = block.reverse().map(|block| Source { block, exchanged: true });
                let mut sources = [Some(own), reverse].into_iter().flatten();
                let answer = sources.find_map(|source| window.block(source.block).map(|component| (component, source)));
                if let Some((component, source)) = answer {
                    add(groups, band, component, source)?;
                }
            }
        }
        Ok(Table { bands, groups })
    }

    /// The bands.
    pub fn bands(&self) -> &[Blocks] {
        &self.bands
    }

    /// Bytes of memory that the table takes.
    pub fn bytes(&self) -> usize {
        let blocks = self.bands.iter().flat_map(|band| Block::ALL.into_iter().filter_map(|block| band.block(block)));
        let values = blocks.map(|component| match component {
            Component::Klems(matrix) => size_of_val(matrix.values()),
            Component::Tree(tree) => size_of_val(tree.nodes()) + size_of_val(tree.values()),
        });
        let walks = self.groups.iter().flatten().map(|group| match &group.members {
            Members::Klems(..) => 0,
            Members::Trees(_, trees) => trees.iter().map(|(_, walk)| walk.bytes()).sum::<usize>(),
        });
        values.sum::<usize>() + walks.sum::<usize>()
    }

    /// Evaluates `f` in 1/sr of many pairs on a backend: `out[query * bands + band]`.
    ///
    /// # Panics
    /// The same as for [`batch`](Self::batch).
    pub fn eval_batch(&self, backend: Backend, wi: Directions<'_>, wo: Directions<'_>, out: &mut [f32]) {
        backend.run(self.batch(wi, wo, out));
    }

    /// The evaluation of many pairs as a kernel, for lanes that are not a [`Backend`]: `out[query * bands + band]`, in
    /// 1/sr.
    ///
    /// # Panics
    /// If the numbers of `wi` and `wo` differ, or the length of `out` is not that number times the number of bands.
    pub fn batch<'a>(
        &'a self,
        wi: Directions<'a>,
        wo: Directions<'a>,
        out: &'a mut [f32],
    ) -> impl Kernel<Out = ()> + 'a {
        evaluation(self, wi, wo, out)
    }
}

/// Adds a band to a matching group, or to a new one.
fn add(groups: &mut Vec<Group>, band: usize, component: &Component, source: Source) -> Result<(), Invalid> {
    let alike = groups.iter_mut().filter(|group| group.source.exchanged == source.exchanged);
    match component {
        Component::Klems(matrix) => {
            if i32::try_from(matrix.values().len()).is_err() {
                let found = format!("{} values", matrix.values().len());
                return Err(Invalid::new("ScatteringData", found, "a matrix that a 32-bit index reaches"));
            }
            let fitting = alike.filter_map(|group| match &mut group.members {
                Members::Klems(bases, bands)
                    if bases[0].basis() == matrix.incident() && bases[1].basis() == matrix.exit() =>
                {
                    Some(bands)
                }
                _ => None,
            });
            match fitting.into_iter().next() {
                Some(bands) => bands.push(band),
                None => {
                    let bases = Box::new([Patches::arriving(matrix.incident())?, Patches::leaving(matrix.exit())?]);
                    groups.push(Group { source, members: Members::Klems(bases, vec![band]) });
                }
            }
        }
        Component::Tree(tree) => {
            let walk = Walk::new(tree)?;
            let fitting = alike.filter_map(|group| match &mut group.members {
                Members::Trees(rank, trees) if *rank == tree.rank() => Some(trees),
                _ => None,
            });
            match fitting.into_iter().next() {
                Some(trees) => trees.push((band, walk)),
                None => groups.push(Group { source, members: Members::Trees(tree.rank(), vec![(band, walk)]) }),
            }
        }
    }
    Ok(())
}

/// The intermediate values of a block.
pub(crate) struct Scratch {
    wi: [Column; 3],
    wo: [Column; 3],
    /// The [`Block`] of a query; -1 if it has none.
    side: Column<i32>,
    valid: Column<i32>,
    patches: PatchScratch,
    /// The patches of light arriving and leaving; later, the first holds the index of the pair.
    pair: [Column<i32>; 2],
    positions: [Column; 4],
    value: Column,
}

impl Evaluate for &Table {
    type Scratch = Scratch;
    const SCRATCH: Scratch = Scratch {
        wi: [Column::<f32>::ZERO; 3],
        wo: [Column::<f32>::ZERO; 3],
        side: Column::<i32>::ZERO,
        valid: Column::<i32>::ZERO,
        patches: PatchScratch::ZERO,
        pair: [Column::<i32>::ZERO; 2],
        positions: [Column::<f32>::ZERO; 4],
        value: Column::<f32>::ZERO,
    };

    fn channel_count(self) -> usize {
        self.bands.len()
    }

    #[inline(always)]
    fn evaluate<L: Lanes>(self, lanes: L, n: usize, pairs: Pairs<'_>, scratch: &mut Scratch, out: &mut [f32]) {
        let seen = scratch.sides(lanes, n, pairs);
        out.fill(0.0);
        // The queries of a block are usually for one side, so the passes for the others have nothing to do.
        let mut block = 0;
        while block < 4 {
            if seen[block] {
                for group in &self.groups[block] {
                    scratch.begin(lanes, n, block);
                    group.run(lanes, n, &self.bands, scratch, out);
                }
            }
            block += 1;
        }
    }
}

impl Scratch {
    /// Unit vectors and sides of queries `0..n`, and the blocks that occur among them.
    #[inline(always)]
    fn sides<L: Lanes>(&mut self, lanes: L, n: usize, Pairs { wi, wo }: Pairs<'_>) -> [bool; 4] {
        let (zero, none) = (lanes.splat(0.0), lanes.splat_int(0));
        let mut seen = [false; 4];
        let mut query = 0;
        while query < n {
            let (wi, wo) = (wi.load(lanes, query), wo.load(lanes, query));
            let (from_above, to_above) = (zero.lt(wi[2]), zero.lt(wo[2]));
            let across = (from_above | wi[2].lt(zero)) & (to_above | wo[2].lt(zero));
            let ((wi, lit), (wo, seen_at)) = (unit(lanes, wi), unit(lanes, wo));
            let mut axis = 0;
            while axis < 3 {
                self.wi[axis].store(lanes, query, wi[axis]);
                self.wo[axis].store(lanes, query, wo[axis]);
                axis += 1;
            }
            // The order of `Block`: by the side that light comes from, transmission first.
            let from = lanes.select_int(from_above, lanes.splat_int(1), none);
            let reflected = lanes.select_int(!(from_above ^ to_above), lanes.splat_int(2), none);
            let side = lanes.select_int(across & lit & seen_at, from + reflected, lanes.splat_int(-1));
            self.side.store(lanes, query, side);
            let mut block = 0;
            while block < 4 {
                seen[block] |= side.eq(lanes.splat_int(block as i32)).any();
                block += 1;
            }
            query += L::LANES;
        }
        seen
    }

    /// Marks the queries for one block as valid.
    #[inline(always)]
    fn begin<L: Lanes>(&mut self, lanes: L, n: usize, block: usize) {
        let mut query = 0;
        while query < n {
            let own = self.side.load(lanes, query).eq(lanes.splat_int(block as i32));
            self.valid.store(lanes, query, lanes.select_int(own, lanes.splat_int(-1), lanes.splat_int(0)));
            query += L::LANES;
        }
    }
}

impl Group {
    /// Adds the values of the valid queries among `0..n` to `out`, which is 0 for them.
    #[inline(always)]
    fn run<L: Lanes>(&self, lanes: L, n: usize, bands: &[Blocks], scratch: &mut Scratch, out: &mut [f32]) {
        let Scratch { wi, wo, valid, patches, pair: [arriving, leaving], positions: at, value, .. } = scratch;
        let (from, to) = if self.source.exchanged { (&*wo, &*wi) } else { (&*wi, &*wo) };
        let none = lanes.splat_int(0);
        match &self.members {
            Members::Klems(bases, members) => {
                let mut side = 0;
                while side < 2 {
                    // The arriving patch is found by the direction in which light travels.
                    let (toward, patch) = if side == 0 { (from, &mut *arriving) } else { (to, &mut *leaving) };
                    bases[side].find(lanes, n, toward, patches, patch, valid);
                    side += 1;
                }
                let stride = lanes.splat_int(bases[1].basis().patches() as i32);
                let mut query = 0;
                while query < n {
                    let pair = arriving.load(lanes, query) * stride + leaving.load(lanes, query);
                    arriving.store(lanes, query, pair);
                    query += L::LANES;
                }
                for &band in members {
                    if let Some(matrix) = matrix(bands[band].block(self.source.block)) {
                        let mut query = 0;
                        while query < n {
                            let found = lanes.gather(matrix.values(), arriving.load(lanes, query));
                            value.store(lanes, query, found.masked(valid.load(lanes, query).lt(none)));
                            query += L::LANES;
                        }
                        scatter(value, band, bands.len(), out);
                    }
                }
            }
            Members::Trees(rank, members) => {
                positions(lanes, n, *rank, from, to, at);
                for (band, walk) in members {
                    if let Some(tree) = tree(bands[*band].block(self.source.block)) {
                        match rank {
                            Rank::Three => walk.run::<L, 3>(lanes, n, tree, at, value),
                            Rank::Four => walk.run::<L, 4>(lanes, n, tree, at, value),
                        }
                        let mut query = 0;
                        while query < n {
                            let found = value.load(lanes, query);
                            value.store(lanes, query, found.masked(valid.load(lanes, query).lt(none)));
                            query += L::LANES;
                        }
                        scatter(value, *band, bands.len(), out);
                    }
                }
            }
        }
    }
}

fn matrix(component: Option<&Component>) -> Option<&KlemsMatrix> {
    match component? {
        Component::Klems(matrix) => Some(matrix),
        Component::Tree(_) => None,
    }
}

fn tree(component: Option<&Component>) -> Option<&TensorTree> {
    match component? {
        Component::Klems(_) => None,
        Component::Tree(tree) => Some(tree),
    }
}

/// Adds values to a band of `out`, `[query][channel]`.
#[inline(always)]
fn scatter(value: &Column, band: usize, channels: usize, out: &mut [f32]) {
    let mut query = 0;
    while query < out.len() / channels {
        out[query * channels + band] += value.one(query);
        query += 1;
    }
}
