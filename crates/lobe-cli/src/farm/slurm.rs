//! Job scripts for Slurm: an array job for the parts, and a job that merges them when all are finished.

use std::path::PathBuf;
use std::process::Command;

use lobe_files::{check_output, write_whole};

use super::files::{begin, part, path, quoted};
use super::plan::{By, Planned, Wanted, absolute};
use crate::failure::Failure;
use crate::message::say;
use crate::picture::Kind;

/// Write job scripts for Slurm: an array job with one task per part, and a job that merges the parts.
///
/// The scripts and the parts are in the folder OUT.farm. All machines must have access to it and to the scene. A part
/// that fails is rendered again, up to three times, and one whose machine dies is requeued; finished parts are kept,
/// and interrupted ones continue.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  lobe farm slurm scene.toml -o picture.exr --parts 8
  lobe farm slurm scene.toml -o picture.exr --parts 8 --by samples --strict

Then `sh picture.exr.farm/submit.sh --partition=long --cpus-per-task=16` submits the job, with options for sbatch;
--submit does so at once. `lobe farm status picture.exr.farm` shows its progress.")]
pub struct Args {
    #[command(flatten)]
    wanted: Wanted,
    /// The picture, .exr or .png.
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// Submit the job.
    #[arg(long)]
    submit: bool,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<(), Failure> {
    Kind::of(&args.output)?;
    let planned = args.wanted.plan()?;
    let output = absolute(&args.output)?;
    check_output(&output, &planned.files)?;
    let mut folder = output.clone().into_os_string();
    folder.push(".farm");
    let folder = PathBuf::from(folder);
    begin(&folder, &planned.plan)?;
    let scripts = Scripts { planned: &planned, folder: &folder, output: &output };
    for (name, text) in [("part.sh", scripts.part()?), ("merge.sh", scripts.merge()?), ("submit.sh", scripts.submit()?)]
    {
        write_whole(&folder.join(name), text.as_bytes())?;
    }
    let submit = folder.join("submit.sh");
    if !args.submit {
        say(format_args!("{}: {} parts; submit it with: sh {}", folder.display(), planned.plan.parts, path(&submit)?));
        return Ok(());
    }
    match Command::new("sh").arg(&submit).status() {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(Failure::File(format!("{}: {status}", submit.display()))),
        Err(error) => Err(Failure::File(format!("sh: {error}"))),
    }
}

struct Scripts<'a> {
    planned: &'a Planned,
    folder: &'a std::path::Path,
    output: &'a std::path::Path,
}

impl Scripts<'_> {
    /// The head of a script, which sbatch reads.
    fn head(&self, name: &str, lines: &str, log: &str) -> Result<String, Failure> {
        let scene = self.planned.scene.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let job: String = scene.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '-' }).collect();
        // Sbatch has its own rules for quoted text, and for % in names of logs.
        let log = self.folder.join("log").join(log);
        let log = log.to_str().filter(|log| !log.contains(['"', '\n', '\\'])).ok_or_else(|| {
            let message = "found a name that sbatch cannot write logs to; expected one without quotes";
            Failure::Usage(format!("{}: {message}", self.folder.display()))
        })?;
        Ok(format!(
            "#!/bin/sh\n#SBATCH --job-name={name}-{job}\n{lines}#SBATCH --open-mode=append\n#SBATCH --output=\"{log}\"\n"
        ))
    }

    /// Renders the part that belongs to the task of the array.
    fn part(&self) -> Result<String, Failure> {
        let Planned { plan, scene, lobe, options, .. } = self.planned;
        let head =
            self.head("lobe", &format!("#SBATCH --array=1-{}\n#SBATCH --requeue\n", plan.parts), "part-%a.log")?;
        let which = match plan.by {
            By::Rows => format!("--tile \"$part/{}\"", plan.parts),
            By::Samples => format!(
                "--samples-range \"$(( {samples} * (part - 1) / {parts} ))..$(( {samples} * part / {parts} ))\"",
                samples = plan.samples,
                parts = plan.parts
            ),
        };
        let options: Vec<String> = options.iter().map(|option| quoted(option)).collect();
        let out = path(&self.folder.join("part-"))?;
        Ok(format!(
            "{head}part=$SLURM_ARRAY_TASK_ID
threads=${{SLURM_CPUS_PER_TASK:-}}
{lobe} render {scene} -o {out}\"$part.exr\" {which} {options} --resume --quiet ${{threads:+--threads \"$threads\"}}
status=$?
# A wrong job fails again, but another machine may succeed.
if [ $status -ne 0 ] && [ $status -ne 2 ] && [ \"${{SLURM_RESTART_COUNT:-0}}\" -lt 3 ]; then
    scontrol requeue \"${{SLURM_ARRAY_JOB_ID}}_$part\" && sleep 60
fi
exit $status
",
            lobe = path(lobe)?,
            scene = path(scene)?,
            options = options.join(" "),
        ))
    }

    /// Puts the parts together.
    fn merge(&self) -> Result<String, Failure> {
        let Planned { plan, lobe, .. } = self.planned;
        let head = self.head("merge", "#SBATCH --requeue\n", "merge.log")?;
        let parts = path(&part(self.folder, 0))?.replace("part-0.exr", "part-");
        Ok(format!(
            "{head}part=0
while [ $part -lt {count} ]; do
    part=$((part + 1))
    set -- \"$@\" {parts}\"$part.exr\"
done
exec {lobe} merge \"$@\" -o {output}
",
            count = plan.parts,
            lobe = path(lobe)?,
            output = path(self.output)?,
        ))
    }

    /// Submits both; the second runs if all tasks of the first succeed.
    fn submit(&self) -> Result<String, Failure> {
        let [part, merge] = ["part.sh", "merge.sh"].map(|name| path(&self.folder.join(name)));
        Ok(format!(
            "#!/bin/sh
# Options of sbatch may follow; they are for the parts.
parts=$(sbatch --parsable \"$@\" {part}) || exit
merge=$(sbatch --parsable --dependency=\"afterok:${{parts%%;*}}\" --kill-on-invalid-dep=yes {merge}) || exit
echo \"parts ${{parts%%;*}}, merge ${{merge%%;*}}\"
",
            part = part?,
            merge = merge?,
        ))
    }
}
