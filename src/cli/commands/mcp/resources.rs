//! Resources that an agent may read to write a scene: the schema of its keys, and a commented example.

use serde_json::{Value, json};

use super::message::Refusal;
use crate::scene;

const SCHEMA: &str = "hypercircle://scene.schema.json";
const EXAMPLE: &str = "hypercircle://example.toml";

/// The result of `resources/list`.
pub fn list() -> Value {
    json!({"resources": [
        {"uri": SCHEMA, "name": "scene.schema.json", "mimeType": "application/schema+json", "description": "every key of a scene"},
        {"uri": EXAMPLE, "name": "example.toml", "mimeType": "application/toml", "description": "a commented scene: two blocks in contact"},
    ]})
}

/// The result of `resources/read`.
///
/// # Errors
/// There is no such resource.
pub fn read(uri: Option<&str>) -> Result<Value, Refusal> {
    let (uri, kind, text) = match uri {
        Some(SCHEMA) => (SCHEMA, "application/schema+json", scene::schema().to_string()),
        Some(EXAMPLE) => (EXAMPLE, "application/toml", include_str!("../../../../cases/two_blocks.toml").to_string()),
        _ => {
            return Err(Refusal::new(
                Refusal::NO_RESOURCE,
                format!("there is no such resource; read {SCHEMA} or {EXAMPLE}"),
            ));
        }
    };
    Ok(json!({"contents": [{"uri": uri, "mimeType": kind, "text": text}]}))
}
