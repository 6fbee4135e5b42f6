//! Messages of JSON-RPC 2.0, one a line.

use serde_json::{Map, Value, json};

/// The message in a line.
#[derive(Debug, PartialEq)]
pub enum Message {
    /// Something that is answered.
    Request {
        /// A text or a whole number.
        id: Value,
        /// The method called.
        method: String,
        /// Its parameters.
        params: Map<String, Value>,
    },
    /// Something that is not.
    Notification {
        /// The event.
        method: String,
        /// Its parameters.
        params: Map<String, Value>,
    },
    /// An answer to a question that this program never asks.
    Response,
}

/// An error as the protocol has it.
#[derive(Debug, Clone, PartialEq)]
pub struct Refusal {
    /// Its number.
    pub code: i64,
    /// The finding and its remedy.
    pub message: String,
}

impl Refusal {
    /// No JSON.
    pub const UNPARSED: i64 = -32700;
    /// JSON, and no message.
    pub const NO_REQUEST: i64 = -32600;
    /// There is no such method.
    pub const NO_METHOD: i64 = -32601;
    /// A method that does not have these parameters.
    pub const BAD_PARAMS: i64 = -32602;
    /// There is no such resource.
    pub const NO_RESOURCE: i64 = -32002;
    /// More is asked for than can wait.
    pub const BUSY: i64 = -32000;

    /// An error of that number.
    pub fn new(code: i64, message: impl Into<String>) -> Self {
        Refusal { code, message: message.into() }
    }
}

/// Reads a line.
///
/// # Errors
/// The identifier to answer to, `null` where there is none, and what is wrong.
pub fn parse(line: &[u8]) -> Result<Message, (Value, Refusal)> {
    let refused = |id: &Value, code, message: &str| (id.clone(), Refusal::new(code, message));
    let value: Value = serde_json::from_slice(line)
        .map_err(|error| (Value::Null, Refusal::new(Refusal::UNPARSED, format!("this is no JSON: {error}"))))?;
    let Value::Object(mut object) = value else {
        let what = "a message is one JSON object; batches are no part of this protocol";
        return Err(refused(&Value::Null, Refusal::NO_REQUEST, what));
    };
    let id = object.remove("id");
    let is_id = |id: &Value| id.is_string() || id.is_i64() || id.is_u64();
    let known = id.clone().filter(is_id).unwrap_or(Value::Null);
    if object.get("jsonrpc").and_then(Value::as_str) != Some("2.0") {
        return Err(refused(&known, Refusal::NO_REQUEST, "a message has \"jsonrpc\": \"2.0\""));
    }
    if id.as_ref().is_some_and(|id| !is_id(id)) {
        return Err(refused(&Value::Null, Refusal::NO_REQUEST, "an id is a text or a whole number"));
    }
    let method = match object.remove("method") {
        Some(Value::String(method)) => method,
        None if object.contains_key("result") || object.contains_key("error") => return Ok(Message::Response),
        _ => return Err(refused(&known, Refusal::NO_REQUEST, "a message has a method, which is text")),
    };
    let params = match object.remove("params") {
        None => Map::new(),
        Some(Value::Object(params)) => params,
        Some(_) => return Err(refused(&known, Refusal::BAD_PARAMS, "params are an object")),
    };
    Ok(match id {
        Some(id) => Message::Request { id, method, params },
        None => Message::Notification { method, params },
    })
}

/// The answer to the request `id`.
pub fn reply(id: &Value, result: Result<Value, Refusal>) -> Value {
    match result {
        Ok(result) => json!({"jsonrpc": "2.0", "id": id, "result": result}),
        Err(Refusal { code, message }) => {
            json!({"jsonrpc": "2.0", "id": id, "error": {"code": code, "message": message}})
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn requests_notifications_and_answers_are_told_apart() {
        let request = parse(br#"{"jsonrpc": "2.0", "id": "a", "method": "ping"}"#).expect("a request");
        assert_eq!(request, Message::Request { id: json!("a"), method: "ping".into(), params: Map::new() });
        let told = parse(br#"{"jsonrpc": "2.0", "method": "m", "params": {"x": 1}}"#).expect("a notification");
        assert!(matches!(told, Message::Notification { params, .. } if params["x"] == 1));
        assert_eq!(parse(br#"{"jsonrpc": "2.0", "id": 1, "result": {}}"#), Ok(Message::Response));
    }

    #[test]
    fn what_is_no_message_is_refused_with_the_number_of_its_fault() {
        let deep = format!("{}1{}", "[".repeat(5000), "]".repeat(5000));
        for (line, code, id) in [
            ("", -32700, json!(null)),
            ("{", -32700, json!(null)),
            ("\u{0}\u{1}", -32700, json!(null)),
            (deep.as_str(), -32700, json!(null)),
            ("1e999", -32700, json!(null)),
            ("[]", -32600, json!(null)),
            ("7", -32600, json!(null)),
            (r#"{"id": 1, "method": "ping"}"#, -32600, json!(1)),
            (r#"{"jsonrpc": "1.0", "id": 1, "method": "ping"}"#, -32600, json!(1)),
            (r#"{"jsonrpc": "2.0", "id": null, "method": "ping"}"#, -32600, json!(null)),
            (r#"{"jsonrpc": "2.0", "id": 1.5, "method": "ping"}"#, -32600, json!(null)),
            (r#"{"jsonrpc": "2.0", "id": {}, "method": "ping"}"#, -32600, json!(null)),
            (r#"{"jsonrpc": "2.0", "id": 1}"#, -32600, json!(1)),
            (r#"{"jsonrpc": "2.0", "id": 1, "method": 3}"#, -32600, json!(1)),
            (r#"{"jsonrpc": "2.0", "id": 1, "method": "ping", "params": [1]}"#, -32602, json!(1)),
        ] {
            let (of, refusal) = parse(line.as_bytes()).expect_err(line);
            assert_eq!((refusal.code, of), (code, id), "{line}");
        }
    }
}
