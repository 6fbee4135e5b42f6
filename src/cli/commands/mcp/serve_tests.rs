use std::io::{self, BufReader};

use super::*;

/// Repeats what it is asked, waits until nobody wants its answer where it is asked to, and fails where it is asked to.
fn echo(tool: &str, arguments: Value, unwanted: &AtomicBool) -> Answer {
    while arguments["name"] == "wait" && !unwanted.load(Ordering::Relaxed) {
        thread::sleep(Duration::from_millis(1));
    }
    Answer { is_error: arguments["name"] == "fail", words: tool.to_string(), data: arguments }
}

fn answers(input: impl Read) -> Vec<Value> {
    let mut output = Vec::new();
    serve(BufReader::new(input), &mut output, &echo);
    let text = String::from_utf8(output).expect("text");
    text.lines().map(|line| serde_json::from_str(line).expect("JSON")).collect()
}

fn request(id: u32, method: &str, params: Value) -> String {
    format!("{}\n", json!({"jsonrpc": "2.0", "id": id, "method": method, "params": params}))
}

fn call(id: u32, name: &str) -> String {
    request(id, "tools/call", json!({"name": "element", "arguments": {"name": name}}))
}

#[test]
fn versions_are_agreed_on() {
    for (wanted, given) in [
        ("2025-11-25", "2025-11-25"),
        ("2025-06-18", "2025-06-18"),
        ("2025-03-26", "2024-11-05"),
        ("2024-11-05", "2024-11-05"),
        ("2031-01-01", "2025-11-25"),
        ("", "2025-11-25"),
    ] {
        assert_eq!(initialized(wanted)["protocolVersion"], given, "{wanted}");
    }
}

#[test]
fn calls_are_answered_in_turn_and_pings_meanwhile() {
    let lines = [call(1, "a"), "\n".into(), request(2, "ping", json!({})), call(3, "fail")].concat();
    let found = answers(lines.as_bytes());
    let of = |id: u32| found.iter().find(|answer| answer["id"] == id).expect("an answer");
    assert_eq!(found.len(), 3);
    assert_eq!(
        (&of(1)["result"]["structuredContent"]["name"], &of(1)["result"]["isError"]),
        (&json!("a"), &json!(false))
    );
    assert_eq!((&of(2)["result"], &of(3)["result"]["isError"]), (&json!({}), &json!(true)));
}

#[test]
fn a_call_that_is_cancelled_is_ended_and_not_answered() {
    let cancel = |id: u32| {
        format!("{}\n", json!({"jsonrpc": "2.0", "method": "notifications/cancelled", "params": {"requestId": id}}))
    };
    // The first runs or waits when it is cancelled, the second waits behind it.
    let lines = [call(1, "wait"), call(2, "b"), cancel(2), cancel(1), cancel(7), call(3, "c")].concat();
    let ids: Vec<Value> = answers(lines.as_bytes()).iter().map(|answer| answer["id"].clone()).collect();
    assert_eq!(ids, [json!(3)]);
}

#[test]
fn what_cannot_be_called_is_refused_and_the_next_call_is_answered() {
    let many: String = (0..40).map(|i| call(100 + i, "wait")).collect();
    let cancelled: String = (0..40)
        .map(|i| {
            format!(
                "{}\n",
                json!({"jsonrpc": "2.0", "method": "notifications/cancelled", "params": {"requestId": 100 + i}})
            )
        })
        .collect();
    let lines = [
        "garbage\n".to_string(),
        request(1, "tools/call", json!({"name": "shell"})),
        request(2, "tools/call", json!({"name": 7})),
        request(3, "tools/call", json!({"name": "solve", "arguments": []})),
        request(4, "tools/list", json!({"cursor": "x"})),
        request(5, "no/such", json!({})),
        request(6, "resources/read", json!({"uri": "file:///etc/passwd"})),
        many,
        call(101, "again"),
        cancelled,
        call(7, "a"),
    ];
    let found = answers(lines.concat().as_bytes());
    let codes = |id: Value| -> Vec<i64> {
        found
            .iter()
            .filter(|answer| answer["id"] == id)
            .map(|answer| answer["error"]["code"].as_i64().unwrap_or(0))
            .collect()
    };
    assert_eq!(codes(Value::Null), [-32700]);
    for (id, code) in [(1, -32602), (2, -32602), (3, -32602), (4, -32602), (5, -32601), (6, -32002), (7, 0)] {
        assert_eq!(codes(json!(id)), [code], "{id}");
    }
    // 32 wait, and one runs as soon as it is taken.
    let refused: Vec<i64> = (100..140).filter(|id| *id != 101).flat_map(|id| codes(json!(id))).collect();
    assert!((7..=8).contains(&refused.len()) && refused.iter().all(|code| *code == -32000), "{refused:?}");
    // It is one too many, or has the name of one that waits.
    assert!([vec![-32000], vec![-32600]].contains(&codes(json!(101))), "{:?}", codes(json!(101)));
}

#[test]
fn a_message_that_is_too_long_is_refused_without_being_kept() {
    let long = io::repeat(b'x').take(3 * LONGEST / 2).chain(&b"\n"[..]);
    let ping = request(1, "ping", json!({}));
    let found = answers(long.chain(ping.as_bytes()));
    assert_eq!((found.len(), &found[0]["error"]["code"], &found[1]["id"]), (2, &json!(-32600), &json!(1)));
}

#[test]
fn a_server_that_nobody_hears_ends() {
    struct Closed;
    impl Write for Closed {
        fn write(&mut self, _: &[u8]) -> io::Result<usize> {
            Err(io::ErrorKind::BrokenPipe.into())
        }
        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }
    let lines = [call(1, "wait"), request(2, "ping", json!({})), call(3, "wait")].concat();
    serve(BufReader::new(lines.as_bytes()), Closed, &echo);
}
