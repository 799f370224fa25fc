//! The braces of a tensor tree.
//!
//! `tree = "{" tree x 2^d "}" | "{" number x 2^(d k) "}"`, separated by white space or commas. A stack of open
//! branches, never deeper than [`MAX_DEPTH`], replaces recursion.

use lobe_table::window::tensor_tree::{MAX_DEPTH, Node, Rank, TensorTree};

use super::words::{number, quoted};

/// The place of an error in the text of a tree.
pub(super) struct TreeSyntax {
    pub(super) at: usize,
    pub(super) found: String,
    pub(super) expected: String,
}

impl TreeSyntax {
    fn new(at: usize, found: impl Into<String>, expected: impl Into<String>) -> Self {
        TreeSyntax { at, found: found.into(), expected: expected.into() }
    }
}

/// A branch whose children are being read.
struct Open {
    first: usize,
    filled: usize,
}

/// Braces and numbers, each with its offset.
fn tokens(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let mut at = 0;
    std::iter::from_fn(move || {
        let is_separator = |character: char| character.is_ascii_whitespace() || character == ',';
        at += text[at..].find(|character: char| !is_separator(character))?;
        let rest = &text[at..];
        let end = match rest.as_bytes()[0] {
            b'{' | b'}' => 1,
            _ => rest.find(|c: char| is_separator(c) || c == '{' || c == '}').unwrap_or(rest.len()),
        };
        let token = (at, &rest[..end]);
        at += end;
        Some(token)
    })
}

/// Reads one tree, which is all of `text`.
pub(super) fn parse(rank: Rank, text: &str) -> Result<TensorTree, TreeSyntax> {
    let children = 1_usize << rank.dimensions();
    let mut tokens = tokens(text).peekable();
    let mut nodes = vec![Node::Leaf { first: 0, level: 0 }];
    let mut values: Vec<f32> = Vec::new();
    let mut open: Vec<Open> = Vec::new();
    loop {
        // The node to read is the next child of the innermost open branch, or the root.
        let node = open.last().map_or(0, |branch| branch.first + branch.filled);
        match tokens.next() {
            Some((_, "{")) => {}
            Some((at, token)) => return Err(TreeSyntax::new(at, quoted(token), "'{', the start of a node")),
            None => return Err(TreeSyntax::new(text.len(), "the end of the tree", "'{', the start of a node")),
        }
        if let Some(&(at, "{")) = tokens.peek() {
            if open.len() == MAX_DEPTH {
                return Err(TreeSyntax::new(at, "braces nested deeper", format!("at most {MAX_DEPTH} levels")));
            }
            let first = nodes.len();
            nodes[node] = Node::Branch(index(first, 0)?);
            nodes.resize(first + children, Node::Leaf { first: 0, level: 0 });
            open.push(Open { first, filled: 0 });
            continue;
        }
        let first = values.len();
        let end = loop {
            match tokens.next() {
                Some((at, "}")) => break at,
                Some((at, token)) => {
                    values.push(number(token).ok_or_else(|| TreeSyntax::new(at, quoted(token), "a finite number"))?)
                }
                None => return Err(TreeSyntax::new(text.len(), "the end of the tree", "'}', the end of a leaf")),
            }
        };
        let count = values.len() - first;
        let level = count.checked_ilog2().unwrap_or(0) / rank.dimensions() as u32;
        if count != 1 << (level * rank.dimensions() as u32) {
            let expected = format!("a power of {children} of them");
            return Err(TreeSyntax::new(end, format!("a leaf of {count} values"), expected));
        }
        nodes[node] = Node::Leaf { first: index(first, end)?, level };
        // A node that ends may be the last of its branch, which then ends too, and so on.
        while let Some(branch) = open.last_mut() {
            branch.filled += 1;
            if branch.filled < children {
                break;
            }
            match tokens.next() {
                Some((_, "}")) => open.pop(),
                Some((at, token)) => {
                    let found = format!("{} after {children} child nodes", quoted(token));
                    return Err(TreeSyntax::new(at, found, "'}', the end of a branch"));
                }
                None => return Err(TreeSyntax::new(text.len(), "the end of the tree", "'}', the end of a branch")),
            };
        }
        if open.is_empty() {
            break;
        }
    }
    if let Some((at, token)) = tokens.next() {
        return Err(TreeSyntax::new(at, quoted(token), "nothing after the root of the tree"));
    }
    TensorTree::new(rank, nodes, values).map_err(|error| TreeSyntax::new(0, error.to_string(), "a tensor tree"))
}

fn index(position: usize, at: usize) -> Result<u32, TreeSyntax> {
    u32::try_from(position).map_err(|_| TreeSyntax::new(at, "a tree of more than 2^32 values", "fewer"))
}
