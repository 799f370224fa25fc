//! Whole path-traced pictures compared with Mitsuba 3: the same meshes, materials, lights, camera and number of
//! samples.

mod agreement;
mod picture;
mod scene;

use std::path::Path;

use lobe::{Backend, Given};
use lobe_benches::contest::Contender;
use lobe_render::{Film, render};

use super::contest::{Contest, Outside};
use super::exchange::Exchange;
use super::material;
use scene::{Room, Surface, settings};

pub use agreement::{Agreement, Question, grid};

/// The beginning of the names of these contests.
pub const PREFIX: &str = "frame";

/// Width and height of the pictures that are timed.
const SIZE: [u32; 2] = [256, 256];
/// Samples per pixel of these.
const SAMPLES: u32 = 8;
/// Programs that render with the other renderer, one per variant of it, and their displayed names.
const VARIANTS: [(&str, &str); 2] = [("mitsuba-llvm", "Mitsuba llvm_ad_rgb"), ("mitsuba-scalar", "Mitsuba scalar_rgb")];
/// The first of these with vectors of sixteen floats, if the processor has them.
const WIDER: (&str, &str) = ("mitsuba-llvm-wide", "Mitsuba llvm_ad_rgb, AVX-512");

/// The materials of a room, and the goal against each variant: how many times as fast.
struct Subject {
    name: &'static str,
    surfaces: [Surface; scene::SURFACES],
    goals: [f64; 2],
}

/// The room of diffuse surfaces, and the room of measured ones if there are files.
fn subjects(data: &Path) -> Vec<Subject> {
    let colours = [[0.7, 0.3, 0.2], [0.7, 0.6, 0.2], [0.4, 0.2, 0.6], [0.6; 3], [0.7; 3], [0.6, 0.55, 0.5]];
    let mut subjects = vec![Subject { name: "diffuse", surfaces: colours.map(Surface::Diffuse), goals: [1.3, 2.4] }];
    let files = material::files(data);
    if !files.is_empty() {
        // In the order of the names: two shiny ones, two of paper or leather, and a golden one.
        let surfaces = [0, 4, 1, 2, 3, 3].map(|number| Surface::Measured(files[number % files.len()].clone()));
        subjects.push(Subject { name: "measured", surfaces, goals: [2.5, 5.0] });
    }
    subjects
}

/// Pictures of both rooms, compared with both variants.
///
/// # Errors
/// If a file cannot be read or written.
pub fn all(data: &Path, exchange: &mut Exchange) -> anyhow::Result<Vec<Contest>> {
    let mut contests = Vec::new();
    for Subject { name, surfaces, goals } in subjects(data) {
        let room = Room::new(surfaces);
        let task = format!("{PREFIX}-{name}");
        let scene = room.task(&exchange.directory().join(&task), SIZE, SAMPLES)?;
        exchange.task(&task, scene);
        for ((program, shown), goal) in VARIANTS.into_iter().zip(goals) {
            let mut outside = vec![Outside::new(shown, program, &task)];
            if (program, shown) == VARIANTS[0] {
                outside.push(Outside::of_sixteen(WIDER.1, WIDER.0, &task));
            }
            contests.push(Contest {
                id: PREFIX,
                on: format!("{name}, {} triangles", room.triangles()),
                unit: "sample",
                count: (SIZE[0] * SIZE[1] * SAMPLES) as usize,
                lobe: contender(&room)?,
                inside: Vec::new(),
                outside,
                // Noise is compared separately.
                agreement: None,
                judge: None,
                goal: Some(goal),
            });
        }
    }
    Ok(contests)
}

/// This renderer. A peer returns two pictures as values, so this does too.
fn contender(room: &Room) -> anyhow::Result<Contender> {
    let backend = Backend::best().fused();
    let world = room.world(Given::Viewer, backend)?;
    let settings = settings(SIZE, 0..SAMPLES, backend, 1);
    let run = move |film: &mut Film| {
        (*film, _) = render(&world, &settings, Film::new(settings.window), |_| true).expect("a camera and a window");
    };
    let values = |film: &Film| [picture::linear(film), picture::linear(film)].concat();
    Ok(Contender::new("lobe", Contender::UNCHECKED, Film::new(scene::whole(SIZE)), run, values))
}
