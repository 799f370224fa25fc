//! Recognition of text files by their first words.

use super::Content;
use crate::printable;

const MESH: &str = "Meshes are shapes of scenes, not materials";

/// The number of bytes of a text that are examined.
const HEAD: usize = 1 << 14;

/// The first bytes as text, if they are text.
pub(super) fn of(bytes: &[u8]) -> Option<String> {
    let head = &bytes[..bytes.len().min(HEAD)];
    let head = head.strip_prefix(b"\xef\xbb\xbf").unwrap_or(head);
    let text = match head {
        [0xff, 0xfe, rest @ ..] => utf16(rest, u16::from_le_bytes),
        [0xfe, 0xff, rest @ ..] => utf16(rest, u16::from_be_bytes),
        _ => String::from_utf8_lossy(head).into_owned(),
    };
    // Text in an old code page has some letters that are not UTF-8; if most bytes are not, it is not text.
    let odd = text.chars().filter(|c| *c == '\u{fffd}' || (c.is_control() && !c.is_whitespace() && *c != '\u{1b}'));
    let is_text = !text.contains('\0') && odd.count() * 20 <= text.chars().count();
    is_text.then_some(text)
}

fn utf16(bytes: &[u8], unit: impl Fn([u8; 2]) -> u16) -> String {
    let (units, _) = bytes.as_chunks();
    char::decode_utf16(units.iter().map(|bytes| unit(*bytes))).map(|c| c.unwrap_or('\u{fffd}')).collect()
}

pub(super) fn content(bytes: &[u8]) -> Option<Content> {
    // A header of lines, and mostly binary data after it.
    if bytes.starts_with(b"#?") {
        return radiance(&String::from_utf8_lossy(&bytes[..bytes.len().min(HEAD)]));
    }
    let text = of(bytes)?;
    let text = text.trim_start();
    if text.is_empty() {
        return Some(Content::new("a file of nothing but white space", super::AGAIN));
    }
    pointer(text).or_else(|| markup(text)).or_else(|| json(text)).or_else(|| mesh(text)).or_else(|| other(text))
}

/// Placeholders in a repository or a download for a file that is elsewhere.
fn pointer(text: &str) -> Option<Content> {
    let line = text.lines().next().unwrap_or_default().trim();
    if text.starts_with("version https://git-lfs.github.com/spec/") {
        return Some(Content::new(
            "a pointer of Git LFS in place of the file",
            "Fetch the file itself with `git lfs pull`, or download it from the page of the repository",
        ));
    }
    if line.starts_with("/annex/objects/") || line.contains("/.git/annex/objects/") {
        return Some(Content::new(
            "a pointer of git-annex in place of the file",
            "Fetch the file with `git annex get`",
        ));
    }
    let is_refusal = ["404: Not Found", "404 Not Found", "Not Found", "403 Forbidden", "AccessDenied", "Access denied"];
    is_refusal.contains(&line).then(|| {
        Content::new(
            format!("the message of a server, `{}`", printable(line)),
            "The file is not at the address that it was fetched from",
        )
    })
}

/// Files of Radiance declare their contents.
fn radiance(text: &str) -> Option<Content> {
    let head = text.strip_prefix("#?")?;
    let kind = head.lines().take_while(|line| !line.is_empty()).find_map(|line| line.strip_prefix("FORMAT="));
    Some(match kind.unwrap_or_default().trim() {
        "BSDF_RBFmesh" => Content::new(
            "an interpolated BSDF of Radiance (.sir)",
            "Convert it to a WINDOW file with `bsdf2klems` or `bsdf2ttree`",
        ),
        _ => {
            Content::new("a picture (Radiance HDR)", "Pictures are environments and textures of scenes, not materials")
        }
    })
}

/// `true` if a text is HTML.
pub(super) fn is_web_page(text: &str) -> bool {
    let lower = text.get(..14).unwrap_or(text).to_ascii_lowercase();
    ["<!doctype html", "<html", "<head", "<body"].iter().any(|start| lower.starts_with(start))
        || root(text).is_some_and(|name| name.eq_ignore_ascii_case("html"))
}

/// HTML and XML by the first element.
fn markup(text: &str) -> Option<Content> {
    if is_web_page(text) {
        let advice = "Download the file itself, not the page that shows it (on GitHub: the link `Raw`)";
        return Some(Content::new("a web page (HTML)", advice));
    }
    let name = root(text)?;
    Some(match name.to_ascii_lowercase().as_str() {
        "svg" => Content::new("a picture (SVG)", ""),
        "scene" => {
            let named = named_file(text).map_or(String::new(), |file| format!(", such as {file}"));
            Content::new("a scene of Mitsuba", format!("Open the material files that it names{named}"))
        }
        "materialx" => Content::new("a material of MaterialX", "It holds formulas, not measurements"),
        "error" => Content::new("the error message of a server (XML)", super::AGAIN),
        "collada" => Content::new("a mesh (COLLADA)", MESH),
        "x3d" => Content::new("a mesh (X3D)", MESH),
        "windowelement" => Content::new("a WINDOW file without data", ""),
        _ => Content::new(format!("an XML file of another kind, <{}>", printable(name)), ""),
    })
}

/// The name of the first element.
fn root(text: &str) -> Option<&str> {
    if !text.starts_with('<') {
        return None;
    }
    let mut rest = text;
    loop {
        rest = rest.trim_start().strip_prefix('<')?;
        if let Some(comment) = rest.strip_prefix("!--") {
            rest = comment.split_once("-->")?.1;
        } else if rest.starts_with(['?', '!']) {
            rest = rest.split_once('>')?.1;
        } else {
            let end = rest.find(|c: char| c.is_whitespace() || c == '>' || c == '/').unwrap_or(rest.len());
            return (1..=60).contains(&end).then(|| &rest[..end]);
        }
    }
}

/// The material file that a scene of Mitsuba names.
fn named_file(scene: &str) -> Option<String> {
    let (_, rest) = scene.split_once("name=\"filename\"")?;
    let value = rest.split_once("value=\"")?.1.split_once('"')?.0;
    (value.len() <= 60).then(|| printable(value).into_owned())
}

/// JSON, described by the names in its object.
fn json(text: &str) -> Option<Content> {
    let inner = text.strip_prefix('{')?.trim_start();
    if !inner.starts_with('"') {
        return None;
    }
    if text.contains("\"asset\"") && (text.contains("\"meshes\"") || text.contains("\"nodes\"")) {
        return Some(Content::new("a mesh (glTF)", MESH));
    }
    let mut names: Vec<String> = Vec::new();
    let (mut depth, mut rest) = (0_usize, text);
    while let Some(at) = rest.find(['{', '}', '[', ']', '"']) {
        let (mark, after) = (rest.as_bytes()[at], &rest[at + 1..]);
        rest = after;
        match mark {
            b'{' | b'[' => depth += 1,
            b'}' | b']' => depth = depth.saturating_sub(1),
            _ => {
                let end = after.find('"')?;
                rest = &after[end + 1..];
                if depth == 1 && rest.trim_start().starts_with(':') && names.len() < 3 {
                    names.push(format!("\"{}\"", printable(&after[..end.min(40)])));
                }
            }
        }
        if names.len() == 3 {
            break;
        }
    }
    let names = names.join(" and ");
    Some(Content::new(format!("a JSON file of another kind, with {names}"), ""))
}

/// OBJ and STL, recognised by their lines.
fn mesh(text: &str) -> Option<Content> {
    if text.starts_with("solid") && text.contains("facet normal") {
        return Some(Content::new("a mesh (STL)", MESH));
    }
    let is_number = |word: &str| word.parse::<f64>().is_ok();
    let is_vertex = |line: &str| {
        let mut words = line.split_whitespace();
        matches!(words.next(), Some("v")) && words.by_ref().take(3).filter(|word| is_number(word)).count() == 3
    };
    let mut lines = text.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with('#'));
    let is_other = |line: &str| {
        ["mtllib ", "o ", "g ", "usemtl ", "s ", "vn ", "vt ", "f "].iter().any(|word| line.starts_with(word))
    };
    let is_obj = lines.by_ref().take(50).try_fold(false, |seen, line| match () {
        () if is_vertex(line) => Some(true),
        () if is_other(line) => Some(seen),
        () => None,
    });
    // The last of the examined lines may be cut off.
    (is_obj == Some(true)).then(|| Content::new("a mesh (OBJ)", MESH))
}

/// Text files of other programs in this field.
fn other(text: &str) -> Option<Content> {
    const FORMULA: &str = "It holds formulas, not measurements";
    let has = |word: &str| text.contains(word);
    let first = text.split_whitespace().next().unwrap_or_default();
    Some(match () {
        () if has("::begin parameters") => {
            Content::new("a shader of Disney's BRDF Explorer, a formula", "It holds a formula, not a measurement")
        }
        () if first == "mdl" && has("import ") => Content::new("the source of an MDL material", FORMULA),
        () if text.starts_with("IESNA") => {
            Content::new("the light distribution of a lamp (IES)", "It holds no material")
        }
        () if has("#include <osl") || (has("closure color") && has("shader")) => Content::new("an OSL shader", FORMULA),
        () if has("WorldBegin") || has("LookAt ") && has("Camera ") => {
            Content::new("a scene of pbrt", "Open the material files that it names (`bsdffile`, `filename`)")
        }
        () if text.lines().any(|line| line.trim() == "[camera]") => Content::new(
            "a scene (TOML)",
            "`lobe render` makes pictures of scenes; open the material files that it names",
        ),
        () if is_radiance_scene(text) => Content::new("a scene of Radiance", "Open the material files that it names"),
        () if is_eulumdat(text) => Content::new("the light distribution of a lamp (EULUMDAT)", "It holds no material"),
        () if text.starts_with("#!/") => Content::new("a script", ""),
        () if first == "newmtl" => Content::new("the materials of an OBJ file (.mtl)", FORMULA),
        () => return None,
    })
}

/// `true` if the first statement is a material or a surface, as in `void plastic red`.
fn is_radiance_scene(text: &str) -> bool {
    let lines = text.lines().map(str::trim);
    let mut statements = lines.filter(|line| !line.is_empty() && !line.starts_with('#'));
    statements.next().is_some_and(|line| line.starts_with("void ") && line.split_whitespace().count() == 3)
}

/// `true` if the second line to the seventh are a type, a symmetry, and the numbers and steps of two angles.
fn is_eulumdat(text: &str) -> bool {
    let numbers: Vec<f64> = text.lines().skip(1).take(6).map_while(|line| line.trim().parse().ok()).collect();
    matches!(numbers[..], [kind, symmetry, ..] if numbers.len() == 6
        && [1.0, 2.0, 3.0].contains(&kind)
        && [0.0, 1.0, 2.0, 3.0, 4.0].contains(&symmetry))
}
