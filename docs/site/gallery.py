"""Makes what the pages of docs/gallery show: what the command of each prints, and the pictures of its report.

usage: gallery.py PROGRAM FOLDER

A page NAME.md has a line `command: hypercircle ...` between two lines of dashes at its top. In FOLDER/NAME are then `printed.txt`, a session of a
terminal; the figures of the report that the page shows, as ID.svg; and `report.html`.
"""

import os
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
FIGURE = r'<figure id="{}".*?(<svg .*?</svg>)'


def command(page):
    """The command of a page of the gallery."""
    found = re.match(r"---\ncommand: (hypercircle .*)\n---\n", page.read_text(encoding="utf-8"))
    if not found:
        sys.exit(f"{page} does not begin with a line `command: hypercircle ...` between two lines of dashes")
    return found[1]


def figures(page):
    """The names of the figures that a page shows."""
    return sorted(set(re.findall(rf"/made/{page.stem}/([\w-]+)\.svg", page.read_text(encoding="utf-8"))))


def make(page, program, folder):
    """Runs the command of a page and keeps what the page shows of it."""
    line = command(page)
    folder.mkdir(parents=True)
    (folder / "cases").symlink_to(ROOT / "cases")
    environment = os.environ | {"PATH": f"{program.parent}:{os.environ['PATH']}"}
    run = subprocess.run(line, shell=True, cwd=folder, env=environment, capture_output=True, text=True)
    printed = run.stdout + run.stderr
    if run.returncode != 0:
        sys.exit(f"{page}: `{line}` ended with {run.returncode}:\n{printed}")
    (folder / "printed.txt").write_text(f"$ {line}\n{printed}", encoding="utf-8")
    report = (folder / re.search(r"^report: (.*)$", printed, re.MULTILINE)[1]).read_text(encoding="utf-8")
    for name in figures(page):
        picture = re.search(FIGURE.format(re.escape(name)), report, re.DOTALL)
        if not picture:
            there = ", ".join(re.findall(r'<figure id="([^"]*)"', report))
            sys.exit(f"{page} shows the figure `{name}`, and the report of `{line}` has {there}")
        (folder / f"{name}.svg").write_text(picture[1], encoding="utf-8")
    (folder / "report.html").write_text(report, encoding="utf-8")


def main():
    program, folder = (Path(name).resolve() for name in sys.argv[1:])
    for page in sorted((ROOT / "docs/gallery").glob("*.md")):
        if page.stem != "index":
            make(page, program, folder / page.stem)


if __name__ == "__main__":
    main()
