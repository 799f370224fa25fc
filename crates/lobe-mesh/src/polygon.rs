//! Cuts the polygons of OBJ and PLY files into triangles.

use crate::geometry::wide;

/// The largest number of corners of a polygon that is not star-shaped about its first corner: the time to cut it grows
/// with the square of this number.
pub(crate) const MOST: usize = 4096;

/// The largest number of times that all corners are examined: a polygon that needs more has edges that cross.
const ROUNDS: u32 = 4;

/// A polygon has too many corners.
#[derive(Debug, PartialEq)]
pub(crate) struct TooMany;

/// Appends the triangles of a polygon, with the orientation of the polygon.
///
/// A convex polygon becomes a fan about its first corner, and so does any other polygon that such a fan fills. All
/// others are cut at their ears, in the plane nearest to them. A corner at the place of the one before is left out. A
/// polygon whose edges cross has no inside, so its triangles are arbitrary.
pub(crate) fn triangulate(
    positions: &[[f32; 3]],
    corners: &[u32],
    triangles: &mut Vec<[u32; 3]>,
) -> Result<(), TooMany> {
    let place = |corner: u32| positions[corner as usize];
    let fan = |corners: &[u32], triangles: &mut Vec<[u32; 3]>| {
        triangles.extend((2..corners.len()).map(|i| [corners[0], corners[i - 1], corners[i]]));
    };
    if corners.len() == 3 {
        triangles.push([corners[0], corners[1], corners[2]]);
        return Ok(());
    }
    let mut distinct: Vec<u32> = corners.to_vec();
    distinct.dedup_by(|a, b| place(*a) == place(*b));
    while distinct.len() > 1 && place(distinct[0]) == place(distinct[distinct.len() - 1]) {
        distinct.pop();
    }
    let flat = flattened(positions, &distinct);
    let turn = |[a, b, c]: [usize; 3]| turn([flat[a], flat[b], flat[c]]);
    if (2..distinct.len()).all(|i| turn([0, i - 1, i]) >= 0.0) {
        fan(&distinct, triangles);
        return Ok(());
    }
    if distinct.len() > MOST {
        return Err(TooMany);
    }
    let mut rest: Vec<usize> = (0..distinct.len()).collect();
    // What is known of each corner. Cutting one off can turn only its neighbours into ears, so only they are examined
    // again.
    let mut ears: Vec<Option<bool>> = vec![None; distinct.len()];
    let (mut at, mut failures, mut rounds, mut is_cut) = (0, 0, 0, false);
    while rest.len() > 3 {
        let n = rest.len();
        if failures >= n {
            // Corners on edges and rounding may have made ears of others after all.
            rounds += 1;
            if rounds > ROUNDS || !is_cut {
                break;
            }
            rest.iter().for_each(|&corner| ears[corner] = None);
            (failures, is_cut) = (0, false);
        }
        let ear @ [before, corner, after] = [rest[(at + n - 1) % n], rest[at % n], rest[(at + 1) % n]];
        let is_ear = *ears[corner].get_or_insert_with(|| {
            let triangle = ear.map(|corner| flat[corner]);
            turn(ear) > 0.0 && !rest.iter().any(|&other| is_inside(flat[other], triangle))
        });
        if is_ear {
            triangles.push(ear.map(|corner| distinct[corner]));
            rest.remove(at % n);
            (ears[before], ears[after]) = (None, None);
            // The next ear is not the neighbour, so that not all triangles share a corner.
            (failures, is_cut) = (0, true);
        } else {
            failures += 1;
        }
        at = (at + 1) % rest.len();
    }
    let rest: Vec<u32> = rest.into_iter().map(|corner| distinct[corner]).collect();
    fan(&rest, triangles);
    Ok(())
}

/// The corners as seen along the normal of the polygon, counterclockwise: without the coordinate that changes least.
fn flattened(positions: &[[f32; 3]], corners: &[u32]) -> Vec<[f64; 2]> {
    let place = |index: usize| wide(positions[corners[index % corners.len()] as usize]);
    let origin = place(0);
    let normal: glam::DVec3 = (0..corners.len()).map(|i| (place(i) - origin).cross(place(i + 1) - origin)).sum();
    let size = normal.abs();
    let (u, v, w) = if size.x >= size.y && size.x >= size.z {
        (1, 2, 0)
    } else if size.y >= size.z {
        (2, 0, 1)
    } else {
        (0, 1, 2)
    };
    let (u, v) = if normal[w] < 0.0 { (v, u) } else { (u, v) };
    (0..corners.len()).map(|i| [place(i)[u], place(i)[v]]).collect()
}

/// Twice the area of a triangle, positive if it is counterclockwise.
fn turn([a, b, c]: [[f64; 2]; 3]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// `true` if a point lies in a counterclockwise triangle or on its edge, but is not one of its corners.
fn is_inside(point: [f64; 2], triangle: [[f64; 2]; 3]) -> bool {
    let [a, b, c] = triangle;
    // Nearly all points are not even near it.
    let is_beside = |k: usize| {
        let at = point[k];
        at < a[k].min(b[k]).min(c[k]) || at > a[k].max(b[k]).max(c[k])
    };
    !is_beside(0)
        && !is_beside(1)
        && !triangle.contains(&point)
        && [[a, b, point], [b, c, point], [c, a, point]].into_iter().all(|side| turn(side) >= 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The triangles of a polygon with these corners, in a rotated and tilted plane.
    fn cut(corners: &[[f32; 2]]) -> (Vec<[u32; 3]>, Vec<[f32; 3]>) {
        let positions: Vec<[f32; 3]> = corners.iter().map(|[x, y]| [0.5 * x, x - y, *y]).collect();
        let indices: Vec<u32> = (0..corners.len() as u32).collect();
        let mut triangles = Vec::new();
        triangulate(&positions, &indices, &mut triangles).expect("few corners");
        (triangles, positions)
    }

    fn area(corners: &[[f32; 2]], triangle: [u32; 3]) -> f64 {
        0.5 * turn(triangle.map(|corner| corners[corner as usize].map(f64::from)))
    }

    /// Asserts that the triangles fill the polygon once: all have its orientation, and their areas add up to its area.
    fn fills(corners: &[[f32; 2]]) -> bool {
        let whole: f64 = (0..corners.len() as u32 - 2).map(|i| area(corners, [0, i + 1, i + 2])).sum();
        let (triangles, _) = cut(corners);
        let areas: Vec<f64> = triangles.iter().map(|&t| area(corners, t) * whole.signum()).collect();
        areas.iter().all(|&area| area >= 0.0) && (areas.iter().sum::<f64>() - whole.abs()).abs() < 1e-6
    }

    #[test]
    fn a_polygon_that_is_not_convex_is_filled_once() {
        let l = [[2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0], [0.0, 0.0]];
        let chevron = [[0.0, 0.0], [2.0, 0.0], [1.0, 1.0], [2.0, 2.0], [0.0, 2.0], [0.5, 1.0]];
        let dart = [[0.0, 0.0], [2.0, 1.0], [0.0, 2.0], [0.5, 1.0]];
        // Corners in the middle of edges.
        let square = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 2.0], [1.0, 2.0], [1.0, 1.0], [0.0, 1.0]];
        // A ring that is cut open: two of its corners occur twice.
        let ring = [
            [0.0, 0.0],
            [4.0, 0.0],
            [4.0, 4.0],
            [0.0, 4.0],
            [0.0, 0.0],
            [1.0, 1.0],
            [1.0, 3.0],
            [3.0, 3.0],
            [3.0, 1.0],
            [1.0, 1.0],
        ];
        let comb: Vec<[f32; 2]> = (0..100u8)
            .map(|i| [f32::from(i), if i % 2 == 0 { 0.0 } else { 5.0 }])
            .chain([[99.0, -1.0], [0.0, -1.0]])
            .collect();
        let spiral: Vec<[f32; 2]> = (0..60)
            .map(|i| (i as f32 * 0.4, 1.0 + 0.1 * i as f32))
            .chain((0..60).rev().map(|i| (i as f32 * 0.4, 0.7 + 0.1 * i as f32)))
            .map(|(angle, radius)| [radius * angle.cos(), radius * angle.sin()])
            .collect();
        for corners in [&l[..], &chevron, &dart, &square, &ring, &comb, &spiral] {
            for first in 0..corners.len() {
                let mut turned = corners.to_vec();
                turned.rotate_left(first);
                assert!(fills(&turned), "{turned:?}");
                turned.reverse();
                assert!(fills(&turned), "{turned:?}");
            }
        }
    }

    #[test]
    fn convex_polygons_are_fans_and_corners_are_counted_once() {
        let (triangles, _) = cut(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
        assert_eq!(triangles, [[0, 1, 2], [0, 2, 3]]);
        let (triangles, _) = cut(&[[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.0, 0.0]]);
        assert_eq!(triangles, [[0, 1, 3], [0, 3, 4]], "the first corner is named again at the end");
    }

    #[test]
    fn a_polygon_of_many_corners_takes_no_time() {
        let spiral = |count: usize| -> Vec<[f32; 2]> {
            let arm = |i: usize, gap: f32| (i as f32 * 0.05, gap + 0.02 * i as f32);
            let arms = (0..count / 2).map(|i| arm(i, 1.0)).chain((0..count / 2).rev().map(|i| arm(i, 0.95)));
            arms.map(|(angle, radius)| [radius * angle.cos(), radius * angle.sin()]).collect()
        };
        assert!(fills(&spiral(600)));
        // Crossing edges leave no ears to be found.
        let crossing = (0..MOST).map(|i| [(i * 7919 % 4093) as f32, (i * 104_729 % 4091) as f32]).collect();
        for corners in [spiral(MOST), crossing] {
            let begun = std::time::Instant::now();
            cut(&corners);
            // This takes a tenth of a second; it took minutes when every corner was examined for every ear.
            assert!(begun.elapsed() < std::time::Duration::from_secs(20), "{:?}", begun.elapsed());
        }
    }

    #[test]
    fn polygons_without_inside_are_no_trouble() {
        let bow = [[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]];
        assert_eq!(cut(&bow).0.len(), 2);
        cut(&[[0.0, 0.0], [1.0, 1.0], [2.0, 2.0], [3.0, 3.0]]);
        cut(&[[0.0, 0.0]; 5]);
        let star: Vec<[f32; 2]> = (0..5)
            .map(|i| {
                let a = 2.513_274 * i as f32;
                [a.cos(), a.sin()]
            })
            .collect();
        assert_eq!(cut(&star).0.len(), 3);
        let comb: Vec<[f32; 3]> =
            (0..MOST as u32 + 1).map(|i| [i as f32, (i % 2) as f32, 0.0]).chain([[0.0, -9.0, 0.0]]).collect();
        let corners: Vec<u32> = (0..comb.len() as u32).collect();
        assert_eq!(triangulate(&comb, &corners, &mut Vec::new()), Err(TooMany));
    }
}
