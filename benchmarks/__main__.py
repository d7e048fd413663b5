"""Run the benchmarks, all or those named: ``python -m benchmarks [plane_map relate ...]``."""

from __future__ import annotations

import importlib
import pkgutil
import sys

import benchmarks

TOOLS = {"__main__", "clock", "worlds"}


def main(names: list[str]) -> int:
    known = [module.name for module in pkgutil.iter_modules(benchmarks.__path__) if module.name not in TOOLS]
    for name in names:
        if name not in known:
            print(f"there is no benchmark {name!r}; there are {', '.join(known)}", file=sys.stderr)
            return 2
    for name in names or known:
        print(f"\n== {name}", flush=True)
        importlib.import_module(f"benchmarks.{name}").main()
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
