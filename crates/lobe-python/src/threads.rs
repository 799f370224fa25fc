//! Runs work on threads without the lock of the interpreter, so that Ctrl-C can end it.

use std::any::Any;
use std::ops::Range;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use lobe::PARALLEL_FROM;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

/// Number of queries between two checks for Ctrl-C.
const CHUNK: usize = 1 << 22;

/// Longest time between two checks for Ctrl-C.
const PATIENCE: Duration = Duration::from_millis(50);

/// The threads of this process.
///
/// A forked process, such as those of `multiprocessing` may be, has none of the threads of its parent, so a pool
/// belongs to one process. The lock is only taken and released while the lock of the interpreter is held, which a
/// thread also needs to fork, so it is never locked in a new process.
static POOL: Mutex<Option<(u32, Arc<ThreadPool>)>> = Mutex::new(None);

fn pool(_py: Python<'_>) -> PyResult<Arc<ThreadPool>> {
    let mut pool = POOL.lock().unwrap_or_else(PoisonError::into_inner);
    let process = std::process::id();
    if let Some((owner, pool)) = &*pool
        && *owner == process
    {
        return Ok(pool.clone());
    }
    let made = ThreadPoolBuilder::new().build();
    let made = Arc::new(made.map_err(|error| PyRuntimeError::new_err(format!("no threads: {error}")))?);
    if let Some(of_parent) = pool.replace((process, made.clone())) {
        // Its threads do not exist here, so they cannot be joined.
        std::mem::forget(of_parent);
    }
    Ok(made)
}

/// The reason why work has no result.
enum Ended {
    Raised(PyErr),
    Panicked(Box<dyn Any + Send>),
}

/// A bug in lobe, which must not end the interpreter.
fn raised(ended: Ended) -> PyErr {
    match ended {
        Ended::Raised(error) => error,
        Ended::Panicked(panic) => {
            let words = panic.downcast_ref::<&str>().map(ToString::to_string);
            let words = words.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_default();
            PyRuntimeError::new_err(format!("an error in lobe, please report it: {words}"))
        }
    }
}

/// Runs `work` for consecutive ranges of `count` queries, which it may share among threads, without the lock.
///
/// # Errors
/// `KeyboardInterrupt` between two ranges, and an error if something panics.
pub fn batches(py: Python<'_>, count: usize, mut work: impl FnMut(Range<usize>) + Send) -> PyResult<()> {
    // Work that is not shared needs no threads.
    let pool = if count >= PARALLEL_FROM { Some(pool(py)?) } else { None };
    let done = py.detach(|| {
        let mut at = 0;
        while at < count {
            let part = at..count.min(at + CHUNK);
            at = part.end;
            let run = AssertUnwindSafe(|| match &pool {
                Some(pool) => pool.install(|| work(part)),
                None => work(part),
            });
            catch_unwind(run).map_err(Ended::Panicked)?;
            if at < count {
                Python::attach(|py| py.check_signals()).map_err(Ended::Raised)?;
            }
        }
        Ok(())
    });
    done.map_err(raised)
}

/// Tells work whether it should continue.
#[derive(Debug)]
pub struct Watch(AtomicBool);

/// The payload with which cancelled work unwinds.
struct Unwanted;

impl Watch {
    /// Ends the work if it was cancelled. It must be called from time to time, for example as progress. It unwinds like
    /// a panic, through code that knows nothing about it, but prints nothing.
    pub fn check(&self) {
        if self.0.load(Ordering::Relaxed) {
            resume_unwind(Box::new(Unwanted));
        }
    }
}

/// Runs long work on other threads, without the lock, while this thread checks for Ctrl-C.
///
/// # Errors
/// `KeyboardInterrupt`, as soon as the work checks its [`Watch`], and an error if something panics.
pub fn watched<T: Send>(py: Python<'_>, work: impl FnOnce(&Watch) -> T + Send) -> PyResult<T> {
    let pool = pool(py)?;
    let watch = Watch(AtomicBool::new(false));
    let done = py.detach(|| {
        std::thread::scope(|scope| {
            let (sender, receiver) = mpsc::channel();
            let (pool, watch) = (&pool, &watch);
            let thread = std::thread::Builder::new().spawn_scoped(scope, move || {
                let done = catch_unwind(AssertUnwindSafe(|| pool.install(|| work(watch))));
                // The receiver waits until it is sent.
                let _ = sender.send(done);
            });
            if let Err(error) = thread {
                return Err(Ended::Raised(PyRuntimeError::new_err(format!("no thread: {error}"))));
            }
            let mut interrupted = None;
            loop {
                match receiver.recv_timeout(PATIENCE) {
                    Ok(done) => return interrupted.map_or_else(|| done.map_err(Ended::Panicked), Err),
                    Err(RecvTimeoutError::Timeout) => {
                        if let Err(error) = Python::attach(|py| py.check_signals()) {
                            watch.0.store(true, Ordering::Relaxed);
                            interrupted.get_or_insert(Ended::Raised(error));
                        }
                    }
                    Err(RecvTimeoutError::Disconnected) => {
                        return Err(Ended::Raised(PyRuntimeError::new_err("a thread ended without a result")));
                    }
                }
            }
        })
    });
    done.map_err(raised)
}
