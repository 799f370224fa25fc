//! `lobe plot` and `lobe preview` show the same colours.

use std::f32::consts::TAU;
use std::path::{Path, PathBuf};

use lobe::{Backend, Options};
use lobe_plot::{Subject, View};
use lobe_render::TransportMode;
use lobe_render::shader::{Evaluated, Scratch, open};
use rayon::prelude::*;

/// The files of a folder, and of the folders in it.
fn files(folder: &Path) -> Vec<PathBuf> {
    let of = |path: PathBuf| if path.is_dir() { files(&path) } else { vec![path] };
    lobe_testing::files::files(folder).into_iter().flat_map(of).collect()
}

/// Pairs of unit vectors on all four combinations of sides.
fn pairs() -> (Vec<[f32; 3]>, Vec<[f32; 3]>) {
    let direction = |theta: f32, phi: f32| [theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos()];
    let pair = |at: usize| {
        let [a, b, c] = [0.618_034, 0.754_878, 0.569_84].map(|step: f32| (step * at as f32).fract());
        let (wi, wo) = (direction(1.3 * a, TAU * c), direction(1.3 * b, TAU * c + 2.2 + 2.0 * a));
        let below = |[x, y, z]: [f32; 3], is_below| [x, y, if is_below { -z } else { z }];
        (below(wi, at % 4 == 3), below(wo, at % 4 >= 2))
    };
    (0..400).map(pair).unzip()
}

#[test]
fn plot_and_preview_agree_on_the_colour_of_every_file() {
    let Some(folder) = lobe_testing::files::shared_file("data") else { return };
    let (wi, wo) = pairs();
    let coloured: Vec<bool> = files(&folder).par_iter().filter_map(|path| is_coloured(path, &wi, &wo)).collect();
    let (compared, coloured) = (coloured.len(), coloured.iter().filter(|coloured| **coloured).count());
    println!("compared {compared} files, {coloured} of them in colour");
    assert!(compared > 30 && coloured > 10, "{compared} files, {coloured} in colour");
}

/// Compares the colours of a file; `None` if it has no values for pairs of directions. `true` if they are not greys.
fn is_coloured(path: &Path, wi: &[[f32; 3]], wo: &[[f32; 3]]) -> Option<bool> {
    let subject = Subject::open(path).ok()?;
    let shader = open(path, &Options::default(), Backend::detect().expect("a backend"))
        .expect("a file that can be drawn can be rendered");
    if shader.delta().is_some() {
        return None;
    }
    let (mut rendered, mut pdf) = (vec![[0.0; 3]; wi.len()], vec![0.0; wi.len()]);
    let out = Evaluated { f: &mut rendered, pdf: &mut pdf };
    shader.eval(TransportMode::Radiance, wi, wo, out, &mut Scratch::default());

    let view = View::new(&subject);
    let channels = subject.material().channel_count();
    let mut values = vec![0.0; wi.len() * channels];
    subject.material().eval_batch(wi, wo, &mut values);
    let mut drawn = vec![[0.0; 3]; wi.len()];
    view.colour.apply_batch(&values, &mut drawn);
    let largest = drawn.as_flattened().iter().fold(0.0, |largest: f32, value| largest.max(value.abs()));
    for (at, (drawn, rendered)) in drawn.iter().zip(&rendered).enumerate() {
        for (drawn, rendered) in drawn.iter().zip(rendered) {
            let expected = drawn * wi[at][2].abs();
            let error = (rendered - expected).abs();
            assert!(error <= 1e-5 * largest, "{}: {rendered} instead of {expected}", path.display());
        }
    }
    Some(!view.colour.is_grey())
}
