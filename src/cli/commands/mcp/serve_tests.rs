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
    answers_of(input, &echo)
}

fn answers_of(input: impl Read, run: &Run<'_>) -> Vec<Value> {
    let mut output = Vec::new();
    serve(BufReader::new(input), &mut output, run);
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

/// Bytes that come once a call runs.
struct OnceRunning<'a>(&'a AtomicBool, &'a [u8]);

impl Read for OnceRunning<'_> {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        while !self.0.load(Ordering::Relaxed) {
            thread::sleep(Duration::from_millis(1));
        }
        self.1.read(into)
    }
}

#[test]
fn what_cannot_be_called_is_refused_and_the_next_call_is_answered() {
    let many: String = (1..40).map(|i| call(100 + i, "wait")).collect();
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
        call(100, "wait"),
    ];
    let behind = [many, call(101, "again"), cancelled, call(7, "a")].concat();
    let running = AtomicBool::new(false);
    let told = |tool: &str, arguments: Value, unwanted: &AtomicBool| {
        running.store(true, Ordering::Relaxed);
        echo(tool, arguments, unwanted)
    };
    let found = answers_of(lines.concat().as_bytes().chain(OnceRunning(&running, behind.as_bytes())), &told);
    let codes = |id: Value| -> Vec<i64> {
        found
            .iter()
            .filter(|answer| answer["id"] == id)
            .map(|answer| answer["error"]["code"].as_i64().unwrap_or(0))
            .collect()
    };
    assert_eq!(codes(Value::Null), [-32700]);
    for (id, code) in
        [(1, -32602), (2, -32602), (3, -32602), (4, -32602), (5, -32601), (6, -32002), (139, -32000), (7, 0)]
    {
        assert_eq!(codes(json!(id)), [code], "{id}");
    }
    assert_eq!(codes(json!(101)), [-32000], "32 wait by then");
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
