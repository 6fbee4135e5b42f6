"""`hypercircle-check FOLDER`: reads `proof.npz`, proves the bracket, says what was proved and on what premises."""

import argparse
import hashlib
import io
import json
import sys
import time
import warnings
import zipfile
import zlib
from pathlib import Path

import numpy as np
from flint import arb, fmpq

from . import VERSION, Refused
from .lower import Stress
from .mesh import Mesh
from .quantity import interval
from .scene import Scene
from .upper import Displacement

FORMAT = 1
PART = arb(fmpq(1, 1000))  # of the width, by which a bracket may be wider than claimed: it is told then
LEAST = arb(10) ** -250  # and what underflows in double precision
DATA = arb(2) ** -44  # of the energy, by which the data of two meshes, rounded to doubles each for itself, may contradict each other
UNREADABLE = (OSError, ValueError, EOFError, NotImplementedError, MemoryError, zlib.error, zipfile.BadZipFile, zipfile.LargeZipFile)


def read(path):
    """The arrays of a proof, compared with their digest."""
    try:
        with zipfile.ZipFile(path) as archive:
            files = {name.removesuffix(".npy"): archive.read(name) for name in archive.namelist()}
        data = {name: np.load(io.BytesIO(content), allow_pickle=False) for name, content in files.items()}
    except UNREADABLE as error:
        raise Refused(f"{path} cannot be read: {error}") from None
    own = hashlib.sha256(b"".join(name.encode() + content for name, content in files.items() if name != "digest"))
    if bytes(data.get("digest", b"")) != own.digest():
        raise Refused("the digest in the proof is not that of its arrays: the file was changed or damaged")
    return data


def printable(text):
    """Text of a proof as one line that no terminal takes for anything else."""
    if not isinstance(text, str):
        raise TypeError(f"{text!r} is no text")
    return "".join(c if c.isprintable() else "\ufffd" for c in text)


class Proof:
    """The statements that a proof file proves. Raises Refused with the failed check."""

    def __init__(self, data):
        try:
            self._check(data)
        except KeyError as error:
            raise Refused(f"the proof lacks {error}") from None
        except (IndexError, TypeError, ValueError, AttributeError) as error:
            raise Refused(f"the proof is malformed: {error}") from None
        except MemoryError:
            raise Refused("the proof does not fit into memory") from None
        except RecursionError:
            raise Refused("the proof is malformed: it is nested too deep") from None
        except ArithmeticError:
            raise Refused("the numbers of the proof leave the range in which they can be enclosed") from None

    def _check(self, data):
        # What overflows is refused where it is enclosed.
        warnings.simplefilter("ignore")
        self.manifest, text = json.loads(bytes(data["manifest"])), bytes(data["scene"])
        if self.manifest["format"] != FORMAT:
            raise Refused(f"the proof has the format {self.manifest['format']}; this checker reads {FORMAT}")
        if hashlib.sha256(text).hexdigest() != self.manifest["scene_sha256"]:
            raise Refused("the scene in the proof is not the one that its hash names")
        self.name = printable(self.manifest["scene"])
        self.files = [(printable(file["name"]), printable(file["sha256"])) for file in self.manifest["mesh_files"]]
        scene = Scene(text)
        meshes = [Mesh(data, of, scene, self.manifest) for of in ("stress", "displacement")]
        self.stress, self.displacement = Stress(meshes[0], data), Displacement(meshes[1], data)
        self.lower, self.upper = self.stress.bound(), self.displacement.bound(self.stress.extra)
        self.quantities = [interval(data, self.manifest, scene, i) for i in range(len(self.manifest.get("quantities", [])))]
        premises = [premise for mesh in meshes for premise in mesh.premises]
        if any(self.manifest["origin"]):
            premises.append(f"coordinates of the mesh count from {self.manifest['origin']} and were rounded there")
        source = "the polygons of the scene" if scene.polygons else "its file, with the boundaries that it names"
        premises.append(f"the bodies are the triangles in the proof, which hypercircle made from {source}")
        self.premises, self.claim = list(dict.fromkeys(premises)), [float(self.manifest["claim"][end]) for end in ("lower", "upper")]

    def against_claim(self):
        """The ends that are proved: those claimed, or farther out by next to nothing."""
        if self.lower - self.upper > max(self.displacement.grain, DATA * abs(self.upper)):
            raise Refused("the lower bound lies above the upper one: the proof is not of one scene")
        if self.lower > self.upper:
            self.premises.append(f"the data of two meshes, rounded each for itself, contradict each other by {float(self.lower - self.upper):.1e}")
        allowed = max((arb(self.claim[1]) - self.claim[0]) * PART, self.displacement.grain, LEAST)
        self.room = [self.lower - self.claim[0], self.claim[1] - self.upper]
        for end, room, found, claimed in zip(("lower", "upper"), self.room, (self.lower, self.upper), self.claim):
            if not room >= -allowed:
                raise Refused(f"the {end} bound {claimed!r} is claimed, and only {float(found)!r} is proved, {float(-room):.2e} from it")
        self.proved = [min(self.lower, arb(self.claim[0])), max(self.upper, arb(self.claim[1]))]


def check(folder, scene=None):
    """Verifies a folder or a file, and that its scene is that of the file `scene`; returns the Proof or raises Refused."""
    folder = Path(folder)
    proof, report = Proof(read(folder if folder.is_file() else folder / "proof.npz")), folder / "report.json"
    try:
        if scene and hashlib.sha256(Path(scene).read_bytes()).hexdigest() != proof.manifest["scene_sha256"]:
            raise Refused(f"{scene} is not the scene of the proof")
        shown = json.loads(report.read_text())["energy"] if report.is_file() else proof.manifest["claim"]
        for end, claimed in zip(("lower", "upper"), proof.claim):
            if shown[end] != claimed:
                raise Refused(f"report.json has the {end} bound {shown[end]!r}, and the proof is of {claimed!r}")
    except (*UNREADABLE, KeyError, TypeError) as error:
        raise Refused(f"the scene or the report cannot be read: {error!r}") from None
    proof.against_claim()
    return proof


def between(ends):
    """Two numbers in words, as doubles that enclose them."""
    low, high = (float(x) for x in ends)
    low, high = low if low <= ends[0] else np.nextafter(low, -np.inf), high if high >= ends[1] else np.nextafter(high, np.inf)
    return f"between {float(low)!r} and {float(high)!r}"


def main(arguments=None):
    parser = argparse.ArgumentParser(
        prog="hypercircle-check", description="Verifies the bracket of a hypercircle report in exact arithmetic. Exits with 0 if it is proved, 1 if not."
    )
    parser.add_argument("folder", help="folder of a report with proof.npz, or the file itself")
    parser.add_argument("--scene", metavar="FILE", help="also require that this is the scene of the proof")
    parser.add_argument("--version", action="version", version=f"hypercircle-check {VERSION}")
    given, start = parser.parse_args(arguments), time.monotonic()
    try:
        proof = check(given.folder, given.scene)
    except Refused as failed:
        print(f"not proved: {failed}.")
        return 1
    told = [f"{abs(float(room)):.1e} {'inside' if room >= 0 else 'OUTSIDE'} what is claimed" for room in proof.room]
    print(f"proved: the exact energy of {proof.name} lies {between(proof.proved)}.")
    print(f"  lower bound: stress in exact equilibrium on {len(proof.stress.mesh.triangles)} triangles, {told[0]}")
    print(f"  upper bound: admissible displacement on {len(proof.displacement.mesh.triangles)} triangles, {told[1]}")
    for name, ends, claimed in proof.quantities:
        print(f"  quantity {name}: {between(ends)}, where the report has {claimed[0]!r} to {claimed[1]!r}")
    for premise in proof.premises:
        print(f"  premise: {premise}")
    print(f"  scene: sha256 {proof.manifest['scene_sha256']}")
    for name, digest in proof.files:
        print(f"  mesh: {name}, sha256 {digest}")
    print(f"  by hypercircle-check {VERSION}\n  {time.monotonic() - start:.1f} s")
    return 0


if __name__ == "__main__":
    sys.exit(main())
