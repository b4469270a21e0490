//! A server of Foxglove's WebSocket protocol, which shows the latest message of each topic.
//!
//! A topic is a slot: a new message replaces the one before, and a client gets what is new to it as fast as it takes it. So
//! a client that subscribes late gets the latest message, one that stalls delays nobody, and no message waits in a queue.
//! Each client has a thread. Not the crate `foxglove`: with it, `cargo tree` of the command grows by a runtime (tokio) and
//! what that needs, for three topics.

use std::collections::BTreeMap;
use std::io;
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::Duration;

use crate::is_wait;
use robot_io::live::protocol::SUBPROTOCOLS;
use serde::Deserialize;
use serde_json::json;
use tungstenite::handshake::server::{ErrorResponse, Request, Response};
use tungstenite::http::{HeaderValue, StatusCode};
use tungstenite::protocol::WebSocketConfig;
use tungstenite::{
    Bytes, Error as SocketError, Message as Frame, WebSocket, accept_hdr_with_config,
};

/// Name of the header with the subprotocols.
const SUBPROTOCOL: &str = "Sec-WebSocket-Protocol";
/// Time between two looks for what is new.
const POLL: Duration = Duration::from_millis(50);
/// A client that takes nothing for this long is dropped.
const STALLED: Duration = Duration::from_secs(10);
/// Most clients at a time.
const MAX_CLIENTS: usize = 16;
/// Longest text of a client, bytes.
const MAX_TEXT: usize = 1 << 16;

/// A topic of a message of ROS 2.
#[derive(Clone, Debug)]
pub struct Channel {
    /// Name.
    pub topic: &'static str,
    /// Type.
    pub schema_name: &'static str,
    /// Definition of the type and of those that it contains, as `ros2msg`.
    pub schema: String,
}

/// A message.
struct Message {
    /// Number of the message, counted from 1 over all topics.
    number: u64,
    time_ns: u64,
    bytes: Vec<u8>,
}

/// What the threads share.
struct Shared {
    name: String,
    channels: Vec<Channel>,
    state: Mutex<State>,
    /// A client has gone.
    gone: Condvar,
}

#[derive(Default)]
struct State {
    count: u64,
    /// The latest message of each topic.
    latest: Vec<Option<Arc<Message>>>,
    /// Number of subscriptions of each topic.
    subscriptions: Vec<usize>,
    clients: usize,
    is_over: bool,
}

/// A running server.
pub struct Server {
    shared: Arc<Shared>,
    /// Where it listens.
    pub address: SocketAddr,
}

impl Server {
    /// Starts to listen.
    ///
    /// # Errors
    /// If the address is taken or not this computer's.
    pub fn start(name: &str, address: SocketAddr, channels: Vec<Channel>) -> io::Result<Self> {
        let listener = TcpListener::bind(address)?;
        let address = listener.local_addr()?;
        let count = channels.len();
        let shared = Arc::new(Shared {
            name: name.to_owned(),
            channels,
            state: Mutex::new(State {
                latest: (0..count).map(|_| None).collect(),
                subscriptions: vec![0; count],
                ..State::default()
            }),
            gone: Condvar::new(),
        });
        let of_clients = Arc::clone(&shared);
        thread::spawn(move || {
            for stream in listener.incoming().flatten() {
                let Some(client) = Client::new(&of_clients) else {
                    continue;
                };
                thread::spawn(move || {
                    // Who hangs up, stalls or speaks otherwise is gone.
                    let _ = client.serve(stream);
                });
            }
        });
        Ok(Self { shared, address })
    }

    /// Whether anybody subscribes to a topic.
    #[must_use]
    pub fn is_wanted(&self, channel: usize) -> bool {
        self.shared.state().subscriptions[channel] > 0
    }

    /// Replaces the message of a topic.
    pub fn publish(&self, channel: usize, time_ns: u64, bytes: Vec<u8>) {
        let mut state = self.shared.state();
        state.count += 1;
        let number = state.count;
        state.latest[channel] = Some(Arc::new(Message {
            number,
            time_ns,
            bytes,
        }));
    }

    /// Ends once all clients have the latest messages, at most after this time.
    pub fn end(&self, wait: Duration) {
        let mut state = self.shared.state();
        state.is_over = true;
        let gone = &self.shared.gone;
        // Whether all have gone or the time is over is the same here.
        drop(gone.wait_timeout_while(state, wait, |state| state.clients > 0));
    }
}

impl Shared {
    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// A text of a client.
#[derive(Deserialize)]
#[serde(tag = "op", rename_all = "camelCase")]
enum ClientText {
    Subscribe {
        subscriptions: Vec<Subscription>,
    },
    #[serde(rename_all = "camelCase")]
    Unsubscribe {
        subscription_ids: Vec<u32>,
    },
    #[serde(other)]
    Other,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Subscription {
    id: u32,
    channel_id: usize,
}

/// A client, counted as long as it is there.
struct Client {
    shared: Arc<Shared>,
    /// Topic of each subscription, and the number of the last message that was sent.
    subscriptions: BTreeMap<u32, (usize, u64)>,
}

impl Client {
    /// Counts a client; `None` if there are enough.
    fn new(shared: &Arc<Shared>) -> Option<Self> {
        let mut state = shared.state();
        if state.clients == MAX_CLIENTS {
            return None;
        }
        state.clients += 1;
        Some(Self {
            shared: Arc::clone(shared),
            subscriptions: BTreeMap::new(),
        })
    }

    /// Serves the client until it goes.
    fn serve(mut self, stream: TcpStream) -> Result<(), SocketError> {
        stream.set_read_timeout(Some(STALLED))?;
        stream.set_write_timeout(Some(STALLED))?;
        let config = WebSocketConfig::default()
            .max_message_size(Some(MAX_TEXT))
            .max_frame_size(Some(MAX_TEXT));
        let accepted = accept_hdr_with_config(stream, choose, Some(config));
        let mut socket = accepted.map_err(|_| SocketError::ConnectionClosed)?;
        socket.get_ref().set_read_timeout(Some(POLL))?;
        let info = json!({ "op": "serverInfo", "name": self.shared.name, "capabilities": [] });
        socket.send(Frame::text(info.to_string()))?;
        let channels = self.shared.channels.iter().enumerate();
        let channels: Vec<_> = channels.map(|(id, channel)| json!({
            "id": id, "topic": channel.topic, "encoding": "cdr", "schemaName": channel.schema_name,
            "schemaEncoding": "ros2msg", "schema": channel.schema,
        })).collect();
        let advertise = json!({ "op": "advertise", "channels": channels });
        socket.send(Frame::text(advertise.to_string()))?;
        loop {
            match socket.read() {
                Ok(Frame::Text(text)) => self.take(&text),
                Ok(_) => {}
                Err(SocketError::Io(error)) if is_wait(&error) => {}
                Err(error) => return Err(error),
            }
            // What is published after this is not waited for.
            let is_over = self.shared.state().is_over;
            self.send_new(&mut socket)?;
            if is_over {
                socket.close(None)?;
                return socket.flush();
            }
        }
    }

    /// Takes a text; those of no use here are passed over.
    fn take(&mut self, text: &str) {
        let mut state = self.shared.state();
        match serde_json::from_str(text) {
            Ok(ClientText::Subscribe { subscriptions }) => {
                for Subscription { id, channel_id } in subscriptions {
                    if channel_id < self.shared.channels.len()
                        && !self.subscriptions.contains_key(&id)
                    {
                        self.subscriptions.insert(id, (channel_id, 0));
                        state.subscriptions[channel_id] += 1;
                    }
                }
            }
            Ok(ClientText::Unsubscribe { subscription_ids }) => {
                for id in subscription_ids {
                    if let Some((channel, _)) = self.subscriptions.remove(&id) {
                        state.subscriptions[channel] -= 1;
                    }
                }
            }
            Ok(ClientText::Other) | Err(_) => {}
        }
    }

    /// Sends the latest messages that the client does not have.
    fn send_new(&mut self, socket: &mut WebSocket<TcpStream>) -> Result<(), SocketError> {
        for (id, (channel, sent)) in &mut self.subscriptions {
            let latest = self.shared.state().latest[*channel].clone();
            let Some(latest) = latest.filter(|latest| latest.number > *sent) else {
                continue;
            };
            let mut binary = Vec::with_capacity(13 + latest.bytes.len());
            binary.push(1);
            binary.extend_from_slice(&id.to_le_bytes());
            binary.extend_from_slice(&latest.time_ns.to_le_bytes());
            binary.extend_from_slice(&latest.bytes);
            socket.send(Frame::Binary(Bytes::from(binary)))?;
            *sent = latest.number;
        }
        Ok(())
    }
}

impl Drop for Client {
    fn drop(&mut self) {
        let mut state = self.shared.state();
        for (channel, _) in self.subscriptions.values() {
            state.subscriptions[*channel] -= 1;
        }
        state.clients -= 1;
        self.shared.gone.notify_all();
    }
}

/// Chooses a subprotocol that the client offers.
// The type that the library asks for.
#[expect(clippy::result_large_err)]
pub(crate) fn choose(request: &Request, mut answer: Response) -> Result<Response, ErrorResponse> {
    let offered = request.headers().get_all(SUBPROTOCOL).iter();
    let offered: Vec<&str> = offered
        .filter_map(|names| names.to_str().ok())
        .flat_map(|names| names.split(',').map(str::trim))
        .collect();
    let Some(chosen) = SUBPROTOCOLS.into_iter().find(|name| offered.contains(name)) else {
        let said = format!("offer the subprotocol {}", SUBPROTOCOLS.join(" or "));
        let mut rejected = ErrorResponse::new(Some(said));
        *rejected.status_mut() = StatusCode::BAD_REQUEST;
        return Err(rejected);
    };
    let chosen = HeaderValue::from_static(chosen);
    answer.headers_mut().insert(SUBPROTOCOL, chosen);
    Ok(answer)
}
