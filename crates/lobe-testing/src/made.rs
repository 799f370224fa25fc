//! Files that are made by a rule, which the answers of other programs about them define.

/// The direction of a zenith angle and an azimuth in radians.
pub fn spherical([theta, phi]: [f64; 2]) -> [f64; 3] {
    [theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos()]
}

/// The MERL file that `merl_formula.txt` is about: every bin holds its own indices.
pub fn merl_formula() -> Vec<u8> {
    let mut bytes: Vec<u8> = [90i32, 90, 180].iter().flat_map(|n| n.to_le_bytes()).collect();
    for scale in [1.0, 1.15, 1.66] {
        for bin in 0..90 * 90 * 180 {
            let (h, d, p) = (bin / (90 * 180), bin / 180 % 90, bin % 180);
            let code = 1e4 * f64::from(h) + 100.0 * f64::from(d) + f64::from(p) / 2.0;
            bytes.extend_from_slice(&(1500.0 * code / scale).to_le_bytes());
        }
    }
    bytes
}

/// The UTIA file that `utia_lcg.txt` is about, as its first line says.
pub fn utia_numbers() -> Vec<u8> {
    let mut state = 12345u32;
    let mut bytes = Vec::new();
    for _ in 0..248_832 {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        bytes.extend_from_slice(&(0.01 + 60.0 * f64::from(state) / 4_294_967_296.0).to_le_bytes());
    }
    bytes
}
