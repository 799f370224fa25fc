//! Finds the photons near a place: compares a register of photons with one place at a time.

use lobe::{Backend, Floats, Ints, Kernel, Lanes};
use lobe_lane::Mask;

use super::map::{Candidates, Columns, PARTS, Photons};
use crate::transport::Transport;
use crate::vec3::Vec3;

/// A photon that is near a place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Near {
    /// The index of the place.
    pub place: u32,
    /// The index of the photon.
    pub photon: u32,
}

/// Lists the photons within a radius of places, from place `from` on, until there are at least `most` or all places
/// have been searched. Returns the first place that has not been searched. The photons of a place are in the order of
/// the map.
pub(crate) fn gather<T: Transport>(
    backend: Backend,
    photons: &Photons<T>,
    places: &[Vec3],
    radius: f32,
    from: usize,
    most: usize,
    near: &mut Vec<Near>,
) -> usize {
    near.clear();
    let columns = photons.columns();
    let mut place = from;
    let mut asked = [const { [Candidates { begin: 0, end: 0, row: 0 }; PARTS] }; BLOCK];
    while place < places.len() && near.len() < most {
        let block = &places[place..places.len().min(place + BLOCK)];
        for (from, asked) in block.iter().zip(&mut asked) {
            *asked = photons.candidates(*from, radius);
        }
        compare(backend, &columns, block, &asked, radius, place as u32, near);
        place += block.len();
    }
    place
}

/// Number of places searched before the photons found are used.
const BLOCK: usize = 16;

/// Not generic, so that its kernel is compiled with this crate.
fn compare(
    backend: Backend,
    columns: &Columns<'_>,
    places: &[Vec3],
    asked: &[[Candidates; PARTS]; BLOCK],
    radius: f32,
    first: u32,
    near: &mut Vec<Near>,
) {
    let mut most = 0;
    for asked in &asked[..places.len()] {
        for part in asked {
            most += (part.end - part.begin) as usize;
        }
    }
    let begin = near.len();
    // One more, to be overwritten.
    near.resize(begin + most + 1, Near { place: 0, photon: 0 });
    let count = backend.run(Compare { columns, places, asked, radius, first, near: &mut near[begin..] });
    near.truncate(begin + count);
}

struct Compare<'a> {
    columns: &'a Columns<'a>,
    places: &'a [Vec3],
    asked: &'a [[Candidates; PARTS]; BLOCK],
    radius: f32,
    first: u32,
    near: &'a mut [Near],
}

impl Kernel for Compare<'_> {
    type Out = usize;

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> usize {
        let Compare { columns, places, asked, radius, first, near } = self;
        let [xs, ys, zs] = columns.position;
        let square = lanes.splat(radius * radius);
        let mut count = 0;
        let mut place = 0;
        while place < places.len() {
            let [x, y, z] = lanes.splat_xyz(places[place]);
            let mut part = 0;
            while part < PARTS {
                let Candidates { begin, end, row } = asked[place][part];
                let row = lanes.splat_int(row);
                let mut at = begin as usize;
                while at < end as usize {
                    let (dx, dy, dz) =
                        (lanes.load(&xs[at..]) - x, lanes.load(&ys[at..]) - y, lanes.load(&zs[at..]) - z);
                    let inside = (dx * dx + dy * dy + dz * dz).le(square) & lanes.load_int(&columns.row[at..]).eq(row);
                    let left = end as usize - at;
                    let mut bits = inside.bits() & if left < L::LANES { (1 << left) - 1 } else { u32::MAX };
                    while bits != 0 {
                        near[count] = Near { place: first + place as u32, photon: at as u32 + bits.trailing_zeros() };
                        count += 1;
                        bits &= bits - 1;
                    }
                    at += L::LANES;
                }
                part += 1;
            }
            place += 1;
        }
        count
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::connect::{LightPart, LightVertex, Mis};
    use crate::light::SceneBounds;
    use crate::place::Place;
    use crate::transport::Rgb;

    fn parts(n: usize) -> Vec<LightPart<Rgb>> {
        let at = |i: usize, step: f64| ((i as f64 + 0.5) * step).fract() as f32 * 2.0 - 1.0;
        let vertex = |i: usize| LightVertex {
            place: Place { position: [at(i, 0.819_172), 0.2 * at(i, 0.671_043), at(i, 0.549_700)], ..Place::ZERO },
            wo: [0.0, 0.0, 1.0],
            flux: [i as f32; 3],
            mis: Mis::default(),
            material: 0,
            surfaces: 1 + (i % 3) as u32,
        };
        let part =
            |from: usize, to: usize| LightPart { vertices: (from..to).map(vertex).collect(), ..LightPart::default() };
        vec![part(0, n / 3), part(n / 3, n)]
    }

    const BOUNDS: SceneBounds = SceneBounds { center: [0.0; 3], radius: 1.7 };

    #[test]
    fn near_photons_are_found_once_and_in_order_on_every_backend() {
        let parts = parts(4000);
        let all: Vec<_> = parts.iter().flat_map(|part| &part.vertices).collect();
        for radius in [0.004, 0.05, 0.3, 1.5] {
            let photons = Photons::new(&parts, 2, &BOUNDS, radius);
            assert_eq!(photons.len(), all.iter().filter(|v| v.surfaces >= 2).count());
            let places: Vec<Vec3> =
                all.iter().step_by(37).map(|v| v.place.position.map(|x| x + 0.3 * radius)).collect();
            let mut expected = Vec::new();
            for (place, p) in places.iter().enumerate() {
                for vertex in all.iter().filter(|v| v.surfaces >= 2) {
                    let d = [0, 1, 2].map(|k| vertex.place.position[k] - p[k]);
                    if d[0] * d[0] + d[1] * d[1] + d[2] * d[2] <= radius * radius {
                        expected.push((place as u32, vertex.flux[0]));
                    }
                }
            }
            expected.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
            assert!(expected.len() > places.len() / 4);
            let mut first: Option<Vec<Near>> = None;
            for backend in Backend::available() {
                let (mut from, mut found, mut near) = (0, Vec::new(), Vec::new());
                while from < places.len() {
                    from = gather(backend, &photons, &places, radius, from, 100, &mut near);
                    found.extend(near.iter().copied());
                }
                let mut sorted: Vec<_> =
                    found.iter().map(|near| (near.place, photons.photons()[near.photon as usize].flux[0])).collect();
                sorted.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
                assert!(sorted == expected, "{}, radius {radius}", backend.name());
                assert!(found.is_sorted_by_key(|near| near.place));
                assert!(*first.get_or_insert_with(|| found.clone()) == found, "{}", backend.name());
            }
        }
    }

    #[test]
    fn within_a_cell_photons_are_in_the_order_of_their_paths() {
        let parts = parts(3000);
        let photons = Photons::new(&parts, 0, &BOUNDS, 0.5);
        let mut near = Vec::new();
        gather(Backend::best(), &photons, &[[0.1; 3]], 0.02, 0, 1, &mut near);
        let columns = photons.columns();
        let mut before: Option<(i32, f32)> = None;
        let mut pairs = 0;
        for (row, photon) in columns.row.iter().zip(photons.photons()) {
            if let Some((last, flux)) = before
                && last == *row
            {
                pairs += usize::from(photon.flux[0] > flux);
            }
            before = Some((*row, photon.flux[0]));
        }
        assert!(pairs > 2900, "{pairs}");
        assert_eq!(Photons::<Rgb>::none().len(), 0);
    }
}
