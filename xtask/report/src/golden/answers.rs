//! Reads files of answers: each line is `inputs -> outputs`, all of them numbers.

use std::path::Path;

use anyhow::Context;

use lobe_testing::made::spherical;

/// Inputs and outputs.
#[derive(Clone, Debug)]
pub(super) struct Answer {
    pub(super) inputs: Vec<f64>,
    pub(super) outputs: Vec<f64>,
}

impl Answer {
    /// The three inputs from `at` on, normalised because some programs printed single precision.
    pub(super) fn direction(&self, at: usize) -> [f32; 3] {
        let v: [f64; 3] = std::array::from_fn(|k| self.inputs[at + k]);
        let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
        v.map(|x| (x / length) as f32)
    }

    /// The two inputs from `at` on, zenith angle and azimuth in radians, as a unit vector.
    pub(super) fn spherical(&self, at: usize) -> [f32; 3] {
        direction([self.inputs[at], self.inputs[at + 1]])
    }
}

/// The direction of a zenith angle and an azimuth in radians, in the precision of lanes.
pub(super) fn direction(angles: [f64; 2]) -> [f32; 3] {
    spherical(angles).map(|x| x as f32)
}

/// All answers of a file, each with at least this many numbers.
pub(super) fn read(path: &Path, [inputs, outputs]: [usize; 2]) -> anyhow::Result<Vec<Answer>> {
    let text = std::fs::read_to_string(path).with_context(|| path.display().to_string())?;
    let numbers = |text: &str| text.split_whitespace().map(|x| x.parse().ok()).collect::<Option<Vec<f64>>>();
    let answer = |line: &str| {
        let (left, right) = line.split_once("->")?;
        let answer = Answer { inputs: numbers(left)?, outputs: numbers(right)? };
        (answer.inputs.len() >= inputs && answer.outputs.len() >= outputs).then_some(answer)
    };
    let lines = text.lines().enumerate().filter(|(_, line)| !line.starts_with('#') && !line.trim().is_empty());
    lines
        .map(|(at, line)| {
            let expected = || format!("{}:{}: expected {inputs} numbers -> {outputs}", path.display(), at + 1);
            answer(line).with_context(expected)
        })
        .collect()
}
