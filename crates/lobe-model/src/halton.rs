//! Points that fill a space evenly.

/// The `n`-th point of the Halton sequence in four dimensions (J. H. Halton, *On the efficiency of certain quasi-random
/// sequences of points*, Numerische Mathematik 2, 1960): the digits of `n` in the bases 2, 3, 5 and 7, mirrored at the
/// radix point. Start with 1, because number 0 is a corner.
pub fn halton(n: u32) -> [f64; 4] {
    [2, 3, 5, 7].map(|base| {
        let (mut rest, mut place, mut sum) = (n, 1.0, 0.0);
        while rest > 0 {
            place /= f64::from(base);
            sum += place * f64::from(rest % base);
            rest /= base;
        }
        sum
    })
}
