//! Decodes rows of a table.

/// A value of a row.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Value {
    /// NULL; also stored for an integer primary key, whose value is the row id.
    #[default]
    Null,
    /// An integer.
    Integer(i64),
    /// A floating-point number.
    Real(f64),
    /// A text; invalid bytes become question marks.
    Text(String),
    /// Bytes.
    Blob(Vec<u8>),
}

impl Value {
    /// The value, if it is an integer.
    pub fn integer(&self) -> Option<i64> {
        match self {
            Self::Integer(value) => Some(*value),
            _ => None,
        }
    }

    /// The value, if it is a text.
    pub fn text(&self) -> Option<&str> {
        match self {
            Self::Text(text) => Some(text),
            _ => None,
        }
    }
}

/// Decodes a varint of one to nine bytes, seven bits each and eight in the ninth; returns it with its length.
pub fn varint(bytes: &[u8]) -> Option<(u64, usize)> {
    let mut value = 0_u64;
    for (at, &byte) in bytes.iter().take(9).enumerate() {
        if at == 8 {
            return Some((value << 8 | u64::from(byte), 9));
        }
        value = value << 7 | u64::from(byte & 0x7f);
        if byte < 0x80 {
            return Some((value, at + 1));
        }
    }
    None
}

/// Decodes the values of a row; `None` if the bytes are malformed.
pub fn values(record: &[u8]) -> Option<Vec<Value>> {
    let (header, mut at) = varint(record)?;
    let header = usize::try_from(header).ok()?;
    let mut body = record.get(header..)?;
    let mut values = Vec::new();
    while at < header {
        let (kind, length) = varint(record.get(at..header)?)?;
        at += length;
        let size = match kind {
            0 | 8 | 9 => 0,
            1..=4 => kind as usize,
            5 => 6,
            6 | 7 => 8,
            10 | 11 => return None,
            _ => usize::try_from((kind - 12) / 2).ok()?,
        };
        let (bytes, rest) = body.split_at_checked(size)?;
        body = rest;
        values.push(match kind {
            0 => Value::Null,
            8 => Value::Integer(0),
            9 => Value::Integer(1),
            7 => Value::Real(f64::from_be_bytes(bytes.try_into().ok()?)),
            1..=6 => {
                let sign = if bytes[0] & 0x80 == 0 { 0 } else { -1 };
                let shifted = bytes
                    .iter()
                    .fold(sign, |value: i64, &byte| value << 8 | i64::from(byte));
                Value::Integer(shifted)
            }
            _ if kind % 2 == 0 => Value::Blob(bytes.to_vec()),
            _ => Value::Text(String::from_utf8_lossy(bytes).into_owned()),
        });
    }
    Some(values)
}

/// Column names of a table, from its CREATE statement.
pub fn columns(sql: &str) -> Vec<String> {
    let (Some(from), Some(to)) = (sql.find('('), sql.rfind(')')) else {
        return Vec::new();
    };
    let inside = sql.get(from + 1..to).unwrap_or_default();
    let names = inside.split(',').map(|column| {
        let name = column.split_whitespace().next().unwrap_or_default();
        name.trim_matches(['"', '`', '[', ']', '\'']).to_owned()
    });
    names.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_as_many_bytes_as_they_need() {
        assert_eq!(varint(&[0x7f]), Some((127, 1)));
        assert_eq!(varint(&[0x81, 0x00]), Some((128, 2)));
        assert_eq!(varint(&[0xff; 9]), Some((u64::MAX, 9)));
        assert_eq!(varint(&[0x81]), None);
    }

    #[test]
    fn a_row_has_the_values_of_its_types() {
        // NULL, −2 in one byte, 1, ‘ab’, two bytes.
        let row = [6, 0, 1, 9, 17, 16, 0xfe, b'a', b'b', 7, 8];
        let expected = [
            Value::Null,
            Value::Integer(-2),
            Value::Integer(1),
            Value::Text("ab".to_owned()),
            Value::Blob(vec![7, 8]),
        ];
        assert_eq!(values(&row).unwrap(), expected);
        assert_eq!(values(&row[..9]), None);
        let sql = "CREATE TABLE messages(id INTEGER PRIMARY KEY,topic_id INTEGER NOT NULL, \"data\" BLOB)";
        assert_eq!(columns(sql), ["id", "topic_id", "data"]);
    }
}
