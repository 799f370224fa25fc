//! Formats the section as a table and sentences.

use super::Pictures;
use xtask_common::{Grid, nanoseconds, times};

fn percent(share: f64) -> String {
    format!("{:.0} %", 100.0 * share)
}

impl Pictures {
    /// The table.
    pub fn grid(&self) -> Grid {
        Grid::new("Pictures", self.sentence(), self.head(), self.lines()).with_notes(self.notes())
    }

    fn sentence(&self) -> String {
        format!(
            "Frames of {} triangles in {} materials, a measured table of 17 × 7 × 17 × 13 each, on one thread. Hits \
             are queued by material, so that lanes are also in use if neighbouring rays hit different objects, as the \
             last columns show. The column after a bounce is the time of a material per pair of directions or sample.",
            self.triangles, self.materials
        )
    }

    /// As many depths as any backend reached.
    fn depths(&self) -> usize {
        self.frames.iter().map(|frame| frame.lanes_in_use.len()).max().unwrap_or(0)
    }

    fn head(&self) -> Vec<String> {
        let mut head: Vec<String> =
            ["", "frame, ms", "× scalar", "in materials", "after a bounce, ns", "× scalar"].map(Into::into).into();
        head.extend((0..self.depths()).map(|depth| match depth {
            0 => "lanes, first hit".to_owned(),
            depth => format!("bounce {depth}"),
        }));
        head
    }

    fn lines(&self) -> Vec<Vec<String>> {
        let line = |frame: &super::Frame| {
            let scalar = &self.frames[0];
            let mut line = vec![
                frame.backend.to_owned(),
                nanoseconds(frame.milliseconds),
                times(scalar.milliseconds / frame.milliseconds),
                percent(frame.material_share),
                nanoseconds(frame.bounced_nanoseconds),
                times(scalar.bounced_nanoseconds / frame.bounced_nanoseconds),
            ];
            line.extend(frame.lanes_in_use.iter().map(|share| percent(*share)));
            line.resize(6 + self.depths(), String::new());
            line
        };
        self.frames.iter().map(line).collect()
    }

    fn notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        if let (Some(threads), Some(frame)) = (self.threads, self.frames.last()) {
            notes.push(format!(
                "Two threads render the frame at {} the speed of one ({}).",
                times(threads),
                frame.backend
            ));
        }
        for packets in &self.packets {
            notes.push(format!(
                "Packets of four {} rays with SSE2: {:.1} million rays per second, {} the scalar instance of the same code.",
                packets.rays,
                packets.sse2,
                times(packets.sse2 / packets.scalar)
            ));
        }
        for rays in &self.light {
            let met = match rays.generation {
                0 => "as they leave a lamp".to_owned(),
                1 => "after a surface".to_owned(),
                n => format!("after {n} surfaces"),
            };
            notes.push(format!(
                "Light rays {met}: {:.1} million per second one by one; packets as wide as a register give {} that, \
                 packets of 64 {}. {} of the lanes are in use in the materials that they meet.",
                rays.single,
                times(rays.packet / rays.single),
                times(rays.large / rays.single),
                percent(rays.lanes)
            ));
        }
        let others = self.kinds.iter().skip(1);
        notes.extend(others.map(|kind| {
            let (light, ratio) = (kind.light, times(kind.ratio));
            format!("A frame in {light} takes {ratio} the time of one in red, green and blue without polarisation.")
        }));
        notes
    }
}
