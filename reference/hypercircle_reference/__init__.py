"""Displacement model of plane frictionless contact, the reference the stress solution is compared with.

The package reads ``problem.json``, minimises the potential energy 𝓛 over continuous displacements of degree k
with FEniCSx and PETSc, and writes ``primal-P1.json``, ``primal-P2.json``, …. Data travels
``exchange → lattice → builder → inside → constraints → model → descent → solve → exchange``; ``compat`` holds every call
that depends on the DOLFINx release. How it fails and ends is that of ``hypercircle_process``.
"""

HIGHEST_DEGREE = 9
"""Beyond, nodes at equal steps lose digits."""
