//! Decodes lines of texels: flat, with runs of texels (the old way), or with runs of each of the four bytes (the new
//! way).

/// An error of a line.
pub(super) struct Fault {
    pub found: &'static str,
    pub expected: &'static str,
}

const END: Fault = Fault { found: "the end of the file", expected: "all lines of the picture" };
/// Shorter or longer lines are never encoded in the new way.
const NEW: std::ops::RangeInclusive<usize> = 8..=0x7fff;

/// Fills a line from the bytes, and consumes them.
pub(super) fn read(rest: &mut &[u8], line: &mut [[u8; 4]]) -> Result<(), Fault> {
    match rest {
        [2, 2, high, low, ..] if *high < 128 && NEW.contains(&line.len()) => {
            let length = usize::from(*high) << 8 | usize::from(*low);
            if length != line.len() {
                return Err(Fault { found: "a line of another length", expected: "lines as long as the header says" });
            }
            *rest = &rest[4..];
            (0..4).try_for_each(|byte| new(rest, line, byte))
        }
        _ => old(rest, line),
    }
}

fn take<const N: usize>(rest: &mut &[u8]) -> Result<[u8; N], Fault> {
    let (bytes, after) = rest.split_first_chunk().ok_or(END)?;
    *rest = after;
    Ok(*bytes)
}

/// Decodes one byte of all texels. Counts above 128 repeat the next byte; others copy bytes.
fn new(rest: &mut &[u8], line: &mut [[u8; 4]], byte: usize) -> Result<(), Fault> {
    let mut at = 0;
    while at < line.len() {
        let [count] = take(rest)?;
        let run = count > 128;
        let length = usize::from(if run { count - 128 } else { count });
        let Some(texels) = line.get_mut(at..at + length) else {
            return Err(Fault { found: "a run beyond the end", expected: "runs that fill the line" });
        };
        if run {
            let [value] = take(rest)?;
            texels.iter_mut().for_each(|texel| texel[byte] = value);
        } else {
            for texel in texels {
                [texel[byte]] = take(rest)?;
            }
        }
        at += length;
    }
    Ok(())
}

/// Decodes plain texels, except for those of 1, 1, 1, which repeat the one before; consecutive counts are the bytes of
/// one number, low byte first.
fn old(rest: &mut &[u8], line: &mut [[u8; 4]]) -> Result<(), Fault> {
    let (mut at, mut shift) = (0, 0);
    while at < line.len() {
        let texel: [u8; 4] = take(rest)?;
        let [1, 1, 1, count] = texel else {
            line[at] = texel;
            (at, shift) = (at + 1, 0);
            continue;
        };
        let Some(before) = at.checked_sub(1).filter(|_| shift < 32) else {
            return Err(Fault { found: "a run of length 0", expected: "a texel before its repetitions" });
        };
        let (repeated, length) = (line[before], usize::from(count) << shift);
        let Some(texels) = line.get_mut(at..).and_then(|texels| texels.get_mut(..length)) else {
            return Err(Fault { found: "a run beyond the end", expected: "runs that fill the line" });
        };
        texels.fill(repeated);
        (at, shift) = (at + length, shift + 8);
    }
    Ok(())
}
