//! Runs the program under limits, and judges the outcome.

use std::fmt;
use std::path::Path;
use std::process::{Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

use anyhow::{Context, Result};

/// The limits of a run.
#[derive(Clone, Copy)]
pub struct Limits {
    /// Address space in MB.
    pub memory: u64,
    /// Seconds of processor time, of all threads together.
    pub seconds: u64,
}

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// With this exit code, which is one of those in the help of the program.
    Code(i32),
    Panic,
    /// Ended by a signal.
    Abort,
    /// Longer than the limit.
    Hang,
    /// A file was left that a failed command must not leave, or that is not whole.
    Left,
}

impl Outcome {
    /// `true` if the program did something that it must not do.
    pub fn is_finding(self) -> bool {
        !matches!(self, Outcome::Code(_))
    }

    /// Parses what [`Display`](fmt::Display) writes.
    pub fn parse(word: &str) -> Option<Self> {
        Some(match word {
            "panic" => Outcome::Panic,
            "abort" => Outcome::Abort,
            "hang" => Outcome::Hang,
            "left" => Outcome::Left,
            code => Outcome::Code(code.parse().ok()?),
        })
    }
}

impl fmt::Display for Outcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Outcome::Code(code) => write!(f, "{code}"),
            Outcome::Panic => f.write_str("panic"),
            Outcome::Abort => f.write_str("abort"),
            Outcome::Hang => f.write_str("hang"),
            Outcome::Left => f.write_str("left"),
        }
    }
}

/// How many times longer than its processor time a run may last: other programs run too.
const PATIENCE: u64 = 40;

/// Runs the program in a folder. Returns the outcome, the duration and the messages.
///
/// # Errors
/// If the program cannot be started.
pub fn run(program: &Path, arguments: &[String], folder: &Path, limits: Limits) -> Result<(Outcome, Duration, String)> {
    let Limits { memory, seconds } = limits;
    // The shell sets limits that the standard library cannot.
    let script = format!("ulimit -c 0; ulimit -v {}; ulimit -t {seconds}; exec \"$0\" \"$@\"", memory * 1000);
    let begun = Instant::now();
    let said = folder.join("said.txt");
    let error = std::fs::File::create(&said).with_context(|| said.display().to_string())?;
    let mut child = Command::new("sh")
        .args(["-c", &script])
        .arg(program)
        .args(arguments)
        .current_dir(folder)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(error)
        .spawn()
        .context("a shell")?;
    let status = loop {
        if let Some(status) = child.try_wait()? {
            break Some(status);
        }
        if begun.elapsed().as_secs() > PATIENCE * seconds {
            child.kill()?;
            child.wait()?;
            break None;
        }
        std::thread::sleep(Duration::from_millis(if begun.elapsed().as_millis() < 50 { 1 } else { 5 }));
    };
    let message = String::from_utf8_lossy(&std::fs::read(&said)?).into_owned();
    let mut outcome = status.map_or(Outcome::Hang, |status| judged(status, &message));
    if let Outcome::Code(code) = outcome
        && leaves(folder, code)?
    {
        outcome = Outcome::Left;
    }
    Ok((outcome, begun.elapsed(), message))
}

/// `true` if there is a temporary file, an empty output, or any output of a command that failed.
fn leaves(folder: &Path, code: i32) -> Result<bool> {
    for entry in std::fs::read_dir(folder)? {
        let entry = entry?;
        let name = entry.file_name().to_string_lossy().into_owned();
        let is_output = name.starts_with("out.");
        if name.starts_with(".lobe-") || is_output && (matches!(code, 1 | 2) || entry.metadata()?.len() == 0) {
            return Ok(true);
        }
    }
    Ok(false)
}

fn judged(status: ExitStatus, message: &str) -> Outcome {
    match status.code() {
        _ if message.contains("panicked at") => Outcome::Panic,
        Some(code @ 0..=3) => Outcome::Code(code),
        Some(_) => Outcome::Abort,
        None if is_out_of_time(status) => Outcome::Hang,
        None => Outcome::Abort,
    }
}

#[cfg(unix)]
fn is_out_of_time(status: ExitStatus) -> bool {
    use std::os::unix::process::ExitStatusExt as _;
    /// Sent when the limit of processor time is exceeded, and followed by SIGKILL if it is ignored.
    const SIGXCPU: i32 = 24;
    const SIGKILL: i32 = 9;
    matches!(status.signal(), Some(SIGXCPU | SIGKILL))
}

#[cfg(not(unix))]
fn is_out_of_time(_: ExitStatus) -> bool {
    false
}
