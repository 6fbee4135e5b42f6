"""Where a fault can be put."""

import sys

NO_PLACE = 9


def no_place():
    """Ends the run: the scene has no place for the fault."""
    sys.exit(NO_PLACE)


def pick(rng, items):
    """One of `items`."""
    return rng.choice(items) if items else no_place()
