//! The order of the pixels of a tile.

use crate::film::Rect;

/// The pixels of a tile in Morton order, which keeps neighbours close to each other.
pub(super) fn morton(tile: Rect) -> Vec<[u32; 2]> {
    let side = tile.width.max(tile.height).next_power_of_two();
    let mut pixels = Vec::with_capacity(tile.area());
    for code in 0..u64::from(side) * u64::from(side) {
        let [x, y] = [every_other_bit(code), every_other_bit(code >> 1)];
        if x < tile.width && y < tile.height {
            pixels.push([tile.x + x, tile.y + y]);
        }
    }
    pixels
}

fn every_other_bit(code: u64) -> u32 {
    let mut bits = code & 0x5555_5555_5555_5555;
    for (shift, mask) in [
        (1, 0x3333_3333_3333_3333),
        (2, 0x0f0f_0f0f_0f0f_0f0f),
        (4, 0x00ff_00ff_00ff_00ff),
        (8, 0x0000_ffff_0000_ffff),
        (16, 0xffff_ffff),
    ] {
        bits = (bits | bits >> shift) & mask;
    }
    bits as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_pixel_of_a_tile_occurs_once_and_neighbours_are_close() {
        let tile = Rect { x: 10, y: 20, width: 13, height: 7 };
        let pixels = morton(tile);
        assert_eq!(pixels.len(), 13 * 7);
        assert_eq!(pixels[..4], [[10, 20], [11, 20], [10, 21], [11, 21]]);
        let mut sorted = pixels.clone();
        sorted.sort();
        sorted.dedup();
        assert_eq!(sorted.len(), pixels.len());
    }
}
