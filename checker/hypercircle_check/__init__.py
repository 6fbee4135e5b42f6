"""Verifies the energy bracket of a plane contact problem from the file `proof.npz` of a hypercircle report.

The theorem. Bodies with the law e = a s + e0 are loaded by F and P, held by u = u0 on clamped edges and u.n = u0 on rollers, stand on springs or
are joined by layers of stiffness k along n, and touch along contacts where j = (v' - v'').n <= g, or push with k (j - g) beyond. Where contacts
have friction, sliding by i = (v' - v'').m, with m at right angles to n, is resisted by up to r. For every displacement v that meets supports
and rigid contacts, and every stress s with div s + F = 0, s.n = P, the same traction on both sides of what joins bodies, none across the
direction of a roller or a contact, t <= 0 there (t: the traction of the first side along n), and |q| <= r (q: along m; 0 without friction),

    -1/2 int a s:s - int s:e0 + int_supports (s.n).u0 + int_contacts t g - int_elastic t^2 / (2 k)
        <=  energy  <=  1/2 int c (e(v) - e0):(e(v) - e0) - int F.v - int P.v + int_springs k j^2 / 2 + int_elastic k max(0, j - g)^2 / 2
                        + int_contacts r |i|.

(Their difference is 1/2 int a d:d with d = c (e(v) - e0) - s, and int (-t) (g - j) >= 0, int (k j + t)^2 / (2 k), for elastic contact
k d^2 / 2 + t^2 / (2 k) - (-t) (j - g) >= 0 with d = max(0, j - g), and for friction int r |i| + q i >= 0: integrate by parts.)

The proof file gives candidates for s and v in floating point. `lower` and `upper` turn them into admissible fields, exactly, by changes
of the size of rounding errors, and enclose their energies; a candidate that needs more than that is refused.

To read in this order: `exact` (numbers), `material` and `scene` (what is asked), `mesh` (where it holds), `reference` (fields on one triangle),
`lower`, `upper`, `quantity`, `main`.
"""

VERSION = "0.2.0"


class Refused(Exception):
    """The failed check, in one sentence."""
