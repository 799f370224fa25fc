//! Opening the browser that the user has chosen.

use std::process::{Command, Stdio};

/// Opens an address in the browser; `false` if there is no program that does.
pub fn open(url: &str) -> bool {
    let commands: &[&[&str]] = if cfg!(target_os = "macos") {
        &[&["open"]]
    } else if cfg!(windows) {
        &[&["rundll32", "url.dll,FileProtocolHandler"]]
    } else {
        &[&["xdg-open"], &["gio", "open"], &["wslview"]]
    };
    let opens = |command: &&[&str]| {
        let (program, arguments) = command.split_first().unwrap_or((&"", &[]));
        let started = Command::new(program)
            .args(arguments)
            .arg(url)
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn();
        // Whether it succeeds is not waited for: some of them run as long as the browser does.
        started.is_ok()
    };
    commands.iter().any(opens)
}
