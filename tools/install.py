"""Install a package with pip and show in a few lines what is going on; `make` runs it.

Run it by the Python of the environment: ``python tools/install.py --constraint constraints.txt --editable .``. On a terminal
one line tells which package pip is at; in a log the steps that take long have a line each. Pip's own output is shown in full
where it fails.
"""

from __future__ import annotations

import subprocess
import sys
import time

STEPS = {"Collecting": "looking for", "Downloading": "downloading", "Building": "building", "Installing": "installing"}
WIDTH = 100


def step_of(line: str) -> str | None:
    """Return a line of pip in short words, or None where it is no step of its own."""
    word, _, rest = line.strip().partition(" ")
    if word not in STEPS or not rest:
        return None
    if word == "Installing":
        if not rest.startswith("collected packages:"):
            return None
        rest = f"{rest.count(',') + 1} packages"
    elif word == "Collecting":
        rest = rest.partition(" (from")[0]
    return f"{STEPS[word]} {rest}"[:WIDTH]


def main(arguments: list[str]) -> int:
    begin = time.monotonic()
    print(f"installing ninefold and its dependencies into {sys.prefix} ...", flush=True)
    command = [sys.executable, "-m", "pip", "--disable-pip-version-check", "install", "--progress-bar", "off", *arguments]
    terminal = sys.stdout.isatty()
    said = []
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace") as pip:
        for line in pip.stdout or ():
            said.append(line)
            step = step_of(line)
            if step is None:
                continue
            if terminal:
                print(f"\r\x1b[2K  {step}", end="", flush=True)
            elif not step.startswith("looking for"):
                print(f"  {step}", flush=True)
    if terminal:
        print("\r\x1b[2K", end="", flush=True)
    if pip.returncode:
        print("".join(said), file=sys.stderr)
        return pip.returncode
    print(f"installed in {time.monotonic() - begin:.0f} s", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
