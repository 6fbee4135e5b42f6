"""Loads meshio without what it has for its command line and for messages in colour, which takes longer to load than all else."""

import re
import sys
import types


class Console:
    """Messages to standard error, as those of `rich` are, and plain."""

    def __init__(self, **_):
        pass

    def print(self, text, **_):
        print(re.sub(r"\[/?(?:bold|red|yellow)\]", "", text), file=sys.stderr)


def load_meshio():
    """The module; ImportError where there is none."""
    left_out = {
        "rich": {},
        "rich.console": {"Console": Console},
        "meshio._cli": {},
        # The version is written to files, and nothing is written here.
        "meshio.__about__": {"__version__": ""},
    }
    for name, content in left_out.items():
        sys.modules[name] = types.ModuleType(name)
        vars(sys.modules[name]).update(content)
    import meshio

    return meshio
