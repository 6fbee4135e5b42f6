"""The results that are handed back, ``primal-P*.json``."""

from __future__ import annotations

import json
import os
import tempfile
from pathlib import Path

from hypercircle_process import Failure


def write_result(path: Path, result: dict) -> None:
    """Write one result file whole or not at all: a temporary file in the same folder, then a rename."""
    try:
        text = json.dumps(result, allow_nan=False)
    except ValueError as error:
        raise Failure("the solution holds a number that is not finite; nothing was written") from error
    path.parent.mkdir(parents=True, exist_ok=True)
    handle, temporary = tempfile.mkstemp(dir=path.parent, prefix=path.name, suffix=".part")
    try:
        with os.fdopen(handle, "w", encoding="utf-8") as stream:
            stream.write(text)
        os.replace(temporary, path)
    except BaseException:
        os.unlink(temporary)
        raise
