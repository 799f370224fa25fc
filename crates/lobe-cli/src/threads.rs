//! The threads among which work is divided.

use std::sync::mpsc;
use std::thread;

use rayon::ThreadPoolBuilder;

/// Creates rayon's pool with as many threads as the system allows; rayon itself would panic if one cannot be created.
pub fn start() {
    let asked = std::env::var("RAYON_NUM_THREADS").ok().and_then(|count| count.parse().ok()).filter(|count| *count > 0);
    let wanted = asked.unwrap_or_else(|| thread::available_parallelism().map_or(1, usize::from));
    let mut waiting = Vec::new();
    // A thread that waits for a task exists, whatever happens until it gets one.
    while waiting.len() < wanted {
        let (sender, receiver) = mpsc::channel::<rayon::ThreadBuilder>();
        let thread = thread::Builder::new().spawn(move || receiver.recv().map(rayon::ThreadBuilder::run));
        match thread {
            Ok(_) => waiting.push(sender),
            Err(_) => break,
        }
    }
    let pool = ThreadPoolBuilder::new();
    // It is not an error if the pool already exists.
    let _ = match waiting.len() {
        0 => pool.num_threads(1).use_current_thread().build_global(),
        threads => {
            let mut waiting = waiting.into_iter();
            let hand_over = move |thread| {
                let sent = waiting.next().map(|sender| sender.send(thread).is_ok());
                if sent == Some(true) { Ok(()) } else { Err(std::io::Error::other("no thread")) }
            };
            pool.num_threads(threads).spawn_handler(hand_over).build_global()
        }
    };
}
