"""`hypercircle-check FOLDER`: reads `proof.npz`, proves the bracket, says what was proved and on what premises."""

import argparse
import hashlib
import io
import json
import sys
import time
import zipfile
from fractions import Fraction
from pathlib import Path

import numpy as np

from . import VERSION, Refused
from .lower import Stress
from .mesh import Mesh
from .scene import Scene
from .upper import Displacement

FORMAT = 1
PART = Fraction(1, 1000)  # of the width, by which a bracket may be wider than claimed: it is told then


def read(path):
    """The arrays of a proof, held against their digest."""
    try:
        with zipfile.ZipFile(path) as archive:
            files = {name.removesuffix(".npy"): archive.read(name) for name in archive.namelist()}
        data = {name: np.load(io.BytesIO(content), allow_pickle=False) for name, content in files.items()}
    except (OSError, ValueError, zipfile.BadZipFile, zipfile.LargeZipFile, NotImplementedError, EOFError) as error:
        raise Refused(f"{path} cannot be read: {error}") from None
    digest = hashlib.sha256()
    for name, content in files.items():
        if name != "digest":
            digest.update(name.encode() + content)
    if bytes(data.get("digest", b"")) != digest.digest():
        raise Refused("the digest in the proof is not that of its arrays: the file was changed or damaged")
    return data


class Proof:
    """What is proved of a proof file. Raises Refused with what failed."""

    def __init__(self, data):
        try:
            self._check(data)
        except KeyError as error:
            raise Refused(f"the proof lacks {error}") from None
        except (IndexError, TypeError, ValueError, AttributeError) as error:
            raise Refused(f"the proof is malformed: {error}") from None
        except (ZeroDivisionError, OverflowError, ArithmeticError):
            raise Refused("the numbers of the proof leave the range in which they can be enclosed") from None

    def _check(self, data):
        self.manifest = json.loads(bytes(data["manifest"]))
        if self.manifest["format"] != FORMAT:
            raise Refused(f"the proof has the format {self.manifest['format']}; this checker reads {FORMAT}")
        text = bytes(data["scene"])
        if hashlib.sha256(text).hexdigest() != self.manifest["scene_sha256"]:
            raise Refused("the scene in the proof is not the one that its hash names")
        self.scene = Scene(text)
        meshes = [Mesh(data, of, self.scene, self.manifest) for of in ("stress", "displacement")]
        self.stress = Stress(meshes[0], data)
        self.lower = self.stress.bound()
        self.displacement = Displacement(meshes[1], data)
        self.upper = self.displacement.bound(self.stress.extra)
        self.premises = list(dict.fromkeys(p for mesh in meshes for p in mesh.premises))
        if meshes[0].names != meshes[1].names or len(meshes[0].points) != len(meshes[1].points):
            self.premises.append("the two bounds come from two meshes of the same bodies")
        if any(self.manifest["origin"]):
            self.premises.append("coordinates of the mesh count from {} and were rounded there".format(self.manifest["origin"]))
        source = "the polygons of the scene" if self.scene.polygons else "its file, with the boundaries that it names"
        self.premises.append(f"the bodies are the triangles in the proof, which hypercircle made from {source}")
        self.claim = [Fraction(self.manifest["claim"][end]) for end in ("lower", "upper")]

    def against_claim(self):
        if self.lower > self.upper:
            raise Refused("the lower bound lies above the upper one: the proof is not of one scene")
        allowed = max(self.claim[1] - self.claim[0], 0) * PART
        for end, found, claimed, sign in (("lower", self.lower, self.claim[0], 1), ("upper", self.upper, self.claim[1], -1)):
            if sign * (found - claimed) < -allowed:
                short = float(abs(found - claimed))
                raise Refused(f"the {end} bound {float(claimed)!r} is claimed, and only {float(found)!r} is proved, {short:.2e} from it")
        self.proved = [min(self.lower, self.claim[0]), max(self.upper, self.claim[1])]
        self.room = [float(self.lower - self.claim[0]), float(self.claim[1] - self.upper)]


def _report(folder, proof):
    """The report beside the proof must claim what the proof claims."""
    file = folder / "report.json"
    if not file.is_file():
        return
    try:
        energy = json.loads(file.read_text())["energy"]
        shown = [Fraction(energy["lower"]), Fraction(energy["upper"])]
    except (ValueError, KeyError, TypeError, OSError) as error:
        raise Refused(f"{file} cannot be read: {error}") from None
    for end, inside, outside in zip(("lower", "upper"), shown, proof.claim):
        if inside != outside:
            raise Refused(f"report.json has the {end} bound {float(inside)!r}, and the proof is of {float(outside)!r}")


def _same(what, path, hashes):
    try:
        own = hashlib.sha256(Path(path).read_bytes()).hexdigest()
    except OSError as error:
        raise Refused(f"{path} cannot be read: {error}") from None
    if own not in hashes:
        raise Refused(f"{path} is not the {what} of the proof")


def check(folder, scene=None, meshes=()):
    """Verifies a folder or a file; returns the Proof or raises Refused."""
    folder = Path(folder)
    path = folder if folder.is_file() else folder / "proof.npz"
    proof = Proof(read(path))
    if scene:
        _same("scene", scene, [proof.manifest["scene_sha256"]])
    for mesh in meshes:
        _same("mesh file", mesh, [m["sha256"] for m in proof.manifest["mesh_files"]])
    if not folder.is_file():
        _report(folder, proof)
    proof.against_claim()
    return proof


def outwards(ends):
    """Doubles that enclose two fractions."""
    lower, upper = (float(x) for x in ends)
    return lower if lower <= ends[0] else np.nextafter(lower, -np.inf), upper if upper >= ends[1] else np.nextafter(upper, np.inf)


def main(arguments=None):
    parser = argparse.ArgumentParser(prog="hypercircle-check", description="Verifies the bracket of a hypercircle report in exact arithmetic. Exits with 0 if it is proved, 1 if not.")
    parser.add_argument("folder", help="folder of a report with proof.npz, or the file itself")
    parser.add_argument("--scene", metavar="FILE", help="also require that this is the scene of the proof")
    parser.add_argument("--mesh", metavar="FILE", action="append", default=[], help="also require that this is a mesh file of the proof; may be repeated")
    parser.add_argument("--json", action="store_true", help="print the result as JSON")
    parser.add_argument("--version", action="version", version=f"hypercircle-check {VERSION}")
    given = parser.parse_args(arguments)
    start = time.monotonic()
    try:
        proof = check(given.folder, given.scene, given.mesh)
    except Refused as failed:
        if given.json:
            print(json.dumps({"proved": False, "reason": str(failed), "by": f"hypercircle-check {VERSION}"}))
        else:
            print(f"not proved: {failed}.")
        return 1
    lower, upper = outwards(proof.proved)
    if given.json:
        result = {"proved": True, "lower": lower, "upper": upper, "room": proof.room, "premises": proof.premises}
        print(json.dumps({**result, "by": f"hypercircle-check {VERSION}"}))
        return 0
    print(f"proved: the exact energy of {proof.manifest['scene']} lies between {lower!r} and {upper!r}.")
    told = lambda room: f"{room:.1e} inside what is claimed" if room >= 0 else f"{-room:.1e} OUTSIDE what is claimed"
    print(f"  lower bound: stress in exact equilibrium on {len(proof.stress.mesh.triangles)} triangles, {told(proof.room[0])}")
    print(f"  upper bound: admissible displacement on {len(proof.displacement.mesh.triangles)} triangles, {told(proof.room[1])}")
    for premise in proof.premises:
        print(f"  premise: {premise}")
    print(f"  scene: sha256 {proof.manifest['scene_sha256']}")
    for file in proof.manifest["mesh_files"]:
        print(f"  mesh: {file['name']}, sha256 {file['sha256']}")
    print(f"  {time.monotonic() - start:.1f} s")
    return 0


if __name__ == "__main__":
    sys.exit(main())
