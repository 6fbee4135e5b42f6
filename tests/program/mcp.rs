//! `mcp`, by a client that writes its messages itself: what is hostile is refused, and the next call is answered.

use std::io::Write;
use std::path::Path;
use std::process::Stdio;

use crate::command::hypercircle;
use serde_json::{Value, json};

/// A block on its base, from a mesh file.
fn scene(mesh: &str) -> String {
    format!(
        "model.kinematics = \"plane-strain\"\nmesh.file = {mesh:?}\nbodies.block = {{ young = 1.0, poisson = 0.3 }}\n\
         supports = [{{ on = \"base\", type = \"clamped\" }}]\ntractions = [{{ on = \"top\", value = [0.0, -1.0] }}]\n"
    )
}

/// A unit square of two triangles with names.
const MESH: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n3\n1 1 \"base\"\n1 2 \"top\"\n2 3 \"block\"\n$EndPhysicalNames\n\
                    $Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n$EndNodes\n$Elements\n4\n1 1 2 1 1 1 2\n2 1 2 2 2 3 4\n3 2 2 3 3 1 2 3\n\
                    4 2 2 3 3 1 3 4\n$EndElements\n";

/// The unit square of [`MESH`] as a deck.
const DECK: &str =
    "*NODE\n1, 0, 0\n2, 1, 0\n3, 1, 1\n4, 0, 1\n*ELEMENT, TYPE=CPE3, ELSET=block\n1, 1, 2, 3\n2, 1, 3, 4\n";

fn call(id: u32, tool: &str, arguments: Value) -> String {
    json!({"jsonrpc": "2.0", "id": id, "method": "tools/call", "params": {"name": tool, "arguments": arguments}})
        .to_string()
}

/// The answers of a server of `folder` to `lines`.
fn answers(folder: &Path, words: &[&str], lines: &[String]) -> Vec<Value> {
    let mut command = hypercircle(folder, ["mcp"].iter().chain(words));
    let mut server = command.stdin(Stdio::piped()).spawn().expect("the program starts");
    let mut input = server.stdin.take().expect("a pipe");
    let text = lines.join("\n");
    let writer = std::thread::spawn(move || input.write_all(text.as_bytes()).expect("read"));
    let output = server.wait_with_output().expect("an end");
    writer.join().expect("written");
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success() && !said.contains("panicked"), "{said}");
    let text = String::from_utf8(output.stdout).expect("text");
    text.lines().map(|line| serde_json::from_str(line).expect("JSON and nothing else")).collect()
}

fn of(answers: &[Value], id: u32) -> &Value {
    answers.iter().find(|answer| answer["id"] == id).unwrap_or_else(|| panic!("no answer to {id} in {answers:?}"))
}

#[test]
fn a_session_by_hand_ends_with_the_answers_to_all_that_was_asked() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("block.msh"), MESH).expect("writable");
    let hello = json!({"jsonrpc": "2.0", "id": 1, "method": "initialize", "params": {"protocolVersion": "2025-06-18", "capabilities": {},
        "clientInfo": {"name": "hand", "version": "0"}}});
    let lines = [
        hello.to_string(),
        json!({"jsonrpc": "2.0", "method": "notifications/initialized"}).to_string(),
        call(2, "solve", json!({"scene": scene("block.msh"), "refine": 1})),
        call(3, "certify", json!({"scene": scene("block.msh")})),
    ];
    let found = answers(folder.path(), &[], &lines);
    assert_eq!(of(&found, 1)["result"]["protocolVersion"], "2025-06-18");
    let solved = &of(&found, 2)["result"];
    assert_eq!((&solved["isError"], &solved["structuredContent"]["dual"]["triangles"]), (&json!(false), &json!(8)));
    assert_eq!(of(&found, 3)["result"]["isError"], true);
    let left: Vec<_> = std::fs::read_dir(folder.path()).expect("readable").collect();
    assert_eq!(left.len(), 1, "the server writes nothing into its folder: {left:?}");
}

#[test]
fn no_path_leads_out_of_the_folder() {
    let above = tempfile::tempdir().expect("a folder");
    let folder = above.path().join("folder");
    std::fs::create_dir_all(folder.join("sub")).expect("writable");
    let write = |name: &str, text: &str| std::fs::write(folder.join(name), text).expect("writable");
    std::fs::write(above.path().join("secret.msh"), MESH).expect("writable");
    std::fs::write(above.path().join("secret.inp"), DECK).expect("writable");
    for (name, text) in
        [("block.msh", MESH), ("sub/block.msh", MESH), ("open.inp", DECK), ("run.geo", "SystemCall \"true\";\n")]
    {
        write(name, text);
    }
    write("leads.inp", "*include, input=../secret.inp\n");
    write("leads_on.inp", "** a comment\n * INCLUDE,\nINPUT=secret.inp\n");
    let link = |to: &Path, name: &str| std::os::unix::fs::symlink(to, folder.join(name)).expect("writable");
    link(&above.path().join("secret.msh"), "link.msh");
    link(above.path(), "up");
    link(&folder.join("run.geo"), "script.msh");
    link(&folder.join("block.msh"), "alias.msh");
    let absolute = above.path().join("secret.msh");
    let hostile = [
        "../secret.msh",
        "sub/../../secret.msh",
        "sub/../block.msh",
        absolute.to_str().expect("text"),
        "link.msh",
        "up/secret.msh",
        "/etc/passwd",
        "/dev/zero",
        "/proc/self/environ",
        "sub",
        ".",
        "nothing.msh",
        "run.geo",
        "script.msh",
        "leads.inp",
        "leads_on.inp",
        "block.msh\u{0}",
        "~/x.msh",
    ];
    let within = ["block.msh", "sub/block.msh", "alias.msh", "./block.msh"];
    let mut lines: Vec<String> =
        (0..).zip(hostile).map(|(id, file)| call(id, "solve", json!({"scene": scene(file)}))).collect();
    lines.extend(
        (100..).zip(hostile).map(|(id, file)| call(id, "certify", json!({"scene": scene("block.msh"), "file": file}))),
    );
    lines.extend((200..).zip(within).map(|(id, file)| call(id, "solve", json!({"scene": scene(file)}))));
    let parts = "model.kinematics = \"plane-strain\"\n[[mesh.parts]]\nfile = \"block.msh\"\n[[mesh.parts]]\nfile = \"../secret.msh\"\n\
                 prefix = \"b_\"\n[bodies.block]\nyoung = 1.0\npoisson = 0.3\n[bodies.b_block]\nyoung = 1.0\npoisson = 0.3\n";
    lines.push(call(300, "solve", json!({"scene": parts})));
    // No more of them may wait at a time.
    let found: Vec<Value> =
        lines.chunks(30).flat_map(|lines| answers(above.path(), &["--folder", "folder"], lines)).collect();
    for (id, file) in (0..).zip(hostile).chain((100..).zip(hostile)).chain([(300, "parts")]) {
        let result = &of(&found, id)["result"];
        let words = result["content"][0]["text"].as_str().expect("words");
        assert_eq!(result["isError"], true, "{file}: {words}");
        assert!(!words.contains("root:") && words.len() < 2000, "{file}: {words}");
    }
    for (id, file) in (200..).zip(within) {
        assert_eq!(of(&found, id)["result"]["isError"], false, "{file}: {}", of(&found, id));
    }
}

#[test]
fn what_is_no_message_or_much_too_large_is_refused_and_the_next_one_answered() {
    let folder = tempfile::tempdir().expect("a folder");
    let deep = "[".repeat(100_000);
    let long_scene = format!("title = \"{}\"", "x".repeat(3 << 20));
    let large = json!({"matrix": vec![vec![1.0; 600]; 600], "nodes": vec![[0.0, 0.0]; 300]});
    let lines = [
        "\u{0}\u{7f}{]".to_string(),
        deep,
        "{\"jsonrpc\": \"2.0\", \"id\": 1, \"method\": \"tools/call\", \"params\": {\"name\": \"solve\", \"arguments\": {\"scene\": \"".to_string(),
        "x".repeat(17 << 20),
        call(1, "solve", json!({"scene": long_scene})),
        call(2, "element", large),
        call(3, "solve", json!({"scene": scene("block.msh").replace("0.3", "1e999")})),
        call(4, "rm", json!({})),
        call(5, "element", json!({})),
    ];
    let found = answers(folder.path(), &["--max-seconds", "60"], &lines);
    let refused: Vec<_> = found.iter().filter(|answer| answer["id"].is_null()).map(|a| &a["error"]["code"]).collect();
    assert_eq!(refused, [-32700, -32700, -32700, -32600]);
    for id in [1, 2, 3] {
        assert_eq!(of(&found, id)["result"]["isError"], true, "{id}");
    }
    assert_eq!(of(&found, 4)["error"]["code"], -32602);
    assert_eq!(of(&found, 5)["result"]["isError"], false);
}
