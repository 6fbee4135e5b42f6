"""The hybrid form of the stress problem on PETSc, over MPI ranks.

The package reads the element matrices that the caller wrote, solves min ½ xᵀKx − fᵀx over edge moments x whose jumps on
the contact are bounded, and writes the mode parameters of the stresses. Data travels
``exchange → distribution → model → solvers → contact → refinement → run → exchange``; ``compat`` holds every call to PETSc
whose spelling or options depend on its release. How it fails and ends is that of ``hypercircle_process``.
docs/exchange.md describes the files.
"""
