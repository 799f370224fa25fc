//! Arrays for results, whose memory is reused.
//!
//! The system provides new memory page by page and clears each page: for a million pairs this takes as long as a
//! quarter of the evaluation. So memory that results no longer need is kept for the next ones.

use std::sync::{Mutex, PoisonError};

use numpy::prelude::*;
use numpy::{PyArray1, PyArrayDyn, PyReadwriteArrayDyn};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use crate::arrays::shown;

/// Results with fewer numbers are left to NumPy, whose memory for them does not come from the system each time.
const FROM: usize = (128 << 10) / size_of::<f32>();
/// The largest number of numbers that are kept.
const KEPT: usize = (128 << 20) / size_of::<f32>();
/// Bytes of a cache line. Results are aligned to cache lines, because kernels write a whole line at a time.
const LINE: usize = 64;

/// A NumPy array that holds results.
struct Block {
    array: Py<PyArray1<f32>>,
    /// The number of numbers that fit.
    room: usize,
}

/// Unused blocks, the oldest first. The lock is only taken and released while the lock of the interpreter is held,
/// which a thread also needs to fork, so it is never locked in a new process. No Python code runs while it is held.
static SPARE: Mutex<Vec<Block>> = Mutex::new(Vec::new());

/// The memory of a result. The result and all of its views keep it alive.
#[pyclass(frozen, module = "lobe_bsdf")]
struct Memory {
    block: Option<Block>,
    address: usize,
    shape: Vec<usize>,
}

impl Memory {
    fn new(py: Python<'_>, count: usize, shape: &[usize]) -> PyResult<Self> {
        let block = match spare(count) {
            Some(block) => block,
            None => {
                let zeros = py.import("numpy")?.call_method1("zeros", (count + LINE / size_of::<f32>(), "float32"))?;
                Block { array: zeros.cast_into()?.unbind(), room: count }
            }
        };
        let address = block.array.bind(py).data().expose_provenance().next_multiple_of(LINE);
        Ok(Memory { block: Some(block), address, shape: shape.to_vec() })
    }
}

#[pymethods]
impl Memory {
    #[getter]
    fn __array_interface__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let interface = PyDict::new(py);
        interface.set_item("version", 3)?;
        interface.set_item("typestr", if cfg!(target_endian = "little") { "<f4" } else { ">f4" })?;
        interface.set_item("shape", PyTuple::new(py, &self.shape)?)?;
        interface.set_item("data", (self.address, false))?;
        Ok(interface)
    }
}

impl Drop for Memory {
    fn drop(&mut self) {
        if let Some(block) = self.block.take() {
            keep(block);
        }
    }
}

/// The smallest spare block into which `count` numbers fit, if they take at least half of it; among blocks of the same
/// size, the one used last, which may still be in a cache.
fn spare(count: usize) -> Option<Block> {
    let mut spare = SPARE.lock().unwrap_or_else(PoisonError::into_inner);
    let fitting = spare.iter().enumerate().rev().filter(|(_, block)| (count..=2 * count).contains(&block.room));
    let (index, _) = fitting.min_by_key(|(_, block)| block.room)?;
    Some(spare.remove(index))
}

/// Keeps a block, and frees the ones that have been spare for longest if there are too many.
fn keep(block: Block) {
    let mut spare = SPARE.lock().unwrap_or_else(PoisonError::into_inner);
    spare.push(block);
    let mut kept: usize = spare.iter().map(|block| block.room).sum();
    let mut gone = Vec::new();
    while kept > KEPT {
        let oldest = spare.remove(0);
        kept -= oldest.room;
        gone.push(oldest);
    }
    drop(spare);
}

/// A new array, or the array to write to. It contains old numbers, so all of it must be written.
///
/// # Errors
/// `MemoryError`; `ValueError` if the array has another shape or type, or cannot be written to.
pub fn output<'py>(
    py: Python<'py>,
    out: Option<&Bound<'py, PyAny>>,
    shape: &[usize],
) -> PyResult<Bound<'py, PyArrayDyn<f32>>> {
    let Some(out) = out else { return new(py, shape) };
    match out.cast::<PyArrayDyn<f32>>() {
        Ok(array) if array.shape() == shape && array.is_c_contiguous() && array.is_aligned() => Ok(array.clone()),
        _ => Err(PyValueError::new_err(format!(
            "out: found {}; expected a contiguous array of float32 of shape {}",
            described(out),
            shown(shape)
        ))),
    }
}

fn new<'py>(py: Python<'py>, shape: &[usize]) -> PyResult<Bound<'py, PyArrayDyn<f32>>> {
    let numpy = py.import("numpy")?;
    let count = shape.iter().try_fold(1_usize, |count, &length| count.checked_mul(length)).unwrap_or(usize::MAX);
    if !(FROM..=KEPT).contains(&count) {
        return Ok(numpy.call_method1("zeros", (PyTuple::new(py, shape)?, "float32"))?.cast_into()?);
    }
    let memory = Bound::new(py, Memory::new(py, count, shape)?)?;
    Ok(numpy.call_method1("asarray", (memory,))?.cast_into()?)
}

fn described(value: &Bound<'_, PyAny>) -> String {
    let attribute = |name: &str| value.getattr(name).map(|found| found.to_string());
    match (attribute("dtype"), attribute("shape")) {
        (Ok(dtype), Ok(shape)) => format!("an array of {dtype} of shape {shape}"),
        _ => format!("a {}", value.get_type()),
    }
}

/// The values to write to.
///
/// # Errors
/// `ValueError` if other code uses the array, or if it is read-only.
pub fn written<'py>(array: &Bound<'py, PyArrayDyn<f32>>) -> PyResult<PyReadwriteArrayDyn<'py, f32>> {
    array.try_readwrite().map_err(|error| PyValueError::new_err(format!("out: {error}")))
}
