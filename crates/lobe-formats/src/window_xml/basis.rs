//! The angle bases that a file defines, and the standard ones.

use std::collections::HashMap;

use lobe_table::window::klems::{AngleBasis, Ring};

/// Collects `AngleBasis` elements of a `DataDefinition`.
#[derive(Default)]
pub(super) struct BasisReader {
    /// By name in lower case; of several with the same name, the first.
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
                if !rings.is_empty() {
                    let key = name.to_ascii_lowercase();
                    let basis = AngleBasis::new(name, rings);
                    let basis = basis.map_err(|error| (error.to_string(), "the rings of a hemisphere"))?;
                    self.known.entry(key).or_insert(basis);
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
