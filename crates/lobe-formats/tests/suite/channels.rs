//! The map of channels from one format to another.

use lobe_colour::WHITE;
use lobe_formats::{ChannelMap, Format};
use lobe_table::Channels;

#[test]
fn neutral_stays_neutral_in_every_format() {
    for from in [Channels::Rgb, Channels::Xyz] {
        for format in [Format::WindowXml, Format::Zemax, Format::Ddr] {
            let map = ChannelMap::new(&from, None, format).expect("colours");
            let grey = if from == Channels::Xyz { WHITE.map(|c| 0.5 * c as f32) } else { [0.5; 3] };
            let white = match (&map.channels, format) {
                (Channels::Rgb, _) | (_, Format::WindowXml) => [1.0; 3],
                _ => WHITE,
            };
            for (found, white) in map.apply(&grey).iter().zip(white) {
                assert!((f64::from(*found) - 0.5 * white).abs() < 1e-6, "{found} in {format}");
            }
        }
    }
}
