"""Whole processes, from the shell's point of view: how long until the answer is there."""

from __future__ import annotations

import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from benchmarks.clock import row, title

RUNS = 7


def main() -> None:
    program = str(Path(sys.executable).with_name("ninefold"))
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([program, "demo", "--pairs", "500"], cwd=folder, check=True, capture_output=True)
        atlas = "demo-out/district.atlas"
        title("whole process", "median", "best", "asked")
        for name, arguments, asked in (
            ("python -c 'import numpy'", None, "-"),
            ("ninefold --help", ["--help"], "0.4 s"),
            ("ninefold relate, demo atlas", ["relate", atlas, "block 1", "street Bulevardi"], "0.8 s"),
            ("ninefold info, demo atlas", ["info", atlas], "-"),
        ):
            command = [sys.executable, "-c", "import numpy"] if arguments is None else [program, *arguments]
            times = []
            for _ in range(RUNS):
                begin = time.perf_counter()
                subprocess.run(command, cwd=folder, check=True, capture_output=True)
                times.append(time.perf_counter() - begin)
            row(name, f"{statistics.median(times):.2f} s", f"{min(times):.2f} s", asked)


if __name__ == "__main__":
    main()
