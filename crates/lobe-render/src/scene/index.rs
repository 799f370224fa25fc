//! The keys of a refractive index.

use lobe_spectrum::Glass;

use super::node::{Node, SceneError};

/// The refractive index of glass.
pub(super) enum Index {
    Constant(f64),
    Formula(Glass),
}

/// `eta`, the name of a `glass`, or the terms of `cauchy`.
pub(super) fn glass(node: &Node<'_, '_>) -> Result<Index, SceneError> {
    let eta = node.number("eta", "a refractive index from 1 to 5", |x| (1.0..=5.0).contains(&x))?;
    let name = node.text("glass")?;
    let cauchy = node.numbers("cauchy", "up to eight numbers: a + b / x + c / x^2 ..., x in square micrometres")?;
    let sellmeier = ["sellmeier_b", "sellmeier_c"].map(|key| node.numbers(key, "as many numbers as terms"));
    let [b, c] = sellmeier;
    match (eta, name, cauchy, b?, c?) {
        (eta, None, None, None, None) => Ok(Index::Constant(eta.unwrap_or(1.5))),
        (None, Some(name), None, None, None) => Glass::named(name).map(Index::Formula).ok_or_else(|| {
            let known: Vec<&str> = Glass::names().collect();
            node.error("glass", format!("found `{name}`; expected one of {}", known.join(", ")))
        }),
        (None, None, Some(terms), None, None) if (1..=8).contains(&terms.len()) => {
            Ok(Index::Formula(Glass::Cauchy(terms)))
        }
        (None, None, None, Some(b), Some(c)) if !b.is_empty() && b.len() == c.len() => {
            Ok(Index::Formula(Glass::Sellmeier { b, c }))
        }
        _ => {
            let expected = "one of `eta`, `glass`, `cauchy`, or as many `sellmeier_b` as `sellmeier_c`";
            Err(node.error("", format!("found several or incomplete refractive indices; expected {expected}")))
        }
    }
}
