//! Shows where a fitted model is above and below the measurement, with one disk for each incidence.

use colorous::Color;

use super::bar;
use super::cartesian::title;
use super::shared::{MARGIN, MIDDLE, conditions, heading, id, notes};
use super::slices::{Place, light_and_mirror, rings};
use crate::evaluate::Progress;
use crate::image::Image;
use crate::layout::Paper;
use crate::residual::{Fitted, Residual};
use crate::scale::degrees;
use crate::shown::{Shown, incidences};
use crate::svg::{Area, Role, Svg, Text};

const MOST: usize = 6;
const RADIUS: f64 = 100.0;
const ABOVE: f64 = 24.0;
const BELOW: f64 = 36.0;
/// Pixels across a disk: models are evaluated one pair at a time.
const SIZE: usize = 160;
/// The differences at the ends of the colours.
const END: f64 = 1.0;
const LABELS: [(f64, &str); 5] = [(0.0, "−100 %"), (0.25, "−50 %"), (0.5, "0"), (0.75, "+50 %"), (1.0, "+100 %")];

/// The disks of the incidences that are shown.
pub(super) fn residuals(shown: Shown<'_>, fitted: &Fitted<'_>, progress: &dyn Progress) -> Vec<Residual> {
    let sigmas = incidences(&[shown], MOST);
    progress.begin("residuals", (0.785 * (SIZE * SIZE * sigmas.len()) as f64) as u64);
    sigmas.into_iter().map(|sigma| Residual::new(shown, fitted, sigma, SIZE, progress)).collect()
}

/// All disks with the same colours: red where the model is above the measurement, blue where it is below.
pub(super) fn draw(shown: Shown<'_>, disks: &[Residual], paper: Paper<'_>) -> String {
    let layout = paper.layout;
    let columns = if layout.is_narrow { 2 } else { 3 };
    let cell = (layout.width - 2.0 * MARGIN) / columns as f64;
    let radius = RADIUS.min(0.5 * cell - 8.0);
    let row = 2.0 * radius + ABOVE + BELOW;
    let mut svg = Svg::new(id("residuals", shown.view), paper);
    let what = format!("The fit minus the measurement at each incidence σ, {}", conditions(&[shown]));
    let top = heading(&mut svg, &[shown], &what);
    for (at, disk) in disks.iter().enumerate() {
        let in_row = (disks.len() - at / columns * columns).min(columns);
        let left = 0.5 * (layout.width - cell * in_row as f64);
        let x = left + cell * ((at % columns) as f64 + 0.5);
        let y = top + row * (at / columns) as f64 + ABOVE + radius;
        let place = Place { x, y, radius };
        let area = Area { x: x - radius, y: y - radius, width: 2.0 * radius, height: 2.0 * radius };
        svg.image(area, &Image::square(disk.slice.size, &disk.difference, colour));
        rings(&mut svg, place);
        light_and_mirror(&mut svg, place, shown.view, disk.slice.sigma);
        let label = Text { is_heavy: true, size: 16.0, ..MIDDLE };
        svg.text([x, y - radius - 9.0], label, &format!("σ = {}", degrees(disk.slice.sigma)));
        let [rms, most] = disk.sizes();
        let said = format!("rms {:.0} %, at most {:.0} %", 100.0 * rms, 100.0 * most);
        svg.text([x, y + radius + 18.0], Text { size: 14.0, role: Role::Muted, ..MIDDLE }, &said);
    }
    let y = top + row * disks.len().div_ceil(columns) as f64 + 14.0;
    bar::labelled(&mut svg, y, |share| colour(END * (2.0 * share - 1.0)), &LABELS);
    let lines = [
        "Relative to the measured value, or to the mean of the disk if that is larger.".to_string(),
        "Red: the fit is above the measurement. Blue: below. Empty: not measured.".to_string(),
    ];
    let bottom = notes(&mut svg, y + 72.0, &lines);
    svg.finish(bottom, &title(&[shown], "the fit minus the measurement over the outgoing hemisphere"))
}

/// Blue, white and red for -1, 0 and 1.
fn colour(apart: f64) -> Color {
    let place = 0.5 - 0.5 * (apart / END).clamp(-1.0, 1.0);
    colorous::RED_BLUE.eval_continuous(place)
}
