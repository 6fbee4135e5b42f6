"""One run of the program on changed files, and what has to hold of it."""

import json
import os
import random
import re
import resource
import shutil
import signal
import subprocess
import time
import xml.etree.ElementTree as xml
from dataclasses import dataclass, field
from pathlib import Path

import changes

ROOT = Path(__file__).resolve().parents[2]
STAND_IN = Path(__file__).resolve().parent / "stand_in.py"
FILES = {"report.json", "report.html", "junit.xml", "summary.md", "fields.vtu"}
# Those that have rows.
TABLES = {"checks.csv", "contacts.csv", "quantities.csv"}
CODES = {"agree": {0}, "disagree": {1}, "undecided": {1}, "infeasible": {5}, "failed": {3, 4}}
# Address space, seconds of the processor, and seconds on a machine that is busy.
MEMORY, SECONDS, PATIENCE = 1 << 30, 5, 40
BAD_WORDS = [b"panicked", b"internal error", b"RUST_BACKTRACE", b"stack overflow", b"memory allocation of"]


def _texts(pattern):
    return [path.read_bytes() for path in sorted(ROOT.glob(pattern))]


class Material:
    """What is changed: scenes, the same with a mesh file, meshes, fields and what meshio makes of them."""

    def __init__(self):
        self.scenes = _texts("cases/*.toml") + _texts("tests/scenes/*.toml") + _texts("tests/malformed/valid/*.toml")
        self.odd = _texts("fuzz/corpus/scene/*") + _texts("tests/malformed/scenes/*.toml")
        self.gmsh = _texts("fuzz/corpus/msh/*") + _texts("tests/meshes/*.msh")
        arrays = sorted((ROOT / "fuzz/corpus/field").glob("*.json"))
        self.fields = [path for path in arrays if not path.name.startswith("mesh")]
        self.meshes = [path for path in arrays if path.name.startswith("mesh")]
        self.setting = (ROOT / "fuzz/src/setting.toml").read_bytes()
        self.meshed = (ROOT / "fuzz/program/meshed.toml").read_bytes()
        self.baseline = json.dumps({"version": 1, "scene": "scene", "values": {"triangles": 4.0, "energy.lower": -1.0}}).encode()


@dataclass
class Trial:
    kind: str
    seed: str
    arguments: list
    environment: dict
    files: dict
    code: object = None
    seconds: float = 0.0
    faults: list = field(default_factory=list)


def _options(chance, command):
    """Options that bound the work, and some that do not matter."""
    options = ["--max-memory", chance.choice(["60M", "100M", "150M"]), "--reading-seconds", "2"]
    if command != "certify" and chance.random() < 0.25:
        options += ["--tolerance", chance.choice(["0.5", "0.1", "0.03", "1e-300"]), "--max-triangles", "400", "--max-seconds", "1"]
    elif chance.random() < 0.15:
        options += ["--refine", chance.choice(["0", "1", "12"])]
    if chance.random() < 0.4:
        options += ["--method", chance.choice(["condensed", "active-set", "clarabel", "uzawa"])]
    if chance.random() < 0.1:
        options += ["--threads", chance.choice(["2", "1024"])]
    if command != "solve" and chance.random() < 0.2:
        options += chance.choice([["--baseline", "base.json"], ["--baseline", "base.json", "--accept"], ["--allow", "energy=1e300"]])
    return options


def prepare(material, seed):
    """The trial of a seed; the same one every time."""
    chance = random.Random(seed)
    some_scene = lambda: chance.choice(material.scenes if chance.random() < 0.9 else material.odd)
    scene = lambda: changes.scene(some_scene(), chance, some_scene())
    kind = chance.choices(["solve", "mesh", "verify", "certify", "arrays"], [45, 20, 20, 7, 8])[0]
    files, environment = {}, {"HYPERCIRCLE_FUZZ": seed, "HYPERCIRCLE_PYTHON": str(STAND_IN)}
    command, more = kind, []
    if kind == "solve":
        files["scene.toml"] = scene()
    elif kind == "mesh":
        command = "solve"
        mesh, other = chance.choice(material.gmsh), chance.choice(material.gmsh)
        files["scene.toml"] = material.meshed if chance.random() < 0.8 else changes.scene(material.meshed, chance, scene())
        files["mesh.msh"] = changes.file(mesh, chance, other)
    elif kind == "verify":
        files["scene.toml"] = scene() if chance.random() < 0.5 else some_scene()
        more = ["--primal-seconds", "1"]
    elif kind == "certify":
        # The file itself is nothing to the stand-in; with it comes whatever it hands back.
        files["scene.toml"], files["field.vtk"] = material.setting, b"x"
        if chance.random() < 0.2:
            files["scene.toml"] = changes.scene(material.setting, chance, scene())
        environment["HYPERCIRCLE_FUZZ_FIELD"] = str(chance.choice(material.fields))
        more = ["--displacement", "field.vtk"]
    else:
        command = "solve"
        files["scene.toml"], files["mesh.mesh"] = material.meshed.replace(b"mesh.msh", b"mesh.mesh").replace(b"right face", b"right_face"), b"x"
        environment["HYPERCIRCLE_FUZZ_FIELD"] = str(chance.choice(material.meshes))
    options = _options(chance, command)
    if "uzawa" in options:
        # It is slow by nature on fine meshes.
        files["scene.toml"] = re.sub(rb"(?m)^size = .*$", b"size = 1.0", files["scene.toml"])
    if command != "solve" and "--max-seconds" not in options:
        # Bounds are refined for the sake of the verdict, for half a minute where nobody says how long.
        options += ["--max-seconds", "1"]
    if chance.random() < 0.5:
        files["base.json"] = changes.file(material.baseline, chance, b"{}")
    return Trial(kind, seed, [command, "scene.toml", *more, *options], environment, files)


def _limits():
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def run(trial, binary, place):
    """Runs it in `place`, an empty folder, and judges what came of it."""
    work, temporary = place / "work", place / "tmp"
    work.mkdir(parents=True)
    temporary.mkdir()
    for name, data in trial.files.items():
        (work / name).write_bytes(data)
    environment = {**os.environ, **trial.environment, "TMPDIR": str(temporary)}
    with open(place / "stdout", "wb") as out, open(place / "stderr", "wb") as err:
        child = subprocess.Popen([binary, *trial.arguments], cwd=work, env=environment, stdin=subprocess.DEVNULL,
                                 stdout=out, stderr=err, preexec_fn=_limits, start_new_session=True)
        ends = time.monotonic() + PATIENCE
        while True:
            done, status, usage = os.wait4(child.pid, os.WNOHANG)
            if done or time.monotonic() > ends:
                break
            time.sleep(0.002)
        if not done:
            trial.faults.append(f"it was not done after {PATIENCE} s")
            os.killpg(child.pid, signal.SIGKILL)
            _, status, usage = os.wait4(child.pid, 0)
        child.returncode = 0
    trial.seconds = usage.ru_utime + usage.ru_stime
    trial.code = os.waitstatus_to_exitcode(status)
    _judge(trial, work, temporary, (place / "stdout").read_bytes(), (place / "stderr").read_bytes())


def _judge(trial, work, temporary, out, err):
    fault = trial.faults.append
    if trial.code not in range(6):
        fault(f"exit code {trial.code}")
    if trial.seconds > SECONDS:
        fault(f"{trial.seconds:.1f} s of the processor")
    for word in BAD_WORDS:
        if word in err + out:
            fault(f"it says `{word.decode()}`")
    if b"\x1b" in out + err or b"\x9b" in re.sub(rb"[\xc2-\xf4][\x80-\xbf]+", b"", out + err):
        fault("an escape code on the terminal")
    if len(out) + len(err) > 100_000:
        fault(f"{len(out) + len(err)} bytes on the terminal")
    if trial.code not in (0, 1) and not err.strip():
        fault("no message")
    if left := sorted(os.listdir(temporary)):
        fault(f"temporary files: {left}")
    if extra := set(os.listdir(work)) - set(trial.files) - {"out", "base.json"}:
        fault(f"other files: {sorted(extra)}")
    folder = work / "out"
    if not folder.exists():
        if trial.code in (0, 1):
            fault("no report")
        return
    if sorted(os.listdir(folder)) != ["scene"] or set(os.listdir(folder / "scene")) - TABLES != FILES:
        return fault(f"the folder holds {sorted(str(p.relative_to(folder)) for p in folder.rglob('*'))}")
    if trial.code == 2:
        fault("bad input, and a report")
    try:
        _judge_report(trial, folder / "scene", fault)
    except (ValueError, KeyError, xml.ParseError) as error:
        fault(f"the report cannot be read: {error!r}")


def _judge_report(trial, folder, fault):
    def strict(constant):
        raise ValueError(constant)

    report = json.loads((folder / "report.json").read_text("utf-8"), parse_constant=strict)
    for name in ("junit.xml", "fields.vtu"):
        xml.parse(folder / name)
    if trial.code not in CODES[report["status"]]:
        fault(f"exit code {trial.code} and status {report['status']}")
    for name in os.listdir(folder):
        if report["run"].encode() not in (folder / name).read_bytes():
            fault(f"{name} is of another run")
    energy = report.get("energy") or {}
    lower, upper = energy.get("lower"), energy.get("upper")
    if lower is not None and upper is not None and lower > upper:
        fault(f"the lower bound {lower} is above the upper one {upper}")


def keep(trial, place, binary, folder):
    """Keeps the files of a trial with a line that repeats it."""
    target = folder / f"{trial.kind}-{trial.seed}"
    shutil.rmtree(target, ignore_errors=True)
    shutil.copytree(place, target)
    variables = " ".join(f"{name}='{value}'" for name, value in trial.environment.items())
    line = " ".join(f"'{argument}'" for argument in trial.arguments)
    faults = "".join(f"# {text}\n" for text in trial.faults)
    text = f"#!/bin/sh\n{faults}cd '{target / 'work'}'\nulimit -v {MEMORY >> 10}\n{variables} '{binary}' {line}\n"
    (target / "repeat").write_text(text)
    (target / "repeat").chmod(0o755)
