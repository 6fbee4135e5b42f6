"""Displacement model of plane frictionless contact, the reference the stress solution is compared with.

The package reads ``problem.json``, minimises the potential energy 𝓛 over continuous P1 or P2 displacements with
FEniCSx and PETSc, and writes ``primal-P1.json`` or ``primal-P2.json``. Data travels
``exchange → constraints → model → descent → solve → exchange``; ``compat`` holds every call that depends on the DOLFINx
release. How it fails and ends is that of ``hypercircle_process``.
"""
