//! The angle bases that a file defines, and the standard ones.

use std::collections::HashMap;

use lobe_table::window::klems::{AngleBasis, Ring};

/// In degrees. A basis that ends lower leaves directions near the horizon without a value.
const WHOLE: f64 = 89.9;

/// Collects `AngleBasis` elements of a `DataDefinition`.
#[derive(Default)]
pub(super) struct BasisReader {
    /// By name in lower case.
    known: HashMap<String, AngleBasis>,
    name: String,
    rings: Vec<Ring>,
    lower: Option<f64>,
    upper: Option<f64>,
    patches: Option<u32>,
}

impl BasisReader {
    /// Processes the end of an element outside a data block; an error is what was found and what was expected.
    pub(super) fn close(&mut self, name: &str, content: &str) -> Result<(), (String, &'static str)> {
        let content = content.trim();
        let angle = || content.parse::<f64>().map_err(|_| (format!("{name} {content:?}"), "an angle in degrees"));
        match name {
            "AngleBasisName" => self.name = content.into(),
            "LowerTheta" => self.lower = Some(angle()?),
            "UpperTheta" => self.upper = Some(angle()?),
            "nPhis" => {
                let count = content.parse().map_err(|_| (format!("nPhis {content:?}"), "a number of patches"))?;
                self.patches = Some(count);
            }
            "AngleBasisBlock" => {
                let ring = (self.lower.take(), self.upper.take(), self.patches.take());
                let (Some(lower), Some(upper), Some(patches)) = ring else {
                    return Err(("an AngleBasisBlock without them".into(), "LowerTheta, UpperTheta and nPhis"));
                };
                self.rings.push(Ring { lower, upper, patches });
            }
            "AngleBasis" => {
                let (name, rings) = (std::mem::take(&mut self.name), std::mem::take(&mut self.rings));
                // Trees name their basis here, without rings.
                if let Some(last) = rings.last().map(|ring| ring.upper) {
                    let key = name.to_ascii_lowercase();
                    let basis = AngleBasis::new(name, rings);
                    let basis = basis.map_err(|error| (error.to_string(), "the rings of a hemisphere"))?;
                    // Such as radians.
                    if last < WHOLE {
                        return Err((format!("rings up to {last}"), "rings up to 90, in degrees"));
                    }
                    if *self.known.entry(key).or_insert_with(|| basis.clone()) != basis {
                        return Err((format!("another basis {:?}", basis.name()), "each name for one basis"));
                    }
                }
            }
            _ => {}
        }
        Ok(())
    }

    /// A basis by its name, in upper or lower case. Bases defined in the file take precedence over the standard ones.
    pub(super) fn find(&self, name: &str) -> Option<AngleBasis> {
        self.known.get(&name.to_ascii_lowercase()).cloned().or_else(|| {
            let standard = [AngleBasis::full(), AngleBasis::half(), AngleBasis::quarter()];
            standard.into_iter().find(|basis| basis.name().eq_ignore_ascii_case(name))
        })
    }
}
