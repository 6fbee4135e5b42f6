//! The server: reads messages, answers at once what needs no run, and has one call at a time run beside.

use std::collections::VecDeque;
use std::io::{BufRead, Read, Write};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use serde_json::{Map, Value, json};

use super::answer::Answer;
use super::message::{Message, Refusal, parse, reply};
use super::{resources, tools};

/// Bytes of a message.
const LONGEST: u64 = 16 << 20;
/// Calls that may wait.
const MOST_WAITING: usize = 32;
/// How often a caller who asked for it hears that a call still runs.
const PULSE: Duration = Duration::from_secs(5);
/// Versions of the protocol, the newest first. That of March 2025 has batches, which none before or after it has.
const VERSIONS: [&str; 3] = ["2025-11-25", "2025-06-18", "2024-11-05"];

/// Function that answers a call of a tool with its arguments, unless it becomes unwanted meanwhile.
type Run<'a> = dyn Fn(&str, Value, &AtomicBool) -> Answer + Sync + 'a;

struct Waiting {
    id: Value,
    tool: String,
    arguments: Value,
    /// Where its progress is to be told.
    token: Option<Value>,
    unwanted: Arc<AtomicBool>,
}

/// Calls that wait, and the one that runs.
#[derive(Default)]
struct Queue {
    waiting: VecDeque<Waiting>,
    running: Option<(Value, Arc<AtomicBool>)>,
    is_closed: bool,
}

struct Server<W> {
    output: Mutex<W>,
    queue: Mutex<Queue>,
    changed: Condvar,
    /// True if nobody reads the answers any more.
    is_deaf: AtomicBool,
}

/// Answers the messages of `input` on `output` until the one ends or the other is closed.
pub fn serve(mut input: impl BufRead, output: impl Write + Send, run: &Run<'_>) {
    let server = Server {
        output: Mutex::new(output),
        queue: Mutex::default(),
        changed: Condvar::new(),
        is_deaf: AtomicBool::new(false),
    };
    thread::scope(|scope| {
        let work = || server.work(run);
        // Without a thread there is nobody to run calls; they are answered one by one in this one.
        let worker = thread::Builder::new().spawn_scoped(scope, work).is_ok();
        while !server.is_deaf.load(Ordering::Relaxed) {
            let Some(line) = line(&mut input) else { break };
            match line {
                Ok(text) if text.trim_ascii().is_empty() => {}
                Ok(text) => server.take(&text),
                Err(refusal) => server.say(&reply(&Value::Null, Err(refusal))),
            }
            if !worker {
                server.drain(run);
            }
        }
        let mut queue = server.queue();
        queue.is_closed = true;
        if server.is_deaf.load(Ordering::Relaxed) {
            queue.waiting.clear();
            queue.running.iter().for_each(|(_, unwanted)| unwanted.store(true, Ordering::Relaxed));
        }
        drop(queue);
        server.changed.notify_all();
    });
}

/// The next line; `None` at the end of the input.
fn line(input: &mut impl BufRead) -> Option<Result<Vec<u8>, Refusal>> {
    let mut text = Vec::new();
    let read = input.by_ref().take(LONGEST).read_until(b'\n', &mut text).ok()?;
    if read == 0 {
        return None;
    }
    if text.ends_with(b"\n") || (read as u64) < LONGEST {
        return Some(Ok(text));
    }
    // The rest of it is read and forgotten, piece by piece.
    loop {
        text.clear();
        let read = input.by_ref().take(1 << 16).read_until(b'\n', &mut text).ok()?;
        if read == 0 || text.ends_with(b"\n") {
            let what =
                format!("a message has at most {} MiB; put large fields into a file of the folder", LONGEST >> 20);
            return Some(Err(Refusal::new(Refusal::NO_REQUEST, what)));
        }
    }
}

impl<W: Write + Send> Server<W> {
    fn queue(&self) -> MutexGuard<'_, Queue> {
        self.queue.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn say(&self, message: &Value) {
        let mut output = self.output.lock().unwrap_or_else(PoisonError::into_inner);
        if writeln!(output, "{message}").and_then(|()| output.flush()).is_err() {
            self.is_deaf.store(true, Ordering::Relaxed);
        }
    }

    fn take(&self, text: &[u8]) {
        match parse(text) {
            Err((id, refusal)) => self.say(&reply(&id, Err(refusal))),
            Ok(Message::Response) => {}
            Ok(Message::Notification { method, params }) => {
                if let ("notifications/cancelled", Some(id)) = (method.as_str(), params.get("requestId")) {
                    self.forget(id);
                }
            }
            Ok(Message::Request { id, method, params }) if method == "tools/call" => {
                if let Err(refusal) = self.enqueue(&id, params) {
                    self.say(&reply(&id, Err(refusal)));
                }
            }
            Ok(Message::Request { id, method, params }) => self.say(&reply(&id, at_once(&method, &params))),
        }
    }

    /// Drops a call that is no longer wanted; it is not answered.
    fn forget(&self, id: &Value) {
        let mut queue = self.queue();
        queue.waiting.retain(|call| call.id != *id);
        if let Some((_, unwanted)) = queue.running.as_ref().filter(|(own, _)| own == id) {
            unwanted.store(true, Ordering::Relaxed);
        }
    }

    fn enqueue(&self, id: &Value, mut params: Map<String, Value>) -> Result<(), Refusal> {
        let Some(Value::String(tool)) = params.remove("name") else {
            return Err(Refusal::new(Refusal::BAD_PARAMS, "a call has the name of a tool, which is text"));
        };
        if !tools::is_tool(&tool) {
            let shown: String = tool.chars().take(60).collect();
            let what = format!("there is no tool '{shown}'; use one of {}", tools::names().join(", "));
            return Err(Refusal::new(Refusal::BAD_PARAMS, what));
        }
        let arguments = match params.remove("arguments") {
            None | Some(Value::Null) => json!({}),
            Some(Value::Object(arguments)) => Value::Object(arguments),
            Some(_) => return Err(Refusal::new(Refusal::BAD_PARAMS, "arguments are an object")),
        };
        let token = params.get("_meta").and_then(|meta| meta.get("progressToken")).cloned();
        let token = token.filter(|token| token.is_string() || token.is_number());
        let mut queue = self.queue();
        if queue.waiting.len() >= MOST_WAITING {
            let what = format!("{MOST_WAITING} calls wait already; ask again when they are answered");
            return Err(Refusal::new(Refusal::BUSY, what));
        }
        let is_known = queue.waiting.iter().any(|call| call.id == *id);
        if is_known || queue.running.as_ref().is_some_and(|(own, _)| own == id) {
            return Err(Refusal::new(Refusal::NO_REQUEST, "a request with this id is not answered yet"));
        }
        queue.waiting.push_back(Waiting { id: id.clone(), tool, arguments, token, unwanted: Arc::default() });
        drop(queue);
        self.changed.notify_one();
        Ok(())
    }

    /// Runs calls until there will be no more.
    fn work(&self, run: &Run<'_>) {
        let mut queue = self.queue();
        loop {
            if let Some(call) = queue.waiting.pop_front() {
                queue.running = Some((call.id.clone(), Arc::clone(&call.unwanted)));
                drop(queue);
                self.answer(call, run);
                queue = self.queue();
                queue.running = None;
            } else if queue.is_closed {
                return;
            } else {
                queue = self.changed.wait(queue).unwrap_or_else(PoisonError::into_inner);
            }
        }
    }

    /// Runs those that wait now.
    fn drain(&self, run: &Run<'_>) {
        loop {
            let Some(call) = self.queue().waiting.pop_front() else { return };
            self.answer(call, run);
        }
    }

    fn answer(&self, call: Waiting, run: &Run<'_>) {
        let Waiting { id, tool, arguments, token, unwanted } = call;
        let result = self.pulsing(token.as_ref(), &tool, || run(&tool, arguments, &unwanted));
        if !unwanted.load(Ordering::Relaxed) {
            self.say(&reply(&id, Ok(result.result())));
        }
    }

    /// Does `work`, and tells every few seconds that it still runs, if anybody wants to know.
    fn pulsing<T>(&self, token: Option<&Value>, tool: &str, work: impl FnOnce() -> T) -> T {
        let Some(token) = token else { return work() };
        let (over, ends) = mpsc::channel::<()>();
        let started = Instant::now();
        let tell = move || {
            while ends.recv_timeout(PULSE) == Err(RecvTimeoutError::Timeout) {
                let seconds = started.elapsed().as_secs();
                let params =
                    json!({"progressToken": token, "progress": seconds, "message": format!("{tool}: {seconds} s")});
                self.say(&json!({"jsonrpc": "2.0", "method": "notifications/progress", "params": params}));
            }
        };
        thread::scope(|scope| {
            // Without the thread nothing is told, and nothing else is lost.
            let _ = thread::Builder::new().spawn_scoped(scope, tell);
            let result = work();
            drop(over);
            result
        })
    }
}

/// The answer to what needs no run.
fn at_once(method: &str, params: &Map<String, Value>) -> Result<Value, Refusal> {
    let text = |key: &str| params.get(key).and_then(Value::as_str);
    match method {
        "initialize" => Ok(initialized(text("protocolVersion").unwrap_or_default())),
        "ping" => Ok(json!({})),
        "tools/list" | "resources/list" if params.get("cursor").is_some_and(|cursor| !cursor.is_null()) => {
            Err(Refusal::new(Refusal::BAD_PARAMS, "there is one page, and no cursor"))
        }
        "tools/list" => Ok(tools::list()),
        "resources/list" => Ok(resources::list()),
        "resources/templates/list" => Ok(json!({"resourceTemplates": []})),
        "resources/read" => resources::read(text("uri")),
        other => {
            let shown: String = other.chars().take(60).collect();
            Err(Refusal::new(Refusal::NO_METHOD, format!("there is no method '{shown}'")))
        }
    }
}

/// The version that is asked for if it is known, else the newest that is not newer; a client that knows none of them ends by itself.
fn initialized(wanted: &str) -> Value {
    let version = VERSIONS.into_iter().find(|known| *known <= wanted).unwrap_or(VERSIONS[0]);
    json!({
        "protocolVersion": version,
        "capabilities": {"tools": {"listChanged": false}, "resources": {}},
        "serverInfo": {"name": "hypercircle", "title": "hypercircle", "version": env!("CARGO_PKG_VERSION")},
        "instructions": tools::INSTRUCTIONS,
    })
}

#[cfg(test)]
#[path = "serve_tests.rs"]
mod tests;
