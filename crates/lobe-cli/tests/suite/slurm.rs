//! Tests `lobe farm slurm` on Slurm itself, if it is installed, with three nodes on this machine.

use std::io::Write as _;
use std::net::TcpListener;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use crate::common::{Files, json, printed, text};
use crate::hardening::SCENE;

/// How long the whole test may take on a busy machine.
const PATIENCE: Duration = Duration::from_secs(120);

/// Daemons, which end when this value is dropped.
struct Slurm {
    config: PathBuf,
    daemons: Vec<Child>,
}

impl Drop for Slurm {
    fn drop(&mut self) {
        for daemon in &mut self.daemons {
            let _ = daemon.kill();
            let _ = daemon.wait();
        }
    }
}

impl Slurm {
    /// Starts a controller and three nodes; returns the reason if it cannot.
    fn start(folder: &Path) -> Result<Slurm, String> {
        let [controller, node] = ["slurmctld", "slurmd"].map(daemon);
        let (Some(controller), Some(node)) = (controller, node) else {
            return Err("slurmctld and slurmd are not installed".into());
        };
        if said("id", &["-u"]) != "0" {
            return Err("only root can run the daemons of Slurm".into());
        }
        std::fs::create_dir_all(folder.join("state")).expect("a folder");
        let config = folder.join("slurm.conf");
        std::fs::write(&config, configuration(folder)).expect("a file");
        let mut slurm = Slurm { config, daemons: Vec::new() };
        slurm.run(Command::new(controller).args(["-D", "-c"]));
        for name in NODES {
            slurm.run(Command::new(&node).args(["-D", "-N", name]));
        }
        let begun = Instant::now();
        while slurm.said("sinfo", &["-h", "-o", "%T:%D"]) != "idle:3" {
            assert!(begun.elapsed() < PATIENCE, "nodes: {}", slurm.said("sinfo", &["-N", "-l"]));
            std::thread::sleep(Duration::from_millis(200));
        }
        Ok(slurm)
    }

    fn run(&mut self, command: &mut Command) {
        command.env("SLURM_CONF", &self.config).stdout(Stdio::null()).stderr(Stdio::null()).stdin(Stdio::null());
        self.daemons.push(command.spawn().expect("a daemon"));
    }

    fn said(&self, program: &str, arguments: &[&str]) -> String {
        let output = Command::new(program).args(arguments).env("SLURM_CONF", &self.config).output();
        let output = output.unwrap_or_else(|error| panic!("{program}: {error}"));
        String::from_utf8_lossy(&output.stdout).trim().into()
    }
}

const NODES: [&str; 3] = ["w1", "w2", "w3"];

/// Finds a daemon, whose folder is usually not on the path of users.
fn daemon(name: &str) -> Option<PathBuf> {
    let path = std::env::var_os("PATH").unwrap_or_default();
    let folders = std::env::split_paths(&path).chain(["/usr/sbin", "/usr/local/sbin"].map(PathBuf::from));
    folders.map(|folder| folder.join(name)).find(|file| file.is_file())
}

fn said(program: &str, arguments: &[&str]) -> String {
    let output = Command::new(program).args(arguments).output().unwrap_or_else(|error| panic!("{program}: {error}"));
    String::from_utf8_lossy(&output.stdout).trim().into()
}

/// Nodes of one processor each, without control groups and without keys.
fn configuration(folder: &Path) -> String {
    let host = said("uname", &["-n"]);
    let folder = text(folder);
    // Bound at the same time, so that the ports differ.
    let listeners: Vec<TcpListener> = (0..4).map(|_| TcpListener::bind("127.0.0.1:0").expect("a port")).collect();
    let ports: Vec<u16> = listeners.iter().map(|listener| listener.local_addr().expect("an address").port()).collect();
    let nodes = NODES.iter().zip(&ports[1..]).map(|(name, port)| {
        format!("NodeName={name} NodeHostname={host} NodeAddr=127.0.0.1 Port={port} CPUs=1 State=UNKNOWN\n")
    });
    format!(
        "ClusterName=test
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={port}
SlurmUser=root
AuthType=auth/none
CredType=cred/none
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SlurmdParameters=config_overrides
SlurmctldPidFile={folder}/slurmctld.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdPidFile={folder}/slurmd.%n.pid
SlurmdLogFile={folder}/slurmd.%n.log
SlurmdSpoolDir={folder}/spool.%n
StateSaveLocation={folder}/state
{nodes}PartitionName=all Nodes=w[1-3] Default=YES State=UP
",
        port = ports[0],
        nodes = nodes.collect::<String>(),
    )
}

#[test]
fn three_nodes_make_the_picture() {
    let files = Files::new();
    let slurm = match Slurm::start(&files.path("slurm")) {
        Ok(slurm) => slurm,
        Err(why) => {
            // Not through the test harness, which hides the output of passing tests.
            let _ = writeln!(std::io::stderr(), "SKIPPED: {why}");
            return;
        }
    };
    let scene = files.write("scene.toml", SCENE);
    let whole = files.path("whole.exr");
    printed(&["render", text(&scene), "-o", text(&whole), "--quiet"]);
    let out = files.path("picture.exr");
    printed(&["farm", "slurm", text(&scene), "-o", text(&out), "--parts", "6"]);
    let job = files.path("picture.exr.farm");
    let submitted = slurm.said("sh", &[text(&job.join("submit.sh"))]);
    assert!(submitted.starts_with("parts "), "{submitted}");
    let begun = Instant::now();
    while !slurm.said("squeue", &["-h"]).is_empty() {
        let queue = slurm.said("squeue", &[]);
        assert!(begun.elapsed() < PATIENCE, "{queue}\n{}", slurm.said("scontrol", &["show", "jobs"]));
        std::thread::sleep(Duration::from_millis(300));
    }
    let jobs = slurm.said("scontrol", &["-o", "show", "jobs"]);
    for name in NODES {
        assert!(jobs.contains(&format!(" NodeList={name} ")), "{name}: {jobs}");
    }
    assert_eq!(json(&["farm", "status", text(&job)])["finished"], 6, "{jobs}");
    let [picture, whole] =
        [&out, &whole].map(|file| std::fs::read(file).unwrap_or_else(|error| panic!("{error}: {jobs}")));
    assert!(picture == whole);
}
