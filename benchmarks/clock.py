"""Timing and tables: the best of a few runs, set-up outside the clock."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

__all__ = ["best", "row", "title"]


def best(job: Callable[[], Any], repeat: int = 3) -> float:
    """Seconds of the fastest of `repeat` runs."""
    times = []
    for _ in range(repeat):
        begin = time.perf_counter()
        job()
        times.append(time.perf_counter() - begin)
    return min(times)


def title(name: str, *columns: str) -> None:
    print(f"\n{name:54}" + "".join(f"{column:>14}" for column in columns), flush=True)


def row(name: str, *cells: Any) -> None:
    print(f"{name:54}" + "".join(f"{cell!s:>14}" for cell in cells), flush=True)
