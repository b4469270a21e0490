//! A robot's server of Foxglove's WebSocket protocol, which plays recorded messages.

use std::collections::BTreeMap;
use std::net::{TcpListener, TcpStream};

use serde_json::{Value, json};
use tungstenite::handshake::server::{ErrorResponse, Request, Response};
use tungstenite::http::HeaderValue;
use tungstenite::{Bytes, Message as Frame, WebSocket, accept_hdr};

use super::write::Message;

/// A topic with its type.
pub type Topic = (String, &'static str);

/// The topics of messages.
pub fn topics(all: &[Message]) -> Vec<Topic> {
    let mut topics: Vec<Topic> = Vec::new();
    for message in all {
        let topic = (message.topic.clone(), message.kind());
        if !topics.contains(&topic) {
            topics.push(topic);
        }
    }
    topics
}

/// A connection of the robot to its client.
pub struct Robot {
    pub socket: WebSocket<TcpStream>,
    /// Subscription of each channel.
    subscriptions: BTreeMap<u64, u32>,
    /// Channel of each topic.
    channels: BTreeMap<String, u64>,
}

impl Robot {
    /// Waits for a client; chooses the subprotocol that it offers first.
    pub fn accept(server: &TcpListener) -> Self {
        let (stream, _) = server.accept().unwrap();
        // The type that the library asks for.
        #[expect(clippy::result_large_err)]
        let choose = |request: &Request, mut answer: Response| -> Result<Response, ErrorResponse> {
            let offered = request.headers()["Sec-WebSocket-Protocol"]
                .to_str()
                .unwrap();
            assert_eq!(offered, "foxglove.sdk.v1, foxglove.websocket.v1");
            let chosen = HeaderValue::from_static("foxglove.sdk.v1");
            answer
                .headers_mut()
                .insert("Sec-WebSocket-Protocol", chosen);
            Ok(answer)
        };
        let mut socket = accept_hdr(stream, choose).unwrap();
        let info = json!({"op": "serverInfo", "name": "robot", "capabilities": []});
        socket.send(Frame::text(info.to_string())).unwrap();
        Self {
            socket,
            subscriptions: BTreeMap::new(),
            channels: BTreeMap::new(),
        }
    }

    /// Advertises topics, the channel of the first being `first`.
    pub fn advertise(&mut self, topics: &[Topic], first: u64) {
        let channels = topics.iter().zip(first..).map(|((topic, kind), id)| {
            self.channels.insert(topic.clone(), id);
            json!({"id": id, "topic": topic, "encoding": "cdr", "schemaName": kind, "schema": ""})
        });
        let channels: Vec<Value> = channels.collect();
        let text = json!({"op": "advertise", "channels": channels}).to_string();
        self.socket.send(Frame::text(text)).unwrap();
    }

    /// Waits until so many topics are subscribed to, and returns them.
    pub fn subscribed(&mut self, count: usize) -> Vec<String> {
        while self.subscriptions.len() < count {
            let text = self.socket.read().unwrap();
            let text: Value = serde_json::from_str(text.to_text().unwrap()).unwrap();
            assert_eq!(text["op"], "subscribe");
            for one in text["subscriptions"].as_array().unwrap() {
                let id = u32::try_from(one["id"].as_u64().unwrap()).unwrap();
                self.subscriptions
                    .insert(one["channelId"].as_u64().unwrap(), id);
            }
        }
        let is_read = |id: &u64| self.subscriptions.contains_key(id);
        let topics = self.channels.iter().filter(|(_, id)| is_read(id));
        topics.map(|(topic, _)| topic.clone()).collect()
    }

    /// Sends the messages of topics that are subscribed to.
    pub fn play(&mut self, all: &[Message]) {
        for message in all {
            let channel = self.channels[&message.topic];
            if let Some(&subscription) = self.subscriptions.get(&channel) {
                let time = (message.recorded_s * 1e9).round() as u64;
                let head = [&[1][..], &subscription.to_le_bytes(), &time.to_le_bytes()].concat();
                let binary = [head, message.bytes()].concat();
                self.socket
                    .send(Frame::Binary(Bytes::from(binary)))
                    .unwrap();
            }
        }
    }

    /// Closes the connection after the client has taken everything.
    pub fn close(mut self) {
        self.socket.close(None).unwrap();
        while self.socket.read().is_ok() {}
    }
}
