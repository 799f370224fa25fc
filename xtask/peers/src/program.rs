//! A peer in a separate process, which answers one request per line; `serve.py` describes the protocol.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

use anyhow::{Context, anyhow, bail};

/// A program that waits for requests. It ends when this value is dropped.
#[derive(Debug)]
pub struct Program {
    version: String,
    child: Child,
    input: ChildStdin,
    output: BufReader<ChildStdout>,
}

impl Program {
    /// Starts a program and waits until it is ready. Its standard error goes to `log`.
    ///
    /// # Errors
    /// If it does not become ready; the error contains the last line of its log.
    pub fn start(mut command: Command, log: &Path) -> anyhow::Result<Self> {
        let errors = File::create(log).with_context(|| format!("cannot create {}", log.display()))?;
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(errors);
        let mut child = command.spawn().with_context(|| format!("cannot start {:?}", command.get_program()))?;
        let input = child.stdin.take().expect("a pipe");
        let output = BufReader::new(child.stdout.take().expect("a pipe"));
        let mut program = Program { version: String::new(), child, input, output };
        let line = program.line().map_err(|_| {
            let text = std::fs::read_to_string(log).unwrap_or_default();
            anyhow!("it does not start: {}", text.lines().next_back().unwrap_or("it wrote nothing"))
        })?;
        program.version =
            line.strip_prefix("ready ").with_context(|| format!("it answered `{line}`; expected `ready`"))?.to_owned();
        Ok(program)
    }

    /// The least processor time of some runs of a task, in seconds.
    fn run(&mut self, task: &str, times: usize) -> anyhow::Result<f64> {
        let answer = self.ask(&format!("run {task} {times}"))?;
        answer.parse().with_context(|| format!("it answered `{answer}`; expected seconds"))
    }

    /// Has the results of a run of a task written to a file.
    fn write(&mut self, task: &str, file: &Path) -> anyhow::Result<()> {
        match self.ask(&format!("values {task} {}", file.display()))?.as_str() {
            "written" => Ok(()),
            answer => bail!("it answered `{answer}`; expected `written`"),
        }
    }

    fn ask(&mut self, request: &str) -> anyhow::Result<String> {
        writeln!(self.input, "{request}").and_then(|()| self.input.flush()).context("it has ended")?;
        self.line()
    }

    fn line(&mut self) -> anyhow::Result<String> {
        let mut line = String::new();
        if self.output.read_line(&mut line)? == 0 {
            bail!("it has ended");
        }
        Ok(line.trim_end().to_owned())
    }
}

impl Drop for Program {
    fn drop(&mut self) {
        // It may already have ended, which is fine.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// The programs by name: those that could be started, and the reasons why the others could not.
#[derive(Debug, Default)]
pub struct Programs(BTreeMap<&'static str, anyhow::Result<Program>>);

impl Programs {
    /// Adds a program.
    pub fn add(&mut self, name: &'static str, program: anyhow::Result<Program>) {
        self.0.insert(name, program.map_err(|error| anyhow!("{error:#}")));
    }

    /// `true` if it runs.
    pub fn has(&self, name: &str) -> bool {
        self.0.get(name).is_some_and(Result::is_ok)
    }

    /// The reasons why some do not run.
    pub fn missing(&self) -> impl Iterator<Item = (&'static str, String)> {
        self.0.iter().filter_map(|(name, program)| Some((*name, program.as_ref().err()?.to_string())))
    }

    /// The versions of the running programs.
    pub fn versions(&self) -> BTreeMap<&'static str, String> {
        self.0.iter().filter_map(|(name, program)| Some((*name, program.as_ref().ok()?.version.clone()))).collect()
    }

    /// The least processor time of some runs of a task, in seconds.
    ///
    /// # Errors
    /// If the program does not answer.
    pub fn run(&mut self, name: &str, task: &str, times: usize) -> anyhow::Result<f64> {
        self.get(name)?.run(task, times).with_context(|| format!("{name}, {task}"))
    }

    /// Has the results of a run of a task written to a file.
    ///
    /// # Errors
    /// If the program does not answer.
    pub fn write(&mut self, name: &str, task: &str, file: &Path) -> anyhow::Result<()> {
        self.get(name)?.write(task, file).with_context(|| format!("{name}, {task}"))
    }

    fn get(&mut self, name: &str) -> anyhow::Result<&mut Program> {
        match self.0.get_mut(name) {
            Some(Ok(program)) => Ok(program),
            _ => bail!("{name} does not run"),
        }
    }
}
