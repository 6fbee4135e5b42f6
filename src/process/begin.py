import sys

sys.path[:] = [folder for folder in sys.path if folder not in ("", ".")]

import os
import threading


def end_with_parent():
    """End with the process that started this one, seen by the end of standard input."""
    while os.read(0, 4096):
        pass
    os._exit(3)


parent = os.getppid()
try:
    import ctypes

    # A library that lets no other thread run is ended by the kernel: PR_SET_PDEATHSIG, SIGKILL.
    ctypes.CDLL(None).prctl(1, 9, 0, 0, 0)
except (ImportError, OSError, AttributeError):
    pass
if os.getppid() != parent:
    os._exit(3)
# Of several ranks the first one alone has the standard input.
if os.environ.get("OMPI_COMM_WORLD_RANK", os.environ.get("PMI_RANK", "0")) == "0":
    threading.Thread(target=end_with_parent, daemon=True).start()
