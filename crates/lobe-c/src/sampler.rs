//! Samplers.

use std::ffi::c_int;

use lobe::{Given, Sampled, Sampler, SamplerOptions};

use crate::border;
use crate::directions::{AT_ONCE, Readable, Writable, lobe_directions, lobe_values};
use crate::error::{Error, lobe_error, lobe_status};
use crate::material::lobe_material;
use crate::options::given;

/// Samples directions for a material in proportion to luminance times f times cosine. Threads may share it.
#[derive(Debug)]
pub struct lobe_sampler {
    sampler: Sampler,
}

/// Builds a sampler for a material, which takes a while. `defensive`, in (0, 1], is the cosine-weighted share of every
/// distribution; 0.05 suits most materials. `*sampler` is set only if this returns LOBE_OK; free it with
/// `lobe_sampler_free`.
///
/// # Safety
/// `material` is not freed; `sampler` points to a pointer, and `error` to an error or is NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lobe_sampler_new(
    material: *const lobe_material,
    defensive: f32,
    sampler: *mut *mut lobe_sampler,
    error: *mut lobe_error,
) -> lobe_status {
    // SAFETY: by the promises of the caller, which are those that the called functions require.
    unsafe {
        border::guarded(error, || {
            let material = border::borrowed(material, "material")?;
            border::check(sampler, "sampler")?;
            let options = SamplerOptions { defensive, ..SamplerOptions::default() };
            let made = lobe_sampler { sampler: Sampler::new(material.material.clone(), &options)? };
            border::write(sampler, Box::into_raw(Box::new(made)), "sampler")
        })
    }
}

/// Frees a sampler; does nothing for NULL.
///
/// # Safety
/// `sampler` is NULL or not freed, and no other thread uses it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lobe_sampler_free(sampler: *mut lobe_sampler) {
    border::infallible((), || {
        if !sampler.is_null() {
            // SAFETY: a handle was made from a box, and by the promise of the caller it is freed once.
            drop(unsafe { Box::from_raw(sampler) });
        }
    });
}

/// Samples a direction for each of `count` given directions, to the light or to the viewer (`LOBE_GIVEN_...`), from two
/// numbers in [0, 1) each, `u[2 * i]` and `u[2 * i + 1]`. `drawn` has room for three numbers each, `pdf` for the
/// density per steradian, and `weight`, unless its data is NULL, for f times cosine over the density, one value per
/// channel. If no direction was sampled, all are 0; a mirror has an infinite density.
///
/// # Safety
/// `sampler` is not freed; all pointers belong to `count` queries, and outputs do not overlap anything; `error` points
/// to an error or is NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lobe_sample(
    sampler: *const lobe_sampler,
    given: c_int,
    count: usize,
    directions: lobe_directions,
    u: *const f32,
    drawn: lobe_values,
    pdf: *mut f32,
    weight: lobe_values,
    error: *mut lobe_error,
) -> lobe_status {
    // SAFETY: by the promises of the caller, which are those that the called functions require.
    unsafe {
        border::guarded(error, || {
            let sampler = &border::borrowed(sampler, "sampler")?.sampler;
            let given = self::given(given, "given")?;
            let known = directions.readable(count, "directions")?;
            let u = border::slice(u.cast::<[f32; 2]>(), count, "u")?;
            if let Some(index) = u.iter().position(|u| !u.iter().all(|u| (0.0..1.0).contains(u))) {
                let message = format!("u: found {:?} at {index}; expected numbers in [0, 1)", u[index]);
                return Err(Error::invalid(message));
            }
            let drawn = drawn.writable(count, 3, "drawn")?;
            let pdf = border::slice_mut(pdf, count, "pdf")?;
            let channels = sampler.material().channel_count();
            let weight = match weight.data.is_null() {
                true => None,
                false => Some(weight.writable(count, channels, "weight")?),
            };
            sample(sampler, given, known, u, Drawn { drawn, pdf, weight });
            Ok(())
        })
    }
}

struct Drawn<'a> {
    drawn: Writable<'a>,
    pdf: &'a mut [f32],
    weight: Option<Writable<'a>>,
}

fn sample(sampler: &Sampler, given: Given, known: Readable<'_>, u: &[[f32; 2]], mut out: Drawn<'_>) {
    let channels = sampler.material().channel_count();
    let at_once = (16 * AT_ONCE).min(u.len());
    let mut rows = vec![[0.0; 3]; at_once];
    let mut directions = vec![[0.0; 3]; at_once];
    let mut weights = vec![0.0; at_once * channels];
    for (index, u) in u.chunks(at_once.max(1)).enumerate() {
        let (at, size) = (index * at_once, u.len());
        let (rows, directions) = (&mut rows[..size], &mut directions[..size]);
        let (weights, pdfs) = (&mut weights[..size * channels], &mut out.pdf[at..at + size]);
        known.copy(at, rows);
        sampler.sample_batch(given, rows, u, Sampled { directions, weights, pdfs });
        out.drawn.copy(at, directions.as_flattened());
        if let Some(weight) = &mut out.weight {
            weight.copy(at, weights);
        }
    }
}

/// The density per steradian with which `lobe_sample` finds the direction of each pair that is not given, without mirrors.
///
/// # Safety
/// `sampler` is not freed; `wi` and `wo` are `count` directions, and `pdf` has room for as many numbers, which overlap nothing;
/// `error` points to an error or is NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn lobe_pdf(
    sampler: *const lobe_sampler,
    given: c_int,
    count: usize,
    wi: lobe_directions,
    wo: lobe_directions,
    pdf: *mut f32,
    error: *mut lobe_error,
) -> lobe_status {
    // SAFETY: by the promises of the caller, which are those that the called functions require.
    unsafe {
        border::guarded(error, || {
            let sampler = &border::borrowed(sampler, "sampler")?.sampler;
            let given = self::given(given, "given")?;
            let (wi, wo) = (wi.readable(count, "wi")?, wo.readable(count, "wo")?);
            let pdf = border::slice_mut(pdf, count, "pdf")?;
            let at_once = (16 * AT_ONCE).min(count);
            let mut rows = [vec![[0.0; 3]; at_once], vec![[0.0; 3]; at_once]];
            for (index, pdf) in pdf.chunks_mut(at_once.max(1)).enumerate() {
                let [light, viewer] = &mut rows;
                let (light, viewer) = (&mut light[..pdf.len()], &mut viewer[..pdf.len()]);
                wi.copy(index * at_once, light);
                wo.copy(index * at_once, viewer);
                sampler.pdf_batch(given, light, viewer, pdf);
            }
            Ok(())
        })
    }
}
