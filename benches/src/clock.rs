//! Ratios that can be trusted on a machine that is not quiet.

use std::hint::black_box;
use std::time::Instant;

/// Times several contenders in turn, `A B C A B C ...`, and returns the least nanoseconds of a call for each.
///
/// The minimum of many rounds is what the code can do; whatever else the machine does can only add. Interleaving gives
/// every contender the same clock speed and the same neighbours. Between rounds `progress` is called.
pub fn interleaved<const N: usize>(
    rounds: usize,
    mut contenders: [&mut dyn FnMut(); N],
    progress: impl FnMut(),
) -> [f64; N] {
    let least = interleaved_slice(rounds, &mut contenders, progress);
    std::array::from_fn(|i| least[i])
}

/// As [`interleaved`], for a number of contenders that is only known at run time.
pub fn interleaved_slice(rounds: usize, contenders: &mut [&mut dyn FnMut()], mut progress: impl FnMut()) -> Vec<f64> {
    let mut least = vec![f64::INFINITY; contenders.len()];
    for round in 0..=rounds {
        for (run, least) in contenders.iter_mut().zip(&mut least) {
            let start = Instant::now();
            run();
            black_box(());
            let nanoseconds = start.elapsed().as_secs_f64() * 1e9;
            // The first round only warms up caches and branch predictors.
            if round > 0 {
                *least = least.min(nanoseconds);
            }
        }
        progress();
    }
    least
}
