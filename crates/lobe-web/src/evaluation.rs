//! Evaluates many pairs of directions.

use lobe::{Backend, Directions};

use crate::Opened;

/// The backend to evaluate with.
#[derive(Clone, Copy, Debug)]
pub struct Evaluator(Backend);

impl Evaluator {
    /// The backend of this name, or the default one if the name is empty. If `strict`, results have the same bits on
    /// every backend.
    ///
    /// # Errors
    /// If this machine has no such backend; the error lists those that it has.
    pub fn new(name: &str, strict: bool) -> Result<Self, String> {
        let backend = match name {
            "" => Backend::detect(),
            name => Backend::named(name),
        };
        let backend = backend.map_err(|error| error.to_string())?;
        Ok(Evaluator(if strict { backend.strict() } else { backend }))
    }
}

/// The names of the backends of this machine, slowest first.
pub fn backends() -> Vec<&'static str> {
    Backend::available().iter().map(Backend::name).collect()
}

/// The values of pairs of directions, `[pair][channel]`; `wi` and `wo` have three components per pair.
///
/// # Errors
/// If the lengths of `wi` and `wo` differ, or are not multiples of three.
pub fn evaluate(opened: &Opened, wi: &[f32], wo: &[f32], on: Evaluator) -> Result<Vec<f32>, String> {
    let mut values = Vec::new();
    evaluate_into(opened, wi, wo, on, &mut values)?;
    Ok(values)
}

/// [`evaluate`] into a vector that may be used again; it is given the right length.
///
/// # Errors
/// As for [`evaluate`].
pub fn evaluate_into(
    opened: &Opened,
    wi: &[f32],
    wo: &[f32],
    on: Evaluator,
    values: &mut Vec<f32>,
) -> Result<(), String> {
    let (vectors_in, rest) = wi.as_chunks::<3>();
    let (vectors_out, rest_out) = wo.as_chunks::<3>();
    if wi.len() != wo.len() || !rest.is_empty() || !rest_out.is_empty() {
        return Err(format!(
            "found {} components of wi and {} of wo; expected equal numbers, three per direction",
            wi.len(),
            wo.len()
        ));
    }
    let material = opened.subject.material();
    values.resize(vectors_in.len() * material.channel_count(), 0.0);
    material.eval_batch_on(on.0, Directions::from(vectors_in), Directions::from(vectors_out), values);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Session;

    #[test]
    fn values_are_those_of_the_library_and_lengths_are_checked() {
        let path = lobe_testing::files::fixture("paint-12x21x13.ddr");
        let mut session = Session::new();
        session.add("paint.ddr", std::fs::read(&path).unwrap());
        let number = session.open("paint.ddr").unwrap();
        let opened = session.opened(number).unwrap();
        let (wi, wo) = ([0.6, 0.0, 0.8, 0.0, 0.0, 1.0], [-0.6, 0.0, 0.8, 0.0, 0.6, 0.8]);
        let strict = Evaluator::new("", true).unwrap();
        let found = evaluate(opened, &wi, &wo, strict).unwrap();
        let material = lobe::Material::open(&path).unwrap();
        let material = material.clone().with_backend(material.backend().strict());
        let mut expected = vec![0.0; 2 * material.channel_count()];
        material.eval_batch(&[[0.6, 0.0, 0.8], [0.0, 0.0, 1.0]], &[[-0.6, 0.0, 0.8], [0.0, 0.6, 0.8]], &mut expected);
        assert_eq!(found, expected);
        assert!(found.iter().all(|f| *f > 0.0), "{found:?}");
        assert!(
            evaluate(opened, &wi, &wo[..3], strict).is_err() && evaluate(opened, &wi[..4], &wo[..4], strict).is_err()
        );
        assert!(Evaluator::new("mmx", false).unwrap_err().contains("scalar"));
    }
}
