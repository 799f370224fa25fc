//! `lobe view`: shows local files in the explorer, in a browser.

mod browser;
mod files;
mod page;

use std::io::Write;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use lobe_files::printable;
use tiny_http::{Header, Method, Request, Response, Server};

use crate::failure::Failure;
use crate::message;
use files::Shown;
use page::Page;

/// Look at materials in the browser: curves, lobes, pictures, checks. The page is updated when the files change.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  lobe view cloth.ddr                       opens the browser
  lobe view paint.bsdf paint.ddr            two materials side by side
  lobe view scans --no-open --port 8087     a folder; the address is printed

The page and the files are served on this computer only (127.0.0.1), until Ctrl-C. Files are read again when they change. The page makes no other connections.")]
pub struct Args {
    /// Files of measured materials, in any format that lobe reads, or folders.
    #[arg(required = true)]
    files: Vec<PathBuf>,
    /// Do not open the browser.
    #[arg(long)]
    no_open: bool,
    /// The port to listen on; 0 means any free port.
    #[arg(long, value_name = "N", default_value_t = 0)]
    port: u16,
    /// Stop after this time, such as 30m, rather than at Ctrl-C.
    #[arg(long = "for", value_name = "TIME", value_parser = humantime::parse_duration)]
    time: Option<Duration>,
    /// A folder with the explorer, as built by `cargo xtask web` [default: the explorer built into this program].
    #[arg(long, value_name = "FOLDER")]
    page: Option<PathBuf>,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<(), Failure> {
    let page = Page::find(args.page.as_deref())?;
    let shown = Shown::new(&args.files)?;
    // The loopback address only: other computers must not read files of this one.
    let server = Server::http(("127.0.0.1", args.port))
        .map_err(|error| Failure::File(format!("127.0.0.1:{}: {error}", args.port)))?;
    let Some(address) = server.server_addr().to_ip() else {
        return Err(Failure::File("found no address to listen on; expected 127.0.0.1".into()));
    };
    let url = format!("http://{address}/?served");
    let mut out = message::out(false);
    writeln!(out, "{url}")?;
    out.flush()?;
    drop(out);
    if !args.no_open && !browser::open(&url) {
        message::say(format_args!("found no browser; open {url} in one"));
    }
    crate::interrupt::listen_quietly();
    let host = [format!("127.0.0.1:{}", address.port()), format!("localhost:{}", address.port())];
    let begun = Instant::now();
    while !crate::interrupt::is_asked() && args.time.is_none_or(|time| begun.elapsed() < time) {
        match server.recv_timeout(Duration::from_millis(100)) {
            Ok(Some(request)) => answer(request, &page, &shown, &host),
            Ok(None) => {}
            Err(error) => return Err(Failure::File(error.to_string())),
        }
    }
    Ok(())
}

/// A response.
struct Answer {
    code: u16,
    kind: &'static str,
    bytes: Vec<u8>,
}

impl Answer {
    fn text(code: u16, text: &str) -> Self {
        Answer { code, kind: "text/plain; charset=utf-8", bytes: text.as_bytes().to_vec() }
    }
}

/// Answers a request. Errors are ignored, since they only mean that the client has disconnected.
fn answer(request: Request, page: &Page, shown: &Shown, host: &[String]) {
    let answer = match () {
        // A foreign page may point a host name of its own at this address to read the files (DNS rebinding).
        () if !is_from(&request, host) => Answer::text(403, "found another host; expected 127.0.0.1"),
        () if !matches!(request.method(), Method::Get | Method::Head) => {
            Answer::text(405, "found another method; expected GET")
        }
        () => content(request.url(), page, shown),
    };
    let mut response = Response::from_data(answer.bytes).with_status_code(answer.code);
    for (name, value) in [
        ("Content-Type", answer.kind),
        ("Cache-Control", "no-store"),
        ("X-Content-Type-Options", "nosniff"),
        ("Referrer-Policy", "no-referrer"),
        ("Cross-Origin-Resource-Policy", "same-origin"),
    ] {
        if let Ok(header) = Header::from_bytes(name, value) {
            response.add_header(header);
        }
    }
    let _ = request.respond(response);
}

/// `true` if a request has exactly one `Host` header and it names this computer.
fn is_from(request: &Request, host: &[String]) -> bool {
    let mut named = request.headers().iter().filter(|header| header.field.equiv("Host"));
    named.next().is_some_and(|header| host.iter().any(|host| header.value.as_str() == host)) && named.next().is_none()
}

/// The response for a URL: the list of files, one of the files, or a part of the page.
fn content(url: &str, page: &Page, shown: &Shown) -> Answer {
    let path = url.split(['?', '#']).next().unwrap_or_default().trim_start_matches('/');
    if path == "files.json" {
        return match shown.list() {
            Ok(bytes) => Answer { code: 200, kind: "application/json", bytes },
            Err(error) => Answer::text(500, &error),
        };
    }
    if let Some(number) = path.strip_prefix("files/") {
        return match number.parse().ok().and_then(|number: usize| shown.read(number)) {
            Some(Ok(bytes)) => Answer { code: 200, kind: "application/octet-stream", bytes },
            Some(Err(error)) => Answer::text(500, &printable(&error)),
            None => Answer::text(404, "found no such file"),
        };
    }
    match page.part(if path.is_empty() { "index.html" } else { path }) {
        Some((kind, bytes)) => Answer { code: 200, kind, bytes },
        None => Answer::text(404, "found no such part of the page"),
    }
}
