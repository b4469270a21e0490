//! `cargo xtask serve`: builds the site and serves it on this machine.
//!
//! Any file server can serve the finished site. This one exists because small servers on crates.io send no custom
//! headers, and those that do take longer to compile than the rest of this program.

use std::io::{self, BufRead as _, BufReader, Write as _};
use std::net::{Ipv4Addr, TcpListener, TcpStream};
use std::path::{Component, Path, PathBuf};
use std::{fs, thread};

use anyhow::Context as _;
use flate2::Compression;
use flate2::write::GzEncoder;

use crate::run::root;
use crate::site::{self, Speed};

/// The pages carry their policy themselves. A sandboxed frame has no origin and must be able to load script and wasm.
const HEADERS: &str = "Access-Control-Allow-Origin: *\r\nX-Content-Type-Options: nosniff\r\n\
     Vary: Accept-Encoding\r\nConnection: close\r\n";

/// A file with a hash of its content in its name never changes, so a browser loads it once and revalidates all others.
const IMMUTABLE: &str = "public, max-age=31536000, immutable";
const REVALIDATE: &str = "no-cache";
/// Number of digits of a hash in a name, as in the build.
const HASH_DIGITS: usize = 12;

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
    // The whole head has to be read: closing with unread input resets the connection.
    let head = lines
        .map_while(Result::ok)
        .take_while(|line| !line.is_empty());
    let head: Vec<String> = head.collect();
    let accepts_gzip = head.iter().any(|line| accepts_gzip(line));
    let mut words = request.split(' ');
    let (method, target) = (words.next(), words.next().unwrap_or_default());
    let file = match method {
        Some("GET" | "HEAD") => file_of(target, folder),
        _ => None,
    };
    let read = file.and_then(|path| {
        let cache = if has_hash(&path) {
            IMMUTABLE
        } else {
            REVALIDATE
        };
        Some((fs::read(&path).ok()?, content_type(&path), cache))
    });
    let (status, (mut body, kind, cache)) = match read {
        Some(found) => ("200 OK", found),
        None => (
            "404 Not Found",
            (b"Not found\n".to_vec(), "text/plain", REVALIDATE),
        ),
    };
    // Fonts are already compressed.
    let encoding = if accepts_gzip && kind != "font/woff2" {
        body = gzip(&body)?;
        "Content-Encoding: gzip\r\n"
    } else {
        ""
    };
    let length = body.len();
    write!(
        stream,
        "HTTP/1.1 {status}\r\nContent-Type: {kind}\r\nContent-Length: {length}\r\n\
         {encoding}Cache-Control: {cache}\r\n{HEADERS}\r\n"
    )?;
    if method == Some("GET") {
        stream.write_all(&body)?;
    }
    stream.flush()
}

/// Whether a header line accepts gzip.
fn accepts_gzip(line: &str) -> bool {
    line.split_once(':').is_some_and(|(name, value)| {
        name.eq_ignore_ascii_case("accept-encoding") && value.contains("gzip")
    })
}

fn gzip(bytes: &[u8]) -> io::Result<Vec<u8>> {
    let mut packed = GzEncoder::new(Vec::new(), Compression::default());
    packed.write_all(bytes)?;
    packed.finish()
}

/// Whether a name ends in a hash of the content: `page-0123456789ab.js`.
fn has_hash(path: &Path) -> bool {
    let stem = path.file_stem().and_then(|stem| stem.to_str());
    let end = stem.and_then(|stem| stem.rsplit_once('-'));
    end.is_some_and(|(_, hash)| {
        hash.len() == HASH_DIGITS && hash.bytes().all(|digit| digit.is_ascii_hexdigit())
    })
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
    use std::io::Read as _;

    use flate2::read::GzDecoder;

    use super::*;

    /// Returns the server's response to one request over a real connection.
    fn ask(request: &str) -> String {
        String::from_utf8(ask_bytes(request)).unwrap()
    }

    fn ask_bytes(request: &str) -> Vec<u8> {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).unwrap();
        let mut stream = TcpStream::connect(listener.local_addr().unwrap()).unwrap();
        stream.write_all(request.as_bytes()).unwrap();
        answer(listener.accept().unwrap().0, folder).unwrap();
        let mut answer = Vec::new();
        stream.read_to_end(&mut answer).unwrap();
        answer
    }

    #[test]
    fn a_file_comes_with_its_type_and_may_be_loaded_by_a_frame_without_an_origin() {
        let answer = ask("GET /Cargo.toml?x=1 HTTP/1.1\r\nHost: a\r\n\r\n");
        assert!(answer.starts_with("HTTP/1.1 200 OK\r\n"), "{answer}");
        assert!(
            answer.contains("Access-Control-Allow-Origin: *\r\n"),
            "{answer}"
        );
        assert!(answer.ends_with(include_str!("../Cargo.toml")), "{answer}");
        assert_eq!(content_type(Path::new("a.wasm")), "application/wasm");
        assert!(content_type(Path::new("a.js")).starts_with("text/javascript"));
    }

    #[test]
    fn gzip_is_sent_if_accepted_and_a_name_with_a_hash_is_immutable() {
        let answer = ask_bytes("GET /Cargo.toml HTTP/1.1\r\nAccept-Encoding: br, gzip\r\n\r\n");
        let end = answer
            .windows(4)
            .position(|four| four == b"\r\n\r\n")
            .unwrap();
        let head = String::from_utf8_lossy(&answer[..end]);
        assert!(head.contains("Content-Encoding: gzip"), "{head}");
        assert!(head.contains("Cache-Control: no-cache"), "{head}");
        let unpacked = io::read_to_string(GzDecoder::new(&answer[end + 4..])).unwrap();
        assert_eq!(unpacked, include_str!("../Cargo.toml"));
        for (name, kept) in [
            ("page-0123456789ab.js", true),
            ("slam_web-0123456789ab.wasm", true),
            ("slam-widget.js", false),
            ("own-robot-another-day.log", false),
        ] {
            assert_eq!(has_hash(Path::new(name)), kept, "{name}");
        }
    }

    #[test]
    fn head_gives_the_length_and_no_body() {
        let answer = ask("HEAD /Cargo.toml HTTP/1.1\r\n\r\n");
        let length = include_str!("../Cargo.toml").len();
        assert!(answer.contains(&format!("Content-Length: {length}\r\n")));
        assert!(answer.ends_with("\r\n\r\n"), "{answer}");
    }

    #[test]
    fn requests_outside_of_the_folder_and_malformed_ones_are_rejected() {
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
