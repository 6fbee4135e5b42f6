"""Verifies the energy bracket of a plane contact problem from the file `proof.npz` of a hypercircle report.

The theorem. Bodies with compliance a are loaded by F and P, held by u = u0 on clamped edges and u.n = u0 on rollers, and touch along
contacts where (v' - v'').n <= g. For every displacement v that meets supports and contacts, and every stress s with div s + F = 0,
s.n = P, no traction across the direction of a roller or a contact, and t <= 0 there (t: the traction of the first side along n),

    -1/2 int a s:s + int_supports (s.n).u0 + int_contacts t g  <=  energy  <=  1/2 int c e(v):e(v) - int F.v - int P.v.

(Add 1/2 int a (c e(v) - s):(c e(v) - s) >= 0 and int (-t) (g - (v' - v'').n) >= 0; integrate by parts.)

The proof file gives candidates for s and v in floating point. `lower` and `upper` turn them into admissible fields, exactly, by changes
of the size of rounding errors, and enclose their energies; a candidate that needs more than that is refused.
"""

VERSION = "0.1.0"


class Refused(Exception):
    """What failed, in one sentence."""
