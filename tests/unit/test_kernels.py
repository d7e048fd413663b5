"""Plain or compiled: which form runs, what is said, what is cached, and that small work never loads numba."""

import os
import subprocess
import sys

import numpy as np
import pytest

from ninefold import _kernels
from ninefold._kernels import kernel, seconds_to_compiled


def fresh(*, cached, compile_seconds=5.0):
    """A kernel of which it is known whether it was compiled before."""

    def total(a):
        s = 0
        for i in range(a.size):
            s += a[i]
        return s

    made = kernel(total, compile_seconds=compile_seconds)
    made.__dict__["is_cached"] = cached
    return made


def steps(seconds):
    return int(seconds / _kernels.STEP_SECONDS)


@pytest.fixture(autouse=True)
def nothing_said_before():
    _kernels._say_once.cache_clear()


def test_seconds_to_compiled():
    cold = seconds_to_compiled(numba_loaded=False, cached=False, compile_seconds=5)
    warm = seconds_to_compiled(numba_loaded=False, cached=True, compile_seconds=5)
    loaded = seconds_to_compiled(numba_loaded=True, cached=True, compile_seconds=5)
    assert cold == _kernels.IMPORT_SECONDS + 5
    assert warm == _kernels.IMPORT_SECONDS + _kernels.LOAD_SECONDS
    assert loaded == _kernels.LOAD_SECONDS


@pytest.mark.parametrize("loaded", [False, True])
@pytest.mark.parametrize("cached", [False, True])
def test_small_work_stays_plain_and_large_work_is_compiled(monkeypatch, cached, loaded):
    pytest.importorskip("numba")
    monkeypatch.setattr(_kernels, "_numba_is_loaded", lambda: loaded)
    wait = seconds_to_compiled(numba_loaded=loaded, cached=cached, compile_seconds=5)
    made = fresh(cached=cached)
    assert made.for_work(steps(0.9 * wait)) is made.plain
    other = fresh(cached=cached)
    assert other.for_work(steps(1.1 * wait)) is other.compiled


def test_much_small_work_is_large_work(monkeypatch):
    monkeypatch.setattr(_kernels, "_numba_is_loaded", lambda: True)
    made = fresh(cached=False)
    forms = [made.for_work(steps(1.1)) is made.plain for _ in range(5)]
    assert forms == [True, True, True, True, False]
    assert made.for_work(1) is made.compiled  # what is there is used


def test_a_long_compilation_is_said_once(capsys):
    assert fresh(cached=False, compile_seconds=9).compiled
    assert fresh(cached=False, compile_seconds=9).compiled
    assert capsys.readouterr().err == "ninefold: compiling kernels for this machine, once (about 9 s) ...\n"


def test_a_short_compilation_or_a_cached_one_is_not_said(capsys):
    assert fresh(cached=False, compile_seconds=0.5).compiled
    assert fresh(cached=True, compile_seconds=9).compiled
    assert capsys.readouterr().err == ""


def made_with(constant):
    scope = {"kernel": kernel, "STEP": constant, "__name__": "made"}
    exec("@kernel\ndef inner(x):\n    return x + STEP\n@kernel\ndef outer(x):\n    return inner(x)\n", scope)
    return scope["outer"]


def test_a_constant_of_a_callee_changes_the_name_in_the_cache():
    names = {made_with(x).fingerprint for x in (1, 2, 1.5, np.uint64(1), np.uint64(2))}
    assert len(names) == 5
    assert made_with(np.uint64(7)).fingerprint == made_with(np.uint64(7)).fingerprint


MODULE = """
import numpy as np
from ninefold._kernels import kernel

@kernel
def inner(x, y):
    return x * {factor} + y

@kernel
def outer(small, large):
    return inner(small[0], 1) + inner(large[0], small[0]) + inner(1, 2) + inner(large[0], True)

def result():
    return int(outer.compiled(np.ones(1, np.int16), np.ones(1, np.int64)))
"""


def run(code, folder, cache):
    environment = {**os.environ, "NUMBA_CACHE_DIR": str(cache), "PYTHONPATH": os.pathsep.join([str(folder), *sys.path])}
    done = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout.split("\n")[-2]


def test_kernels_are_found_in_the_cache_and_a_changed_callee_is_compiled_anew(tmp_path):
    module, cache = tmp_path / "loops.py", tmp_path / "cache"
    module.write_text(MODULE.format(factor=2))
    ask = "import sys, loops; before = loops.outer.is_cached, 'numba' in sys.modules; print(before, loops.result())"
    assert run(ask, tmp_path, cache) == "(False, False) 13"
    assert run(ask, tmp_path, cache) == "(True, False) 13"
    module.write_text(MODULE.format(factor=3))
    assert run(ask, tmp_path, cache) == "(False, False) 17"


def test_a_callee_is_compiled_for_one_width_of_integers(tmp_path):
    (tmp_path / "loops.py").write_text(MODULE.format(factor=2))
    counted = run("import loops; loops.result(); print(len(loops.inner.callee.signatures))", tmp_path, tmp_path / "cache")
    assert counted == "2"  # the last argument of one call is a truth value, and no integer


def inconsistent_network():
    """A hundred entities, six statements each, labels at random: closure finds a contradiction."""
    rng = np.random.default_rng(4)
    lines = ["100 # random"]
    names = ("DC", "EC", "PO", "TPP", "NTPP", "TPPI", "NTPPI", "EQ")
    for i in range(100):
        for j in sorted(set(rng.integers(i + 1, 100, 6).tolist())) if i < 99 else ():
            label = [name for name in names if rng.random() < 0.5] or ["DC"]
            lines.append(f" {i} {j} ( {' '.join(label)} )")
    return "\n".join([*lines, ".", ""])


def test_a_small_check_never_loads_numba(tmp_path):
    (tmp_path / "net.csp").write_text(inconsistent_network())
    ask = (
        "import sys; from ninefold.cli import run; codes = [run(['check', 'net.csp', *more]) for more in"
        " ([], ['--json', '--budget', '20'])]; print(); print(codes, 'numba' in sys.modules)"
    )
    ask = f"import os; os.chdir({str(tmp_path)!r}); {ask}"
    for _ in range(2):
        assert run(ask, tmp_path, tmp_path / "cache") == "[1, 1] False"


def test_the_demo_and_its_atlas_never_load_numba(tmp_path):
    ask = (
        f"import os, sys; os.chdir({str(tmp_path)!r}); from ninefold.cli import run;"
        " codes = [run(['demo', '--pairs', '200']),"
        " run(['relate', 'demo-out/district.atlas', 'block 1', 'street Bulevardi'])];"
        " print(); print(codes, 'numba' in sys.modules)"
    )
    assert run(ask, tmp_path, tmp_path / "cache") == "[0, 0] False"


def test_a_table_of_a_hundred_sets_never_loads_numba(tmp_path):
    ask = (
        "import sys, numpy as np; from ninefold.mapping import PlaneMap; from ninefold.reasoner import relate_all;"
        "xy = [(x, y) for x in range(12) for y in range(12)];"
        "edges = [(k, k + 1) for k in range(143) if k % 12 != 11] + [(k, k + 12) for k in range(132)];"
        "plane = PlaneMap.from_geometry(xy, edges); sets = [plane.face(f) for f in range(1, 121)];"
        "codes = relate_all(sets); print(codes.shape, 'numba' in sys.modules)"
    )
    assert run(ask, tmp_path, tmp_path / "cache") == "(120, 120) False"
