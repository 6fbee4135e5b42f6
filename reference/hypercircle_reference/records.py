"""Values of a JSON file as arrays, once their shape and numbers were checked; :class:`BadExchange` names the key that is wrong."""

from __future__ import annotations

import numpy as np

from hypercircle_process import BadExchange


def get(data, key: str, where: str = ""):
    """The value under ``key`` of a JSON object."""
    if not isinstance(data, dict) or key not in data:
        raise BadExchange(f"{where + '.' if where else ''}{key} is missing")
    return data[key]


def records(data: dict, key: str, where: str = "") -> list[dict]:
    """A list of JSON objects under ``key``."""
    path = f"{where}.{key}" if where else key
    entries = get(data, key, where)
    if not isinstance(entries, list) or not all(isinstance(entry, dict) for entry in entries):
        raise BadExchange(f"{path} must be a list of objects")
    return entries


def as_array(values, where: str, shape: tuple, kind: str) -> np.ndarray:
    """An array of ``shape``, -1 being any length: finite floats (``kind`` "f") or int64 ("i")."""
    try:
        array = np.array(values)
    except ValueError as error:
        raise BadExchange(f"{where} is ragged: {error}") from error
    if array.size == 0 and shape[:1] in ((-1,), (0,)):
        return np.zeros((0, *shape[1:]), dtype=np.int64 if kind == "i" else np.float64)
    allowed = "iu" if kind == "i" else "iuf"
    if array.dtype.kind not in allowed:
        raise BadExchange(f"{where} must hold {'whole ' if kind == 'i' else ''}numbers only")
    if array.ndim != len(shape) or any(want not in (-1, have) for want, have in zip(shape, array.shape)):
        raise BadExchange(f"{where} has shape {list(array.shape)}, expected {list(shape)} (-1: any)")
    if kind == "f" and not np.all(np.isfinite(array)):
        raise BadExchange(f"{where} holds a number that is not finite")
    return array.astype(np.int64 if kind == "i" else np.float64)


def array(data, key, where, shape):
    """An array of floats under ``key`` of the entry ``where``."""
    return as_array(get(data, key, where), f"{where}.{key}", shape, "f")


def numbers(data, key, shape):
    """An array of floats under a key of the file."""
    return as_array(get(data, key), key, shape, "f")


def scalar(data, key, where) -> float:
    """A finite number."""
    return float(as_array(get(data, key, where.rpartition(".")[0]), where, (), "f"))


def indices(data, key, shape, count):
    """An array of indices below ``count`` under a key of the file."""
    return in_range(as_array(get(data, key), key, shape, "i"), key, count, 0)


def column(entries, where, key, shape):
    """One array of floats of ``key`` of all entries."""
    values = [get(entry, key, f"{where}[{i}]") for i, entry in enumerate(entries)]
    return as_array(values, f"{where}[..].{key}", (len(entries), *shape), "f")


def index_column(entries, where, key, shape, count, lowest=0):
    """One array of indices of ``key`` of all entries, from ``lowest`` to below ``count``."""
    values = [get(entry, key, f"{where}[{i}]") for i, entry in enumerate(entries)]
    path = f"{where}[..].{key}"
    return in_range(as_array(values, path, (len(entries), *shape), "i"), path, count, lowest)


def in_range(array, where, count, lowest):
    """The array, once its indices lie from ``lowest`` to below ``count``."""
    if array.size and (array.min() < lowest or array.max() >= count):
        raise BadExchange(f"{where} holds an index outside 0..{count - 1}")
    return array
