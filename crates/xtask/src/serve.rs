//! `cargo xtask serve`: build, then a small file server for this machine.

use std::net::{Ipv4Addr, TcpListener};
use std::sync::Arc;
use std::thread;

use crate::http;
use crate::run::{Failure, root};
use crate::site::{self, Speed};

/// Builds the site and serves it until it is stopped.
///
/// # Errors
/// A build step that fails, or a port that is taken.
pub fn serve(port: u16, speed: Speed) -> Result<(), Failure> {
    // A taken port is better known before minutes of building.
    let listener = listen(port)?;
    site::build(speed)?;
    println!("\nServing on http://localhost:{port}/   (stop with Ctrl+C)");
    let dist = Arc::new(root().join("dist"));
    for stream in listener.incoming() {
        // A connection that ended before it began concerns nobody.
        let Ok(stream) = stream else { continue };
        let dist = Arc::clone(&dist);
        thread::spawn(move || http::answer(stream, &dist));
    }
    Ok(())
}

fn listen(port: u16) -> Result<TcpListener, Failure> {
    TcpListener::bind((Ipv4Addr::LOCALHOST, port)).map_err(|error| {
        Failure::new(format!(
            "port {port} cannot be used ({error}): try `cargo xtask serve --port {}`",
            port.wrapping_add(1).max(1024)
        ))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_port_in_use_is_named_with_another_to_try() {
        let taken = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).unwrap();
        let port = taken.local_addr().unwrap().port();
        let message = listen(port).unwrap_err().to_string();
        assert!(
            message.starts_with(&format!("port {port} cannot be used")),
            "{message}"
        );
        assert!(
            message.contains("try `cargo xtask serve --port"),
            "{message}"
        );
        assert_eq!(message.lines().count(), 1);
    }
}
