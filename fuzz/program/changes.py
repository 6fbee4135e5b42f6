"""Changes of bytes, of text with numbers and names in it, of TOML by line and table, and of JSON by value."""

import json
import re

NUMBERS = [
    "0", "-0.0", "1", "-1", "2", "3", "0.5", "0.49999999999", "1e-300", "-1e-300", "1e300", "-1e300", "1e308", "5e-324", "1e-10",
    "1e10", "-1e10", "1e999", "nan", "-inf", "inf", "9223372036854775807", "-9223372036854775808", "18446744073709551616",
    "4294967296", "1_000", "0x10", "true", "1979-05-27", '"1"', "[]", "{}",
]
NAMES = [
    '""', '" "', '"."', '".."', '"/"', '"../../up"', '"a|b"', '"rigid"', '"<b>&amp;"', '"\\u001b[31m"', '"\\u202e"', '"\\u0000"',
    '"é\\u0301漢字🙂"', '"@user #1 http://x.y `code` | * _"', '"' + "x" * 3000 + '"', "'''\nlines\n'''", "0", "[]",
]
TOKENS = [b"[", b"]", b"[[", b"{", b"}", b"=", b'"', b"#", b"\n", b"\r\n", b"\0", b"\xff\xfe", b"\xef\xbb\xbf", b"\xe2\x80\xae", b"..", b","]
KEYS = {
    "[bodies": [
        "orthotropic = { young = [2.0, 1.0, 1.5], poisson = [0.3, 0.2, 0.25], shear = 0.5, angle = 30.0 }", "angle = 45.0",
        "stiffness = [[2.0, 0.5, 0.0], [0.5, 1.0, 0.0], [0.0, 0.0, 0.4]]", "compliance = [[1.0, -0.3, 0.0], [-0.3, 1.0, 0.0], [0.0, 0.0, 3.0]]",
        "expansion = 0.01", "expansion = [0.01, 0.02, 0.0]", "temperature = 2.0", "temperature = { value = 1.0, gradient = [0.5, -1.0] }",
        "initial_stress = [0.1, -0.2, 0.05]", "initial_stress = [0.1, 0.0, 0.0, 0.3]", "young = [1.0, 2.0]",
        "body_force = { value = [0.0, -1.0], gradient = [[0.1, 0.0], [0.3, 0.2]] }", "rotation = { density = 1.0, omega = 0.5, about = [0.5, 0.0] }",
    ],
    "[[supports]]": [
        'type = "spring"', "stiffness = 10.0", "stiffness = [10.0, 3.0]", "stiffness = [[1.0, 2.0], 3.0]", "direction = [1.0, 0.0]",
        "displacement = -0.01", "displacement = { value = [0.0, 0.0], gradient = [[0.01, 0.0], [0.0, 0.0]] }",
    ],
    "[[bonds]]": ["stiffness = [10.0, 3.0]", "stiffness = [[1.0, 2.0], [3.0, 4.0]]", "direction = [0.0, -1.0]"],
    "[[contacts]]": [
        "stiffness = 10.0", "stiffness = 1e-6", "stiffness = 1e9", "stiffness = [1.0, 2.0]", "gap = [0.0, 0.1]", "gap = -0.01",
        "gap = { parabola = 2.0, at = 0.5 }", "direction = [1.0, 0.0]", 'normals = "facets"', "move = [0.0, 0.02]",
        "obstacle = { line = [[-1.0, 0.0], [1.0, 0.0]] }",
    ],
    "[model]": ['kinematics = "axisymmetric"', 'kinematics = "plane-stress"', "thickness = 0.5"],
}
"""Keys of each kind of table, as somebody adds them."""
NUMBER = re.compile(r"[-+]?\d[\d_]*(?:\.\d+)?(?:[eE][-+]?\d+)?")
STRING = re.compile(r'"[^"\n]*"')


def in_bytes(data, random, other=b""):
    """Some bits, bytes or pieces of `data` changed; parts of `other` may come in."""
    data = bytearray(data)
    for _ in range(random.choice([1, 1, 1, 2, 4, 16])):
        if not data:
            break
        at = random.randrange(len(data))
        end = at + random.choice([1, 2, 4, 8, 40])
        kind = random.randrange(7)
        if kind == 0:
            data[at] ^= 1 << random.randrange(8)
        elif kind == 1:
            data[at] = random.randrange(256)
        elif kind == 2:
            del data[at:end]
        elif kind == 3:
            data[at:at] = data[at:end]
        elif kind == 4:
            data[at:at] = random.choice(TOKENS)
        elif kind == 5 and other:
            start = random.randrange(len(other))
            data[at:end] = other[start:start + random.randrange(1, 200)]
        else:
            del data[at:]
    return bytes(data)


def _replaced(text, pattern, choose, random):
    found = list(pattern.finditer(text))
    if not found:
        return text
    match = random.choice(found)
    return text[:match.start()] + choose(match.group()) + text[match.end():]


def _near(number, random):
    """A number that is not far, so that what it says stays plausible."""
    try:
        value = float(number.replace("_", ""))
    except ValueError:
        return number
    if value.is_integer() and abs(value) < 1e18 and "." not in number and random.random() < 0.5:
        return str(int(value) + random.choice([-1, 1, 2]))
    factor = random.choice([-1, 0.5, 2, 1 + 1e-9, 1 - 1e-7, 1.01, 0.1, 10, 1e3, 1e-3])
    return repr(random.choice([value * factor, value + random.choice([1e-9, 0.1, -0.25, 1, -1]), value // 1]))


def in_text(text, random):
    """A number or a string replaced by another one, near or extreme."""
    kind = random.randrange(9)
    if kind <= 4:
        return _replaced(text, NUMBER, lambda old: _near(old, random), random)
    if kind <= 6:
        return _replaced(text, NUMBER, lambda _: random.choice(NUMBERS), random)
    if kind == 7:
        return _replaced(text, STRING, lambda _: random.choice(NAMES), random)
    # A name for another one: conditions that contradict each other, sides in contact with themselves.
    others = STRING.findall(text) or ['""']
    return _replaced(text, STRING, lambda _: random.choice(others), random)


def in_lines(text, random, other):
    """Lines and tables left out, doubled, exchanged, or taken from `other`."""
    by_table = random.random() < 0.4
    split = (lambda t: re.split(r"(?m)^(?=\[)", t)) if by_table else (lambda t: t.splitlines(keepends=True))
    parts = split(text) or [""]
    at, to = random.randrange(len(parts)), random.randrange(len(parts))
    kind = random.randrange(5)
    if kind == 0:
        del parts[at]
    elif kind == 1:
        parts.insert(to, parts[at])
    elif kind == 2:
        parts[at], parts[to] = parts[to], parts[at]
    else:
        parts[to:to + (kind == 3)] = [random.choice(split(other) or [""])]
    return "".join(parts)


def scene(data, random, other):
    """A scene that is mostly still TOML."""
    for _ in range(random.choice([1, 1, 1, 2, 2, 3, 5])):
        kind = random.random()
        if kind < 0.08:
            data = in_bytes(data, random, other)
            continue
        text, more = data.decode(errors="replace"), other.decode(errors="replace")
        text = in_text(text, random) if kind < 0.7 else with_key(text, random) if kind < 0.85 else in_lines(text, random, more)
        data = text.encode(errors="replace")
    return data


def with_key(text, random):
    """A key more in one of the tables that have it; in the place of the one of that name where there is one."""
    places = [(start, m) for start in KEYS for m in re.finditer(r"(?m)^" + re.escape(start) + r".*\n(?:(?!\[).*\n)*", text)]
    if not places:
        return text
    start, table = random.choice(places)
    line = random.choice(KEYS[start])
    name = line.split(" = ")[0]
    body, count = re.subn(r"(?m)^" + name + r" = .*$", lambda _: line, table.group())
    return text[:table.start()] + (body if count else table.group().rstrip("\n") + "\n" + line + "\n\n") + text[table.end():]


def file(data, random, other):
    """A mesh or a field: text by numbers and lines, anything by bytes."""
    for _ in range(random.choice([1, 1, 2, 3])):
        if b"\0" in data or random.random() < 0.15:
            data = in_bytes(data, random, other)
        elif random.random() < 0.8:
            data = in_text(data.decode(errors="replace"), random).encode(errors="replace")
        else:
            data = in_lines(data.decode(errors="replace"), random, other.decode(errors="replace")).encode(errors="replace")
    return data


VALUES = [None, True, 0, -1, 1, 2, 1e308, -1e308, 5e-324, 1e-9, float("nan"), float("inf"), 2**63, -(2**31), "", "x" * 3000, "\x1b[31m", [], {}]


def in_json(value, random):
    """One value somewhere in `value` replaced, left out or doubled, mostly a number by another one; in place."""
    only_numbers = random.random() < 0.7
    while value:
        key = random.choice(list(value) if isinstance(value, dict) else range(len(value)))
        here = value[key]
        if isinstance(here, (list, dict)) and here and (only_numbers or random.random() < 0.8):
            value = here
        elif isinstance(here, float) and (only_numbers or random.random() < 0.5):
            value[key] = random.choice([here * random.choice([-1, 0, 1 + 1e-9, 1.01, 1e3, 1e200]), 0.0, 1e308, -1e308, 5e-324])
            return
        elif only_numbers:
            return
        elif random.random() < 0.2:
            del value[key]
            return
        elif isinstance(value, list) and random.random() < 0.3:
            value.append(here)
            return
        else:
            value[key] = random.choice(VALUES)
            return


def result(value, random):
    """The text of a JSON file in which something is changed; sometimes it is no JSON any more."""
    for _ in range(random.choice([0, 0, 1, 1, 2, 4])):
        in_json(value, random)
    text = json.dumps(value).encode()
    return in_bytes(text, random) if random.random() < 0.1 else text
