//! Ratios that can be trusted on a machine that is not quiet.

use std::time::Instant;

/// Calls of a contender in a row: the first finds the caches as the contender before it left them.
const TURN: usize = 3;

/// Times several contenders in turn, `A A A B B B C C C A A A ...`, and returns the least nanoseconds of a call for each.
///
/// The minimum of many rounds is what the code can do; whatever else the machine does can only add. Taking turns gives
/// every contender the same clock speed and the same neighbours. After each round `progress` is called.
pub fn interleaved<const N: usize>(
    rounds: usize,
    mut contenders: [&mut dyn FnMut(); N],
    mut progress: impl FnMut(),
) -> [f64; N] {
    let mut least = [f64::INFINITY; N];
    for _ in 0..rounds {
        for (run, least) in contenders.iter_mut().zip(&mut least) {
            for _ in 0..TURN {
                let start = Instant::now();
                run();
                *least = least.min(start.elapsed().as_secs_f64() * 1e9);
            }
        }
        progress();
    }
    least
}
