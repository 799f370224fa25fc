//! Commands in texts.

/// A block of lines for the shell.
pub struct Block {
    pub lines: Vec<String>,
    pub is_slow: bool,
}

/// The blocks of a Markdown document that are marked `sh` or `sh slow`. Lines that belong together, such as those of a
/// loop, count as one.
pub fn blocks(document: &str) -> Vec<Block> {
    let mut blocks: Vec<Block> = Vec::new();
    let mut is_open = false;
    for line in document.lines() {
        match line.trim_start().strip_prefix("```") {
            Some(_) if is_open => is_open = false,
            Some(mark @ ("sh" | "sh slow")) => {
                blocks.push(Block { lines: Vec::new(), is_slow: mark == "sh slow" });
                is_open = true;
            }
            Some(_) => {}
            None if is_open && !line.trim().is_empty() => {
                let Some(Block { lines, .. }) = blocks.last_mut() else { continue };
                match lines.last_mut() {
                    Some(last) if is_unfinished(last) => {
                        last.push('\n');
                        last.push_str(line);
                    }
                    _ => lines.push(line.trim().into()),
                }
            }
            None => {}
        }
    }
    blocks
}

/// `true` if a loop is open, or a line is continued.
fn is_unfinished(line: &str) -> bool {
    line.ends_with('\\') || (line.starts_with("for ") && !line.lines().any(|line| line.trim() == "done"))
}

/// The commands of this project in the sentences of a Markdown document: text between single backquotes that begins
/// with `lobe` or `cargo`.
pub fn spans(document: &str) -> Vec<String> {
    let mut found = Vec::new();
    let mut is_open = false;
    let mut sentences = String::new();
    for line in document.lines() {
        if line.trim_start().starts_with("```") {
            is_open = !is_open;
        } else if !is_open {
            sentences.push_str(line);
            sentences.push('\n');
        }
    }
    for span in sentences.split('`').skip(1).step_by(2) {
        let span = span.split_whitespace().collect::<Vec<_>>().join(" ");
        if span.starts_with("lobe ") || span.starts_with("cargo ") {
            found.push(span);
        }
    }
    found
}

/// The names in the list of commands of a help text.
pub fn subcommands(help: &str) -> Vec<String> {
    let list = help.lines().skip_while(|line| *line != "Commands:").skip(1);
    let list = list.take_while(|line| line.starts_with("  "));
    let names = list.filter(|line| !line.starts_with("   ")).filter_map(|line| line.split_whitespace().next());
    names.filter(|name| *name != "help").map(String::from).collect()
}

/// The commands under `Example:` or `Examples:` in a help text, without their explanations.
pub fn examples(help: &str) -> Vec<String> {
    let after = help.lines().skip_while(|line| !["Example:", "Examples:"].contains(line)).skip(1);
    let of_list = after.take_while(|line| line.starts_with("  "));
    // Two or more spaces separate the explanation of a command from it.
    of_list.map(|line| line.trim().split("   ").next().unwrap_or_default().trim().to_string()).collect()
}

#[test]
fn loops_count_as_one_line_and_other_blocks_are_ignored() {
    let document = "a `lobe info FILE` b\n```sh\none # first\n\ntwo\n```\n```text\nnot this\n```\n```sh slow\nfor x in y; do\n    z\ndone\n```\n";
    let found = blocks(document);
    assert_eq!(found.len(), 2);
    assert_eq!((&found[0].lines, found[0].is_slow), (&vec!["one # first".to_string(), "two".into()], false));
    assert_eq!((&found[1].lines, found[1].is_slow), (&vec!["for x in y; do\n    z\ndone".to_string()], true));
    assert_eq!(spans(document), ["lobe info FILE"]);
}

#[test]
fn examples_end_at_the_blank_line() {
    let help = "Commands:\n  one    What it does\n         and more\n  help   Print\n\nExamples:\n  lobe a b       what it does\n  lobe c | d\n\nNot this\n";
    assert_eq!(examples(help), ["lobe a b", "lobe c | d"]);
    assert_eq!(subcommands(help), ["one"]);
}
