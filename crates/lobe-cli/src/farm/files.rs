//! The folder of a job, and text for shells.

use std::path::{Path, PathBuf};

use lobe_files::{check_folder, unwritable, write_whole};

use super::plan::Plan;
use crate::failure::Failure;

/// The file that describes a job.
pub const PLAN: &str = "plan.json";

/// The file of one part in the folder of a job.
pub fn part(folder: &Path, part: u32) -> PathBuf {
    folder.join(format!("part-{part}.exr"))
}

/// Creates the folder of a job; parts in it are kept if they belong to the same plan.
///
/// # Errors
/// If the folder cannot be created, or has parts of another plan.
pub fn begin(folder: &Path, plan: &Plan) -> Result<(), Failure> {
    check_folder(folder)?;
    let file = folder.join(PLAN);
    if file.exists() {
        let earlier = read(folder)?;
        if earlier != *plan {
            return Err(Failure::Usage(format!(
                "{}: found a job of {} parts of {} x {} pixels with {} samples; expected the same job, or none: remove \
                 the folder, or write to another name",
                folder.display(),
                earlier.parts,
                earlier.size[0],
                earlier.size[1],
                earlier.samples
            )));
        }
    }
    std::fs::create_dir_all(folder.join("log")).map_err(|error| unwritable(folder, &error))?;
    Ok(write_whole(&file, serde_json::to_string_pretty(plan)?.as_bytes())?)
}

/// The plan of a job.
///
/// # Errors
/// If the folder has no plan, or an invalid one.
pub fn read(folder: &Path) -> Result<Plan, Failure> {
    let file = folder.join(PLAN);
    let wrong = |error: String| Failure::File(format!("{}: {error}; expected the plan of a job", file.display()));
    let bytes = lobe_files::bytes(&file).map_err(|error| wrong(error.to_string()))?;
    let plan: Plan = serde_json::from_slice(&bytes).map_err(|error| wrong(error.to_string()))?;
    match plan.is_sound() {
        true => Ok(plan),
        false => Err(wrong(format!(
            "found {} parts of {} x {} pixels with {} samples",
            plan.parts, plan.size[0], plan.size[1], plan.samples
        ))),
    }
}

/// Quotes any text as one word of a shell.
pub fn quoted(word: &str) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "-_./=:,+%@".contains(c);
    match !word.is_empty() && word.chars().all(is_plain) {
        true => word.into(),
        false => format!("'{}'", word.replace('\'', r"'\''")),
    }
}

/// Quotes a path as one word of a shell.
///
/// # Errors
/// If it is not Unicode, because scripts are.
pub fn path(path: &Path) -> Result<String, Failure> {
    let text = path.to_str().ok_or_else(|| {
        Failure::Usage(format!(
            "{}: found a path that is not Unicode; expected one that a script can name",
            path.display()
        ))
    })?;
    Ok(quoted(text))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shells_read_quoted_words_unchanged() {
        assert_eq!(quoted("/a/b-1.exr"), "/a/b-1.exr");
        assert_eq!(quoted("it's $HOME"), r"'it'\''s $HOME'");
        assert_eq!(quoted(""), "''");
        let mut said = std::process::Command::new("sh");
        said.arg("-c").arg(format!("printf %s {}", quoted("a'b \"$x\" `y`\n;")));
        if let Ok(output) = said.output() {
            assert_eq!(String::from_utf8_lossy(&output.stdout), "a'b \"$x\" `y`\n;");
        }
    }
}
