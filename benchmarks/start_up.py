"""Whole processes, from the shell's point of view: how long until the answer is there.

*Warm* is a machine on which the kernels were compiled before; *cold* starts with an empty cache of compiled kernels. The
seconds of processor time beside the wall clock tell how far a busy machine spoiled the latter.
"""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from benchmarks.clock import row, title
from benchmarks.networks import uniform
from ninefold.io import write_network

RUNS = 7
COLD_RUNS = 3
PROGRAM = str(Path(sys.executable).with_name("ninefold"))
ROOT = str(Path(__file__).parents[1])


def relate_a_thousand_sets() -> None:
    """Make a map and relate 1,000 of its sets; what a cold process is timed with."""
    import numpy as np

    from benchmarks.worlds import Discs
    from ninefold.reasoner import relate_all

    discs, rng = Discs(3000), np.random.default_rng(0)
    relate_all([discs.region(rng, 20, 0.4)[0] for _ in range(1000)])


def run(command: list[str], folder: str, cache: str) -> tuple[float, float]:
    """Run a process; return its seconds on the wall clock and of processor time."""
    environment = {**os.environ, "NUMBA_CACHE_DIR": cache, "PYTHONPATH": ROOT}
    begin = time.perf_counter()
    process = subprocess.Popen(command, cwd=folder, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    errors = process.stderr.read() if process.stderr else b""
    _, status, usage = os.wait4(process.pid, 0)
    seconds = time.perf_counter() - begin
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode not in (0, 1):  # 1: the answer is no
        raise RuntimeError(f"{' '.join(command)} ended with {process.returncode}: {errors.decode()}")
    return seconds, usage.ru_utime + usage.ru_stime


def show(name: str, runs: list[tuple[float, float]], asked: str) -> None:
    wall, processor = zip(*runs, strict=True)
    row(name, f"{statistics.median(wall):.2f} s", f"{min(wall):.2f} s", f"{min(processor):.2f} s", asked)


def main() -> None:
    with tempfile.TemporaryDirectory() as folder:
        for name, net in (
            ("100.csp", uniform(100, 12, 4, hard=False)),  # inconsistent; closure says so
            ("50.csp", uniform(50, 9, 2, hard=False)),  # consistent
            ("hard.csp", uniform(150, 16, 0, hard=True)),
        ):
            write_network(net, Path(folder) / name)
        python = [sys.executable, "-c"]
        thousand = [*python, "from benchmarks.start_up import relate_a_thousand_sets as run; run()"]
        relate = [PROGRAM, "relate", "demo-out/district.atlas", "block 1", "street Bulevardi"]
        check = [PROGRAM, "check", "100.csp"]
        warm = str(Path(folder) / "cache")
        for command in (
            [PROGRAM, "demo", "--pairs", "500"],
            thousand,
            [PROGRAM, "check", "hard.csp"],
            [*python, "import numba"],
        ):
            run(command, folder, warm)

        title("whole process, warm", "median", "best", "processor", "asked")
        for name, command, asked in (
            ("python -c 'import numpy'", [*python, "import numpy"], "-"),
            ("python -c 'import numba'", [*python, "import numba"], "-"),
            ("ninefold --help", [PROGRAM, "--help"], "0.4 s"),
            ("ninefold relate, demo atlas", relate, "0.8 s"),
            ("ninefold info, demo atlas", [PROGRAM, "info", "demo-out/district.atlas"], "-"),
            ("ninefold check, 100 entities, minimal conflict", check, "0.8 s"),
            ("the same with --json --budget 20", [*check, "--json", "--budget", "20"], "0.8 s"),
            ("ninefold check, hard network", [PROGRAM, "check", "hard.csp"], "-"),
            ("relate_all, 1,000 sets, map included", thousand, "-"),
        ):
            show(name, [run(command, folder, warm) for _ in range(RUNS)], asked)

        title("whole process, no kernel compiled before", "median", "best", "processor", "asked")
        for name, command, asked in (
            ("ninefold relate, demo atlas", relate, "1 s"),
            ("ninefold check, 50 entities", [PROGRAM, "check", "50.csp"], "2 s"),
            ("relate_all, 1,000 sets, map included", thousand, "4 s"),
            ("ninefold check, hard network", [PROGRAM, "check", "hard.csp"], "8 s"),
            ("ninefold demo", [PROGRAM, "demo"], "10 s"),
        ):
            show(name, [run(command, folder, str(Path(folder) / f"{name}-{k}")) for k in range(COLD_RUNS)], asked)


if __name__ == "__main__":
    main()
