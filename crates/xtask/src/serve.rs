//! `cargo xtask serve`: builds the site and serves it on this machine, with strict security headers.
//!
//! Any file server can serve the finished site. This one exists because small servers on crates.io send no custom
//! headers, and those that do take longer to compile than the rest of this program.

use std::io::{self, BufRead as _, BufReader, Write as _};
use std::net::{Ipv4Addr, TcpListener, TcpStream};
use std::path::{Component, Path, PathBuf};
use std::{fs, thread};

use anyhow::Context as _;

use crate::run::root;
use crate::site::{self, Speed};

/// Only what a page with widgets needs: fonts for the formulas, and frames for the embedding examples. A sandboxed
/// frame has no origin and must be able to load script and wasm.
const HEADERS: &str = "Content-Security-Policy: default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; \
     connect-src 'self'; img-src 'self' data:; style-src 'self' 'unsafe-inline'; font-src 'self'; \
     frame-src 'self'; base-uri 'none'; form-action 'none'\r\n\
     Access-Control-Allow-Origin: *\r\nX-Content-Type-Options: nosniff\r\n\
     Cache-Control: no-cache\r\nConnection: close\r\n";

/// Builds the site and serves it until it is stopped.
///
/// # Errors
/// A build step that fails, or a port that is taken.
pub fn serve(port: u16, speed: Speed) -> anyhow::Result<()> {
    // Report a port in use before minutes of building.
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port)).with_context(|| {
        format!(
            "port {port} is not available: try another one, such as `cargo xtask serve --port 9000`"
        )
    })?;
    site::build(speed)?;
    println!("\nServing on http://localhost:{port}/   (stop with Ctrl+C)");
    // A client that disconnects is not an error.
    for stream in listener.incoming().flatten() {
        thread::spawn(move || answer(stream, &root().join("dist")));
    }
    Ok(())
}

/// Answers one request on a connection and closes it.
fn answer(mut stream: TcpStream, folder: &Path) -> io::Result<()> {
    let mut lines = BufReader::new(stream.try_clone()?).lines();
    let request = lines.next().transpose()?.unwrap_or_default();
    // Read the rest of the head, because closing with unread input resets the connection.
    lines.find(|line| line.as_ref().map_or(true, String::is_empty));
    let mut words = request.split(' ');
    let (method, target) = (words.next(), words.next().unwrap_or_default());
    let file = match method {
        Some("GET" | "HEAD") => file_of(target, folder),
        _ => None,
    };
    let read = file.and_then(|path| Some((fs::read(&path).ok()?, content_type(&path))));
    let (status, (body, kind)) = match read {
        Some(found) => ("200 OK", found),
        None => ("404 Not Found", (b"Not found\n".to_vec(), "text/plain")),
    };
    let length = body.len();
    write!(
        stream,
        "HTTP/1.1 {status}\r\nContent-Type: {kind}\r\nContent-Length: {length}\r\n{HEADERS}\r\n"
    )?;
    if method == Some("GET") {
        stream.write_all(&body)?;
    }
    stream.flush()
}

/// Returns the file of a request, unless it is outside of the folder. No name in the site needs an escape.
fn file_of(target: &str, folder: &Path) -> Option<PathBuf> {
    let path = target.split(['?', '#']).next()?;
    let relative = Path::new(path.trim_start_matches('/'));
    let mut parts = relative.components();
    if !parts.all(|part| matches!(part, Component::Normal(_))) {
        return None;
    }
    let file = folder.join(relative);
    Some(if file.is_dir() {
        file.join("index.html")
    } else {
        file
    })
}

fn content_type(path: &Path) -> &'static str {
    match path.extension().and_then(|ending| ending.to_str()) {
        Some("html") => "text/html; charset=utf-8",
        Some("css") => "text/css; charset=utf-8",
        Some("js" | "mjs") => "text/javascript; charset=utf-8",
        Some("json") => "application/json",
        Some("wasm") => "application/wasm",
        Some("svg") => "image/svg+xml",
        Some("woff2") => "font/woff2",
        Some("csv" | "txt" | "ts") => "text/plain; charset=utf-8",
        _ => "application/octet-stream",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the server's response to one request over a real connection.
    fn ask(request: &str) -> String {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).unwrap();
        let mut stream = TcpStream::connect(listener.local_addr().unwrap()).unwrap();
        stream.write_all(request.as_bytes()).unwrap();
        answer(listener.accept().unwrap().0, folder).unwrap();
        io::read_to_string(stream).unwrap()
    }

    #[test]
    fn a_file_comes_with_its_type_and_the_policy() {
        let answer = ask("GET /Cargo.toml?x=1 HTTP/1.1\r\nHost: a\r\n\r\n");
        assert!(answer.starts_with("HTTP/1.1 200 OK\r\n"), "{answer}");
        assert!(answer.contains("'wasm-unsafe-eval'"), "{answer}");
        assert!(answer.ends_with(include_str!("../Cargo.toml")), "{answer}");
        assert_eq!(content_type(Path::new("a.wasm")), "application/wasm");
        assert!(content_type(Path::new("a.js")).starts_with("text/javascript"));
    }

    #[test]
    fn head_gives_the_length_and_no_body() {
        let answer = ask("HEAD /Cargo.toml HTTP/1.1\r\n\r\n");
        let length = include_str!("../Cargo.toml").len();
        assert!(answer.contains(&format!("Content-Length: {length}\r\n")));
        assert!(answer.ends_with("\r\n\r\n"), "{answer}");
    }

    #[test]
    fn no_request_leads_out_of_the_folder_and_what_is_no_request_is_refused() {
        for line in [
            "GET /../xtask/Cargo.toml HTTP/1.1",
            "GET /src/../Cargo.toml HTTP/1.1",
            "GET /%2e%2e/Cargo.toml HTTP/1.1",
            "GET //etc/passwd HTTP/1.1",
            "POST /Cargo.toml HTTP/1.1",
            "",
        ] {
            let answer = ask(&format!("{line}\r\n\r\n"));
            assert!(answer.starts_with("HTTP/1.1 404"), "{line}: {answer}");
        }
    }
}
