//! A file server for one folder: GET and HEAD, right types, the headers of a careful host.
//!
//! For development on one machine; any file server can serve the finished site.

use std::fs;
use std::io::{self, BufRead as _, BufReader, Write as _};
use std::net::TcpStream;
use std::path::{Component, Path, PathBuf};
use std::time::Duration;

/// What a page with widgets needs and no more. Formulas bring their own fonts; the page shows the
/// embedding examples in frames of its own.
const CONTENT_SECURITY_POLICY: &str = "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; \
     connect-src 'self'; img-src 'self' data:; style-src 'self' 'unsafe-inline'; \
     font-src 'self'; frame-src 'self'; base-uri 'none'; form-action 'none'";

/// The first line of a request is never longer.
const LINE_LIMIT: u64 = 16 * 1024;

/// Answers one request on a connection and closes it.
pub fn answer(stream: TcpStream, folder: &Path) {
    // A reader that went away is no error of ours.
    let _ = try_answer(stream, folder);
}

fn try_answer(mut stream: TcpStream, folder: &Path) -> io::Result<()> {
    stream.set_read_timeout(Some(Duration::from_secs(10)))?;
    let mut reader = BufReader::new(io::Read::take(stream.try_clone()?, LINE_LIMIT));
    let mut request_line = String::new();
    reader.read_line(&mut request_line)?;
    // The rest of the head has to be read: closing with unread input resets the connection.
    let mut line = String::new();
    while reader.read_line(&mut line)? > 2 {
        line.clear();
    }
    let response = respond(&request_line, folder);
    stream.write_all(response.head().as_bytes())?;
    if !request_line.starts_with("HEAD ") {
        stream.write_all(&response.body)?;
    }
    stream.flush()
}

struct Response {
    status: &'static str,
    content_type: &'static str,
    cache: &'static str,
    body: Vec<u8>,
}

impl Response {
    fn plain(status: &'static str) -> Self {
        Self {
            status,
            content_type: "text/plain; charset=utf-8",
            cache: "no-store",
            body: format!("{status}\n").into_bytes(),
        }
    }

    fn head(&self) -> String {
        let length = self.body.len();
        // The origin header lets a sandboxed frame, which has no origin, load script and wasm.
        format!(
            "HTTP/1.1 {}\r\nContent-Type: {}\r\nContent-Length: {length}\r\nCache-Control: {}\r\n\
             Content-Security-Policy: {CONTENT_SECURITY_POLICY}\r\n\
             Access-Control-Allow-Origin: *\r\nX-Content-Type-Options: nosniff\r\n\
             Connection: close\r\n\r\n",
            self.status, self.content_type, self.cache
        )
    }
}

fn respond(request_line: &str, folder: &Path) -> Response {
    let mut words = request_line.split_whitespace();
    let (Some(method), Some(target)) = (words.next(), words.next()) else {
        return Response::plain("400 Bad Request");
    };
    if method != "GET" && method != "HEAD" {
        return Response::plain("405 Method Not Allowed");
    }
    let Some(path) = file_of(target, folder) else {
        return Response::plain("404 Not Found");
    };
    match fs::read(&path) {
        Ok(body) => Response {
            status: "200 OK",
            content_type: content_type(&path),
            cache: "no-cache",
            body,
        },
        Err(_) => Response::plain("404 Not Found"),
    }
}

/// The file that a request means; none where it would lead out of the folder.
fn file_of(target: &str, folder: &Path) -> Option<PathBuf> {
    let path = target.split(['?', '#']).next()?;
    let relative = percent_decode(path)?;
    let relative = Path::new(relative.trim_start_matches('/'));
    let stays_inside = relative
        .components()
        .all(|component| matches!(component, Component::Normal(_) | Component::CurDir));
    if !stays_inside {
        return None;
    }
    let mut file = folder.join(relative);
    if file.is_dir() {
        file.push("index.html");
    }
    Some(file)
}

fn percent_decode(text: &str) -> Option<String> {
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.bytes();
    while let Some(byte) = rest.next() {
        if byte != b'%' {
            bytes.push(byte);
            continue;
        }
        let high = char::from(rest.next()?).to_digit(16)?;
        let low = char::from(rest.next()?).to_digit(16)?;
        bytes.push(u8::try_from(high * 16 + low).ok()?);
    }
    String::from_utf8(bytes).ok()
}

fn content_type(path: &Path) -> &'static str {
    match path.extension().and_then(|ending| ending.to_str()) {
        Some("html") => "text/html; charset=utf-8",
        Some("css") => "text/css; charset=utf-8",
        Some("js" | "mjs") => "text/javascript; charset=utf-8",
        Some("json" | "map") => "application/json",
        Some("wasm") => "application/wasm",
        Some("svg") => "image/svg+xml",
        Some("png") => "image/png",
        Some("woff2") => "font/woff2",
        Some("woff") => "font/woff",
        Some("ttf") => "font/ttf",
        Some("csv") => "text/csv; charset=utf-8",
        Some("txt" | "md" | "ts") => "text/plain; charset=utf-8",
        _ => "application/octet-stream",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Read as _;
    use std::net::{Ipv4Addr, TcpListener};
    use std::thread;

    /// What the server answers to one request over a real connection.
    fn ask(request: &str) -> String {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).unwrap();
        let address = listener.local_addr().unwrap();
        let server = thread::spawn(move || answer(listener.accept().unwrap().0, folder));
        let mut stream = TcpStream::connect(address).unwrap();
        stream.write_all(request.as_bytes()).unwrap();
        let mut answer = String::new();
        stream.read_to_string(&mut answer).unwrap();
        server.join().unwrap();
        answer
    }

    #[test]
    fn a_file_comes_with_its_type_and_the_policy() {
        let answer = ask("GET /Cargo.toml?x=1 HTTP/1.1\r\nHost: a\r\n\r\n");
        assert!(answer.starts_with("HTTP/1.1 200 OK\r\n"), "{answer}");
        assert!(answer.contains("'wasm-unsafe-eval'"), "{answer}");
        assert!(answer.ends_with(include_str!("../Cargo.toml")), "{answer}");
    }

    #[test]
    fn head_gives_the_length_and_no_body() {
        let answer = ask("HEAD /Cargo.toml HTTP/1.1\r\n\r\n");
        let length = include_str!("../Cargo.toml").len();
        assert!(answer.contains(&format!("Content-Length: {length}\r\n")));
        assert!(answer.ends_with("\r\n\r\n"), "{answer}");
    }

    #[test]
    fn no_request_leads_out_of_the_folder() {
        for path in [
            "/../Cargo.toml",
            "/src/../../xtask/Cargo.toml",
            "/%2e%2e/Cargo.toml",
            "//etc/passwd",
            "/src/%2e%2e%2f%2e%2e/Cargo.toml",
        ] {
            let answer = ask(&format!("GET {path} HTTP/1.1\r\n\r\n"));
            assert!(answer.starts_with("HTTP/1.1 404"), "{path}: {answer}");
        }
    }

    #[test]
    fn wasm_and_modules_have_the_types_that_browsers_insist_on() {
        assert_eq!(content_type(Path::new("a.wasm")), "application/wasm");
        assert!(content_type(Path::new("a.js")).starts_with("text/javascript"));
    }

    #[test]
    fn what_is_no_request_is_refused() {
        assert!(ask("\r\n\r\n").starts_with("HTTP/1.1 400"));
        assert!(ask("POST / HTTP/1.1\r\n\r\n").starts_with("HTTP/1.1 405"));
    }
}
