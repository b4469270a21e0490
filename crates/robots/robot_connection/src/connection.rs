//! A connection to a server of Foxglove's WebSocket protocol, such as foxglove_bridge.

use std::io::{self, ErrorKind};
use std::net::{TcpStream, ToSocketAddrs as _};
use std::time::{Duration, Instant};

use crate::is_wait;
use robot_io::live::MAX_MESSAGE;
use robot_io::live::network::{ConnectError, Lost, NO_ANSWER, OTHER_SUBPROTOCOL};
use robot_io::live::protocol::SUBPROTOCOLS;
use tungstenite::client::client_with_config;
use tungstenite::http::Uri;
use tungstenite::protocol::WebSocketConfig;
use tungstenite::{
    Bytes, ClientRequestBuilder, Error as SocketError, HandshakeError, Message, WebSocket,
};

/// A read waits this long, so that Ctrl-C is seen.
const POLL: Duration = Duration::from_millis(100);

/// How long a robot may be silent.
#[derive(Clone, Copy, Debug)]
struct Patience {
    /// If it does not answer within this, it is not there.
    answer: Duration,
    /// After this time without a message it is asked whether it is there.
    quiet: Duration,
    /// After this time without a message it is gone.
    gone: Duration,
}

const PATIENCE: Patience = Patience {
    answer: Duration::from_secs(5),
    quiet: Duration::from_secs(3),
    gone: Duration::from_secs(10),
};

/// The address of a server.
#[derive(Clone, Debug)]
pub struct Address {
    /// As the user wrote it.
    pub url: String,
    uri: Uri,
    host: String,
    port: u16,
}

impl Address {
    /// Parses `ws://host:port`; without a port it is 80, as for every address of this form.
    ///
    /// # Errors
    /// If it is none, or asks for TLS.
    pub fn new(url: &str) -> Result<Self, ConnectError> {
        let wrong = || ConnectError::Address(url.to_owned());
        let uri: Uri = url.parse().map_err(|_| wrong())?;
        match uri.scheme_str() {
            Some("ws") => {}
            Some("wss") => return Err(ConnectError::Encrypted(url.to_owned())),
            _ => return Err(wrong()),
        }
        let host = uri.host().filter(|host| !host.is_empty());
        let host = host.ok_or_else(wrong)?;
        // IPv6 addresses are in brackets.
        let host = host.trim_matches(['[', ']']).to_owned();
        let port = uri.port_u16().unwrap_or(80);
        let url = url.to_owned();
        Ok(Self {
            url,
            uri,
            host,
            port,
        })
    }
}

/// An open connection.
pub struct Connection {
    socket: WebSocket<TcpStream>,
    /// When the last message came.
    pub(crate) heard: Instant,
    is_asked: bool,
    patience: Patience,
}

impl Connection {
    /// Connects to a server.
    ///
    /// # Errors
    /// If it is not there, or speaks another protocol.
    pub fn open(address: &Address) -> Result<Self, ConnectError> {
        Self::open_within(address, PATIENCE)
    }

    fn open_within(address: &Address, patience: Patience) -> Result<Self, ConnectError> {
        let url = || address.url.clone();
        let refused = |source: io::Error| ConnectError::Refused {
            url: url(),
            why: source.to_string(),
        };
        let all = (&address.host[..], address.port).to_socket_addrs();
        let all = all.map_err(|source| ConnectError::Name {
            url: url(),
            host: address.host.clone(),
            why: source.to_string(),
        })?;
        let mut failed = io::Error::from(ErrorKind::AddrNotAvailable);
        let mut stream = None;
        for one in all {
            match TcpStream::connect_timeout(&one, patience.answer) {
                Ok(open) => {
                    stream = Some(open);
                    break;
                }
                Err(error) => failed = error,
            }
        }
        let Some(stream) = stream else {
            return Err(refused(failed));
        };
        let answer = Some(patience.answer);
        stream.set_read_timeout(answer).map_err(refused)?;
        stream.set_write_timeout(answer).map_err(refused)?;
        let mut request = ClientRequestBuilder::new(address.uri.clone());
        for name in SUBPROTOCOLS {
            request = request.with_sub_protocol(name);
        }
        let config = WebSocketConfig::default()
            .max_message_size(Some(MAX_MESSAGE))
            .max_frame_size(Some(MAX_MESSAGE));
        let other = |found: String| ConnectError::Other { url: url(), found };
        let (socket, _) =
            client_with_config(request, stream, Some(config)).map_err(|error| match error {
                HandshakeError::Interrupted(_) => other(NO_ANSWER.to_owned()),
                HandshakeError::Failure(SocketError::Http(answer)) => {
                    other(format!("it answers HTTP {}", answer.status()))
                }
                HandshakeError::Failure(SocketError::Protocol(
                    tungstenite::error::ProtocolError::SecWebSocketSubProtocolError(_),
                )) => other(OTHER_SUBPROTOCOL.to_owned()),
                HandshakeError::Failure(error) => other(error.to_string()),
            })?;
        let stream = socket.get_ref();
        stream.set_read_timeout(Some(POLL)).map_err(refused)?;
        Ok(Self {
            socket,
            heard: Instant::now(),
            is_asked: false,
            patience,
        })
    }

    /// Sends a text.
    ///
    /// # Errors
    /// If the connection is lost.
    pub(crate) fn send(&mut self, text: String) -> Result<(), Lost> {
        self.socket.send(Message::text(text)).map_err(lost)
    }

    /// The next message, or `None` if none has come for a while.
    ///
    /// # Errors
    /// If the connection is lost.
    pub(crate) fn next(&mut self) -> Result<Option<Message>, Lost> {
        match self.socket.read() {
            Ok(message) => {
                (self.heard, self.is_asked) = (Instant::now(), false);
                match message {
                    Message::Close(_) => Err(Lost::Closed),
                    message => Ok(Some(message)),
                }
            }
            Err(SocketError::Io(error)) if is_wait(&error) => {
                let quiet = self.heard.elapsed();
                if quiet > self.patience.gone {
                    return Err(Lost::Silent);
                }
                if quiet > self.patience.quiet && !self.is_asked {
                    self.is_asked = true;
                    self.socket
                        .send(Message::Ping(Bytes::new()))
                        .map_err(lost)?;
                }
                Ok(None)
            }
            Err(error) => Err(lost(error)),
        }
    }
}

fn lost(error: SocketError) -> Lost {
    match error {
        SocketError::Capacity(tungstenite::error::CapacityError::MessageTooLong {
            size, ..
        }) => Lost::TooLong(size),
        SocketError::ConnectionClosed | SocketError::AlreadyClosed => Lost::Closed,
        error => Lost::Broken(error.to_string()),
    }
}

#[cfg(test)]
mod tests {
    use std::io::Read as _;
    use std::net::TcpListener;
    use std::thread;

    use tungstenite::accept_hdr;

    use super::*;
    use crate::server::choose;

    /// Longer than any test.
    const AN_HOUR: Duration = Duration::from_secs(3600);

    fn server() -> (TcpListener, Address) {
        let server = TcpListener::bind("127.0.0.1:0").unwrap();
        let address = Address::new(&format!("ws://{}", server.local_addr().unwrap()));
        (server, address.unwrap())
    }

    #[test]
    fn a_server_that_takes_the_connection_and_does_not_answer_is_named() {
        // The system takes the connection.
        let (_server, address) = server();
        let patience = Patience {
            answer: Duration::from_millis(50),
            ..PATIENCE
        };
        let problem = Connection::open_within(&address, patience).err().unwrap();
        assert!(problem.to_string().contains(NO_ANSWER), "{problem}");
    }

    #[test]
    fn a_server_that_falls_silent_is_lost_and_one_that_answers_when_asked_is_not() {
        for (answers, gone) in [(true, AN_HOUR), (false, Duration::ZERO)] {
            let (server, address) = server();
            let serving = thread::spawn(move || {
                let (stream, _) = server.accept().unwrap();
                let mut socket = accept_hdr(stream, choose).unwrap();
                if answers {
                    while socket.read().is_ok() {}
                }
                // It neither reads a message nor closes the connection.
                let _ = socket.get_mut().read_to_end(&mut Vec::new());
            });
            let patience = Patience {
                quiet: Duration::ZERO,
                gone,
                ..PATIENCE
            };
            let mut connection = Connection::open_within(&address, patience).unwrap();
            let came = loop {
                match connection.next() {
                    Ok(None) => {}
                    Ok(Some(message)) => break Ok(message),
                    Err(lost) => break Err(lost),
                }
            };
            match answers {
                true => assert!(matches!(came, Ok(Message::Pong(_))), "{came:?}"),
                false => assert!(matches!(came, Err(Lost::Silent)), "{came:?}"),
            }
            drop(connection);
            serving.join().unwrap();
        }
    }
}
