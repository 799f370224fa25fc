//! A measured table compared with an analytic model: the cost of measured materials.

use lobe::{Backend, Buffer, Directions, Edges, specular};
use lobe_benches::contest::Contender;
use lobe_benches::tables;
use lobe_benches::workload::Input;
use serde_json::json;

use super::contest::{Contest, Outside};
use super::exchange::Exchange;
use super::material::{COUNT, pairs};

/// The isotropic table of the paper's size on both inputs, in batches as long as Mitsuba's wavefronts.
///
/// # Errors
/// If a file cannot be written.
pub fn all(exchange: &mut Exchange) -> anyhow::Result<Vec<Contest>> {
    Input::ALL.into_iter().map(|input| contest(exchange, input)).collect()
}

fn contest(exchange: &mut Exchange, input: Input) -> anyhow::Result<Contest> {
    let (pairs, file) = pairs(exchange, input)?;
    let task = format!("principled-{}", input.name());
    exchange.task(&task, json!({ "bsdf": { "type": "principled" }, "what": "eval", "pairs": file }));
    let table = specular::Table::new(&tables::isotropic(), &Edges::default())?;
    let backend = Backend::best().fused();
    let run = move |out: &mut Buffer<f32>| {
        let [wi, wo] = [&pairs.wi, &pairs.wo].map(|[x, y, z]| Directions::columns(x, y, z));
        table.eval_batch(backend, wi, wo, out);
    };
    Ok(Contest {
        id: "analytic",
        on: format!("7 × 8 × 13, {}", input.name()),
        unit: "evaluation",
        count: COUNT,
        lobe: Contender::new("lobe", Contender::UNCHECKED, Buffer::zeros(3 * COUNT), run, |out| out.to_vec()),
        inside: Vec::new(),
        outside: vec![
            Outside::new("Mitsuba principled", "mitsuba", &task),
            Outside::of_sixteen("Mitsuba principled, AVX-512", "mitsuba-wide", task),
        ],
        agreement: None,
        judge: None,
        goal: Some(1.0),
    })
}
