//! Messages of Foxglove's WebSocket protocol, as far as a reader of topics needs them.
//!
//! Text is JSON with the field `op`; a binary message of kind 1 is a message of a subscription: its number (`u32`), the
//! time (`u64`, ns) and the bytes, little-endian. Source: foxglove/ws-protocol, docs/spec.md; `foxglove.sdk.v1` has the
//! same messages.

use data_encoding::BASE64;
use serde::Deserialize;
use serde_json::json;

use crate::ros::Topic;

/// Names of the protocol, the present one first.
pub const SUBPROTOCOLS: [&str; 2] = ["foxglove.sdk.v1", "foxglove.websocket.v1"];
/// Kind of a binary message with the message of a topic.
const MESSAGE_DATA: u8 = 1;
/// Longer definitions of a type are left out: they are kept for each topic, and not needed here.
const MAX_DEFINITION: usize = 1 << 16;

/// A text of the server.
#[derive(Debug, Deserialize)]
#[serde(tag = "op", rename_all = "camelCase")]
pub enum ServerText {
    /// The topics that there are from now on, too.
    Advertise {
        /// Topics.
        channels: Vec<Channel>,
    },
    /// Topics that there are no longer.
    #[serde(rename_all = "camelCase")]
    Unadvertise {
        /// Their ids.
        channel_ids: Vec<u64>,
    },
    /// What the server is, parameters, services and so on.
    #[serde(other)]
    Other,
}

/// A topic of the server.
#[derive(Clone, Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Channel {
    /// Id.
    pub id: u64,
    topic: String,
    encoding: String,
    schema_name: String,
    #[serde(default)]
    schema_encoding: Option<String>,
    #[serde(default)]
    schema: Option<String>,
}

impl Channel {
    /// The topic as it is recorded.
    #[must_use]
    pub fn topic(&self) -> Topic {
        let schema = self.schema.as_deref().unwrap_or_default();
        let stated = self.schema_encoding.as_deref();
        let schema_encoding = stated.unwrap_or(match self.encoding.as_str() {
            "cdr" => "ros2msg",
            "ros1" => "ros1msg",
            "json" => "jsonschema",
            other => other,
        });
        // Definitions that are not text come in Base64.
        let is_text = !matches!(schema_encoding, "protobuf" | "flatbuffer");
        let schema = if schema.len() > MAX_DEFINITION {
            ""
        } else {
            schema
        };
        let definition = match BASE64.decode(schema.as_bytes()) {
            Ok(bytes) if !is_text => bytes,
            _ => schema.as_bytes().to_vec(),
        };
        Topic {
            name: self.topic.clone(),
            encoding: self.encoding.clone(),
            schema: self.schema_name.clone(),
            schema_encoding: schema_encoding.to_owned(),
            definition,
        }
    }
}

/// The request for the messages of a topic.
#[must_use]
pub fn subscribe(subscription: u32, channel: u64) -> String {
    let one = json!({ "id": subscription, "channelId": channel });
    json!({ "op": "subscribe", "subscriptions": [one] }).to_string()
}

/// Subscription, time (ns) and bytes of a message; `None` if the binary message is another one.
#[must_use]
pub fn message_data(binary: &[u8]) -> Option<(u32, u64, &[u8])> {
    let (&kind, rest) = binary.split_first()?;
    let (subscription, rest) = rest.split_first_chunk()?;
    let (time, bytes) = rest.split_first_chunk()?;
    (kind == MESSAGE_DATA).then_some((
        u32::from_le_bytes(*subscription),
        u64::from_le_bytes(*time),
        bytes,
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_of_the_server_are_read_and_unknown_ones_are_passed_over() {
        let text = r#"{"op":"advertise","channels":[{"id":7,"topic":"/scan","encoding":"protobuf","schemaName":"foxglove.LaserScan","schema":"AQI="}]}"#;
        let ServerText::Advertise { channels } = serde_json::from_str(text).unwrap() else {
            panic!("it advertises");
        };
        let topic = channels[0].topic();
        assert_eq!((channels[0].id, &topic.name[..]), (7, "/scan"));
        assert_eq!(
            (&topic.schema_encoding[..], topic.definition),
            ("protobuf", vec![1, 2])
        );
        for text in [
            r#"{"op":"serverInfo","name":"x","capabilities":[]}"#,
            r#"{"op":"later"}"#,
        ] {
            assert!(matches!(serde_json::from_str(text), Ok(ServerText::Other)));
        }
    }

    #[test]
    fn message_data_has_subscription_time_and_bytes() {
        let binary = [1, 5, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 9];
        assert_eq!(message_data(&binary), Some((5, 2, &[9][..])));
        assert_eq!(message_data(&binary[..12]), None);
        assert_eq!(message_data(&[2; 20]), None);
    }
}
