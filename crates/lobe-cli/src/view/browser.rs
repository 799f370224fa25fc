//! Opens the user's default browser.

use std::process::{Command, Stdio};

/// Opens a URL in the default browser. Returns `false` if no program for that could be started.
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
        // Not waited for: some of these programs run as long as the browser.
        started.is_ok()
    };
    commands.iter().any(opens)
}
