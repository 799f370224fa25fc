//! `lobe completions` and `lobe man`: completions and manual pages.

use std::io::{Write, stdout};
use std::path::PathBuf;

use clap_complete::Shell;
use lobe_files::{check_folder, unwritable};

use crate::command;
use crate::failure::Failure;

/// Print the completions for a shell.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  lobe completions bash > ~/.local/share/bash-completion/completions/lobe
  lobe completions zsh > ~/.zfunc/_lobe
  lobe completions fish > ~/.config/fish/completions/lobe.fish")]
pub struct Completions {
    /// The shell.
    shell: Shell,
}

/// Print the manual page, or write the pages of all commands.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  lobe man | man -l -
  lobe man --out ~/.local/share/man/man1")]
pub struct Man {
    /// A folder for lobe.1 and one page per command.
    #[arg(long, value_name = "FOLDER")]
    out: Option<PathBuf>,
}

/// Runs `lobe completions`.
pub fn completions(args: &Completions) -> Result<(), Failure> {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut command(), "lobe", &mut script);
    print(&script)
}

/// Runs `lobe man`.
pub fn man(args: &Man) -> Result<(), Failure> {
    match &args.out {
        None => {
            let mut page = Vec::new();
            clap_mangen::Man::new(command()).render(&mut page)?;
            print(&page)
        }
        Some(folder) => {
            check_folder(folder)?;
            std::fs::create_dir_all(folder)
                .and_then(|()| clap_mangen::generate_to(command(), folder))
                .map_err(|error| unwritable(folder, &error).into())
        }
    }
}

fn print(bytes: &[u8]) -> Result<(), Failure> {
    let mut out = stdout().lock();
    out.write_all(bytes)?;
    Ok(out.flush()?)
}
