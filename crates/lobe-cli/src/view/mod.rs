//! `lobe view`: the explorer in a browser, with files of this computer.

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

/// Look at materials in the browser: curves, lobes, pictures, checks. The page follows the files when they change.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  lobe view cloth.ddr                       opens the browser
  lobe view paint.bsdf paint.ddr            two materials side by side
  lobe view scans --no-open --port 8087     a folder; the address is printed

The page and the files are served on this computer only (127.0.0.1), until Ctrl-C. The files are read again when they change. The page needs no connection to anywhere else.")]
pub struct Args {
    /// Files of measured materials, of any format that lobe opens, or folders.
    #[arg(required = true)]
    files: Vec<PathBuf>,
    /// Do not open the browser.
    #[arg(long)]
    no_open: bool,
    /// The port to listen on; 0 is any that is free.
    #[arg(long, value_name = "N", default_value_t = 0)]
    port: u16,
    /// End after this time, such as 30m, rather than at Ctrl-C.
    #[arg(long = "for", value_name = "TIME", value_parser = humantime::parse_duration)]
    time: Option<Duration>,
    /// A folder with the explorer, as `cargo xtask web` makes it [default: the one that this program was built with].
    #[arg(long, value_name = "FOLDER")]
    page: Option<PathBuf>,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<(), Failure> {
    let page = Page::find(args.page.as_deref())?;
    let shown = Shown::new(&args.files)?;
    // Nobody but this computer may ask for files of it.
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
        message::say(format_args!("found no browser to open; open {url}"));
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

/// What is sent back.
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

/// Answers a request. Whoever has gone away in the meantime is not waited for.
fn answer(request: Request, page: &Page, shown: &Shown, host: &[String]) {
    let answer = match () {
        // A page of elsewhere may give this address a name of its own, and would read the files by it.
        () if !is_from(&request, host) => Answer::text(403, "found another host; expected 127.0.0.1"),
        () if !matches!(request.method(), Method::Get | Method::Head) => Answer::text(405, "expected GET"),
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

/// Whether a request names this computer as its host.
fn is_from(request: &Request, host: &[String]) -> bool {
    let mut named = request.headers().iter().filter(|header| header.field.equiv("Host"));
    named.next().is_some_and(|header| host.iter().any(|host| header.value.as_str() == host)) && named.next().is_none()
}

/// What there is at an address: the list of files, one of them, or a part of the page.
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
