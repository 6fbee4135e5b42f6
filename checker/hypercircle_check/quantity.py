"""Intervals of mean displacements, where energies are quadratic functions of the loads: without contact.

E(w), the exact energy with w times a load q added to the loads, is E(0) - w q(u) - w^2 C / 2, so that E(-w) - E(w) = 2 w q(u). Brackets of both energies,
from the fields of the scene plus and minus w times those of the problem with the load q alone, enclose q(u); the best w makes the width that
of the theorem of Prager and Synge.
"""

import numpy as np

from . import Refused
from .exact import length, lower, rational, upper
from .lower import Stress
from .mesh import Mesh
from .upper import Displacement

FIELDS = {"tractions": "traction_counts", "u_vertices": None, "u_edges": "u_edge_counts", "u_inside": "displacement_degrees"}


def interval(data, manifest, scene, index):
    """(name, interval that is proved, interval that is claimed) of a quantity of the manifest; None where the scene has no such mean."""
    claim = manifest["quantities"][index]
    found = [q for q in scene.raw.get("quantities", []) if q.get("name") == claim["name"]]
    step = rational(claim["step"])
    # Fields are those of a load along a unit vector, and directions of any length.
    direction = found[0].get("direction") if found else None
    along = length([rational(x) for x in direction or (0, 0)])
    pull = rational(float(step) / float(along)) if along > 0 else step
    if len(found) != 1 or step <= 0 or (found and scene.pulled(found[0], pull) is None):
        raise Refused(f"the quantity '{claim['name']}' of the proof is no mean displacement of the scene that can be verified")
    own, bounds = {name: data[f"quantity{index}_{name}"] for name in FIELDS}, []
    for of in ("stress_degrees", *(counts for counts in FIELDS.values() if counts)):
        if not np.array_equal(data[of], data[f"quantity{index}_{of}"]):
            raise Refused(f"the fields of the quantity '{claim['name']}' are of other degrees than those of the scene")
    for sign in (1, -1):
        pulled = scene.pulled(found[0], sign * pull)
        both = data | {name: data[name] + sign * float(step) * own[name] for name in FIELDS}
        meshes = [Mesh(data, of, pulled, manifest) for of in ("stress", "displacement")]
        stress, displacement = Stress(meshes[0], both), Displacement(meshes[1], both)
        bounds.append((stress.bound(), displacement.bound(stress.extra)))
    on, mesh = found[0]["displacement"], meshes[0]
    if on in scene.laws:
        size = sum(mesh.shape(t)[1] for t in range(len(mesh.triangles)) if mesh.body(t) == on) / 2
    else:
        size = sum(length(mesh.normal(e)) for e, name in enumerate(mesh.names) if name == on and mesh.owners[e, 1] < 0)
    weight = 2 * pull * scene.thickness * size * along
    (low, high), (back_low, back_high) = bounds
    ends = [lower((back_low - high) / weight), upper((back_high - low) / weight)]
    if not (ends[0] <= claim["upper"] and ends[1] >= claim["lower"]):
        raise Refused(f"the quantity '{claim['name']}' lies between {float(ends[0])!r} and {float(ends[1])!r}, and the report claims otherwise")
    return claim["name"], ends, [claim["lower"], claim["upper"]]
