//! The tables of the paper, as printed (Pentium M, 1.8 GHz, SSE).

/// One table: the same work done for three counts, without and with SSE.
#[derive(Clone, Copy, Debug)]
pub struct PaperTable {
    /// Its number.
    pub number: u8,
    /// What is counted.
    pub counted: &'static str,
    /// The counts, as printed.
    pub counts: [&'static str; 3],
    /// The largest of them.
    pub most: f64,
    /// Seconds without SSE, as printed.
    pub scalar: [&'static str; 3],
    /// Seconds with SSE, as printed.
    pub sse: [&'static str; 3],
    /// The speed-up, as printed.
    pub speed_up: [&'static str; 3],
}

impl PaperTable {
    /// Nanoseconds each, without and with SSE, from the longest run.
    pub fn nanoseconds(&self) -> [f64; 2] {
        [self.scalar[2], self.sse[2]].map(|seconds| number(seconds) / self.most * 1e9)
    }

    /// The speed-up by SSE in the longest run.
    pub fn ratio(&self) -> f64 {
        number(self.speed_up[2])
    }
}

fn number(printed: &str) -> f64 {
    printed.parse().expect("a printed number")
}

/// Inverse trigonometric functions.
pub const ACOS: PaperTable = PaperTable {
    number: 1,
    counted: "inverse trigonometric values",
    counts: ["10 M", "20 M", "40 M"],
    most: 40e6,
    scalar: ["1.479", "2.954", "5.908"],
    sse: ["0.084", "0.156", "0.319"],
    speed_up: ["17.6", "18.93", "18.52"],
};

/// Binary searches.
pub const SEARCH: PaperTable = PaperTable {
    number: 2,
    counted: "binary searches",
    counts: ["10 M", "20 M", "40 M"],
    most: 40e6,
    scalar: ["0.9", "1.78", "3.55"],
    sse: ["0.41", "0.79", "1.61"],
    speed_up: ["2.23", "2.25", "2.20"],
};

/// Evaluations of an isotropic table of 7 x 8 x 13.
pub const ISOTROPIC: PaperTable = PaperTable {
    number: 3,
    counted: "isotropic evaluations, table of 7 × 8 × 13",
    counts: ["100 k", "200 k", "400 k"],
    most: 400e3,
    scalar: ["0.085", "0.177", "0.350"],
    sse: ["0.024", "0.050", "0.101"],
    speed_up: ["3.54", "3.54", "3.46"],
};

/// Evaluations of an anisotropic table of 17 x 7 x 17 x 13.
pub const ANISOTROPIC: PaperTable = PaperTable {
    number: 4,
    counted: "anisotropic evaluations, table of 17 × 7 × 17 × 13",
    counts: ["100 k", "200 k", "400 k"],
    most: 400e3,
    scalar: ["0.137", "0.248", "0.495"],
    sse: ["0.040", "0.078", "0.156"],
    speed_up: ["3.43", "3.17", "3.17"],
};

#[cfg(test)]
mod tests {
    use super::*;

    /// The printed speed-ups are the ratios of the printed times, so a typing error above would be found.
    #[test]
    fn speed_ups_follow_from_the_times() {
        for table in [ACOS, SEARCH, ISOTROPIC, ANISOTROPIC] {
            for i in 0..3 {
                let ratio = number(table.scalar[i]) / number(table.sse[i]);
                assert!((ratio / number(table.speed_up[i]) - 1.0).abs() < 0.025, "table {}: {ratio}", table.number);
            }
        }
    }
}
