//! Reads Radiance HDR, the pictures of the Radiance programs: a header of variables, a line with the order of the
//! texels, and lines of texels of four bytes, plain or run-length encoded in the old or the new way.

mod lines;

use std::path::Path;

use lobe_colour::Primaries;

use super::super::PictureError;
use super::super::exr_file::content;
use super::{Picture, check_shape};

const EXPECTED: &str = "an OpenEXR or Radiance HDR file";
/// The most texels per byte of the file: many times more than run-length encoding needs for a sky of one colour.
const TEXELS_PER_BYTE: usize = 128;

pub(super) fn read(path: &Path, bytes: &[u8]) -> Result<Picture, PictureError> {
    let wrong = |found: String, expected| content(path, found, expected);
    let mut rest = bytes;
    let first = line(&mut rest);
    // The word after it names the program that wrote the file: RADIANCE, RGBE, AUTOPANO.
    if !first.is_some_and(|line| line.starts_with("#?")) {
        return Err(wrong("no line `#?RADIANCE`".into(), EXPECTED));
    }
    let header = Header::read(path, &mut rest)?;
    let resolution = line(&mut rest).ok_or_else(|| wrong("the end of the file".into(), "the size of the picture"))?;
    let order = Order::parse(&resolution)
        .ok_or_else(|| wrong(format!("`{}`", resolution.escape_debug()), "a size such as `-Y 512 +X 1024`"))?;
    let [width, height] = order.size();
    let texels = width.checked_mul(height).filter(|&texels| texels / TEXELS_PER_BYTE <= rest.len());
    let Some(count) = texels.filter(|&texels| texels > 0) else {
        let found = format!("{width} x {height} texels in {} bytes", rest.len());
        return Err(wrong(found, "as many texels as the file can hold, at least one"));
    };
    check_shape(path, [width, height], 1.0 / header.height_of_texel)?;

    let mut texels = vec![[0.0; 3]; count];
    let mut row = vec![[0; 4]; order.along.length];
    for number in 0..order.lines.length {
        lines::read(&mut rest, &mut row).map_err(|fault| {
            let found = format!("{} in line {} of {}", fault.found, number + 1, order.lines.length);
            wrong(found, fault.expected)
        })?;
        for (at, rgbe) in row.iter().enumerate() {
            texels[order.place(number, at)] = radiance(*rgbe, header.factors);
        }
    }
    let picture = Picture { width, height, texels };
    picture.of_primaries(path, &header.primaries)
}

/// Takes a line, without its line end; `None` at the end of the file.
fn line(rest: &mut &[u8]) -> Option<String> {
    let end = rest.iter().position(|&byte| byte == b'\n')?;
    let line = String::from_utf8_lossy(&rest[..end]).trim_end_matches('\r').to_string();
    *rest = &rest[end + 1..];
    Some(line)
}

/// Decodes three mantissas and their common exponent. The divisor is the one of other programs: 1 is written as 128,
/// 129.
fn radiance([r, g, b, e]: [u8; 4], factors: [f64; 3]) -> [f32; 3] {
    if e == 0 {
        return [0.0; 3];
    }
    let unit = libm::ldexp(1.0, i32::from(e) - 136);
    let [x, y, z] = factors;
    [f64::from(r) * unit * x, f64::from(g) * unit * y, f64::from(b) * unit * z].map(|value| value as f32)
}

/// The variables of a header.
struct Header {
    /// The factor from numbers to radiances: one over the product of all exposures and corrections.
    factors: [f64; 3],
    height_of_texel: f64,
    primaries: Primaries,
}

impl Header {
    /// Reads up to the empty line. Only lines that begin with the name of a variable set it; indented lines are the
    /// commands that made the picture.
    fn read(path: &Path, rest: &mut &[u8]) -> Result<Header, PictureError> {
        let mut header = Header { factors: [1.0; 3], height_of_texel: 1.0, primaries: Primaries::SRGB };
        let mut format: Option<String> = None;
        loop {
            let Some(text) = line(rest) else {
                return Err(content(path, "the end of the file in the header", "an empty line after the header"));
            };
            if text.is_empty() {
                return Ok(header);
            }
            let wrong = |expected| content(path, format!("`{}`", text.escape_debug()), expected);
            let Some((name, value)) = text.split_once('=').filter(|_| !text.starts_with([' ', '\t', '#'])) else {
                continue;
            };
            let numbers: Option<Vec<f64>> = value.split_whitespace().map(|word| word.parse().ok()).collect();
            let numbers = numbers.filter(|numbers| numbers.iter().all(|number| number.is_finite())).unwrap_or_default();
            let is_factor = |number: &f64| *number > 0.0 && number.is_normal();
            match (name.trim(), numbers.as_slice()) {
                ("FORMAT", _) => {
                    match value.trim() {
                        "32-bit_rle_rgbe" => {}
                        "32-bit_rle_xyze" => {
                            let expected = "32-bit_rle_rgbe: X, Y and Z may be in candela or in watts, which the file does not say (ra_xyze -r of Radiance converts it)";
                            return Err(wrong(expected));
                        }
                        _ => return Err(wrong("FORMAT=32-bit_rle_rgbe")),
                    }
                    if format.replace(value.trim().into()).is_some_and(|before| before != value.trim()) {
                        return Err(wrong("one FORMAT"));
                    }
                }
                ("EXPOSURE", [exposure]) if is_factor(exposure) => {
                    header.factors = header.factors.map(|factor| factor / exposure);
                }
                ("EXPOSURE", _) => {
                    return Err(wrong("the factor by which radiances were multiplied, a number above 0"));
                }
                ("COLORCORR", [r, g, b]) if [r, g, b].into_iter().all(is_factor) => {
                    let [x, y, z] = header.factors;
                    header.factors = [x / r, y / g, z / b];
                }
                ("COLORCORR", _) => return Err(wrong("three factors above 0, for red, green and blue")),
                ("PIXASPECT", [aspect]) if is_factor(aspect) => header.height_of_texel *= aspect,
                ("PIXASPECT", _) => return Err(wrong("the height of a texel over its width, a number above 0")),
                // Some programs write zeros for primaries that they do not know.
                ("PRIMARIES", [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]) => {}
                ("PRIMARIES", &[rx, ry, gx, gy, bx, by, wx, wy]) => {
                    header.primaries = Primaries { red: [rx, ry], green: [gx, gy], blue: [bx, by], white: [wx, wy] };
                }
                ("PRIMARIES", _) => return Err(wrong("eight chromaticities, of red, green, blue and white")),
                ("GAMMA", [gamma]) if *gamma == 1.0 => {}
                ("GAMMA", _) => return Err(wrong("GAMMA=1: radiances, not values for a display")),
                ("VIEW", _) => {
                    return Err(wrong("no VIEW: the picture of a camera, not an image of longitude and latitude"));
                }
                _ => {}
            }
        }
    }
}

/// The order in which texels are stored.
struct Order {
    /// The axis from line to line.
    lines: Axis,
    /// The axis within a line.
    along: Axis,
}

struct Axis {
    /// `true` for the axis of columns.
    is_x: bool,
    /// `true` if it runs to the right, or down.
    is_forward: bool,
    length: usize,
}

impl Order {
    /// Parses a line such as `-Y 512 +X 1024`: two axes with their lengths, the slower one first. Rows with a minus run
    /// downward.
    fn parse(text: &str) -> Option<Order> {
        let words: Vec<&str> = text.split_whitespace().collect();
        let &[first, lines, second, along] = words.as_slice() else { return None };
        let axis = |name: &str, length: &str| {
            let (is_x, is_forward) = match name {
                "+X" => (true, true),
                "-X" => (true, false),
                "-Y" => (false, true),
                "+Y" => (false, false),
                _ => return None,
            };
            Some(Axis { is_x, is_forward, length: length.parse().ok()? })
        };
        let order = Order { lines: axis(first, lines)?, along: axis(second, along)? };
        (order.lines.is_x != order.along.is_x).then_some(order)
    }

    /// Columns and rows.
    fn size(&self) -> [usize; 2] {
        let lengths = [self.lines.length, self.along.length];
        if self.lines.is_x { lengths } else { [lengths[1], lengths[0]] }
    }

    /// The place of a texel of a line.
    fn place(&self, line: usize, at: usize) -> usize {
        let along = |axis: &Axis, at: usize| if axis.is_forward { at } else { axis.length - 1 - at };
        let (line, at) = (along(&self.lines, line), along(&self.along, at));
        let [width, _] = self.size();
        if self.lines.is_x { at * width + line } else { line * width + at }
    }
}
