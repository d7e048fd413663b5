"""Pose graphs: reading .g2o, judging closures, `ninefold claims`."""

from __future__ import annotations

import json
from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st
from pose_graphs import pose_graph

from ninefold.cli import run
from ninefold.errors import BadInput, NinefoldError
from ninefold.io import judge_closures, read_pose_graph, samples
from ninefold.io.graphs.g2o import parse, write_without

SURE = "1e4 0 0 1e4 0 1e6"
SQUARE = [f"EDGE_SE2 {k} {k + 1} 10 0 1.5707963267948966 {SURE}" for k in range(4)]


@pytest.fixture
def square(tmp_path, monkeypatch):
    """Once around a square, pose 4 being pose 0 again; a right closure, and one that says pose 3 is pose 0."""
    monkeypatch.chdir(tmp_path)
    lines = [
        "# a comment",
        "FIX 0",
        "VERTEX_SE2 0 0 0 0",
        *SQUARE,
        f"EDGE_SE2 0 4 0.01 0 0 {SURE}",
        f"EDGE_SE2 0 3 0 0 0 {SURE}",
        "EDGE_SE2_XY 0 7 1 1 1 0 1",
    ]
    Path("square.g2o").write_bytes(("\r\n".join(lines) + "\r\n").encode())
    return "square.g2o"


def answer(capsys, *words):
    code = run([*words])
    printed = capsys.readouterr()
    return code, printed.out, printed.err


def test_a_graph_is_read(square):
    graph = read_pose_graph(square)
    assert graph.poses.tolist() == [0, 1, 2, 3, 4]
    assert graph.odometry.tolist() == [True] * 4 + [False] * 2
    assert graph.closures.tolist() == [4, 5]
    assert graph.measured[0].tolist() == [10, 0, pytest.approx(np.pi / 2)]
    assert np.allclose(graph.covariance[0], np.diag([1e-4, 1e-4, 1e-6]))
    assert graph.line.tolist() == [3, 4, 5, 6, 7, 8]


def test_the_command_names_what_cannot_be_and_writes_the_rest_to_the_byte(square, capsys):
    code, out, _ = answer(capsys, "claims", square, "-o", "clean.g2o")
    assert code == 1
    assert "square.g2o: 5 poses, 2 closures, 1 cannot be right" in out
    assert (
        "line 9, 0 - 3: the odometry between its poses says otherwise: the loop comes back 10 m off and turned by 90 deg"
        in out
    )
    before, after = Path(square).read_bytes().splitlines(True), Path("clean.g2o").read_bytes().splitlines(True)
    assert after == before[:8] + before[9:]
    code, out, _ = answer(capsys, "claims", "clean.g2o", "--json")
    assert code == 0
    assert json.loads(out)["rejected"] == []
    assert answer(capsys, "claims", square, "-o", "clean.g2o")[0] == 2
    assert answer(capsys, "claims", square, "-o", "clean.g2o", "--force")[0] == 1


def test_json_has_the_keys_of_the_contract(square, capsys):
    code, out, _ = answer(capsys, "claims", square, "--json")
    found = json.loads(out)
    assert code == 1
    (one,) = found["rejected"]
    assert (one["a"], one["b"], one["score"], one["line"], one["against"]) == (0, 3, 1.0, 9, None)
    assert one["reason"]
    assert (found["poses"], found["closures"], found["silent"], found["out"]) == (5, 2, 0, None)


def test_the_wrong_files_are_refused(square, capsys, tmp_path):
    Path("walk.jsonl").write_text('{"ninefold": "walk", "version": 1, "heading": "yaw-rad"}\n')
    code, _, err = answer(capsys, "claims", "walk.jsonl")
    assert code == 2
    assert "walk.jsonl: this is a walk log, not a pose graph" in err
    code, _, err = answer(capsys, "claims", "nowhere.g2o", "--json")
    assert code == 2
    assert err.count("\n") == 1
    code, _, err = answer(capsys, "info", square)
    assert code == 2
    assert "this is a pose graph" in err
    assert "ninefold claims square.g2o" in err


@pytest.mark.parametrize(
    ("line", "says"),
    [
        ("EDGE_SE2 0 1 1 2 3", "line 1: EDGE_SE2 with 5 numbers; it takes 11"),
        (f"EDGE_SE2 0 x 1 2 3 {SURE}", "line 1: 'x' is no number of a pose"),
        (f"EDGE_SE2 0 1 1 nan 3 {SURE}", "line 1: 'nan' is too large or not finite"),
        (f"EDGE_SE2 0 1 1 1e300 3 {SURE}", "line 1: '1e300' is too large"),
        (f"EDGE_SE2 0 1 1 one 3 {SURE}", "line 1: 'one' is no number"),
        (f"EDGE_SE2 3 3 1 2 3 {SURE}", "line 1: an edge from pose 3 to itself"),
        ("EDGE_SE2 0 1 1 2 3 1 0 0 1 0 0", "line 1: the information matrix is not positive definite"),
        ("EDGE_SE2 0 1 1 2 3 1 5 0 1 0 1", "line 1: the information matrix is not positive definite"),
        ("VERTEX_SE2 0 1 2", "line 1: VERTEX_SE2 with 3 numbers; it takes 4"),
        ("VERTEX_SE2 0 1 2 3", "no EDGE_SE2 line"),
        ("VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1", "line 1: VERTEX_SE3:QUAT; this graph is in space"),
    ],
)
def test_a_bad_line_is_named(line, says):
    with pytest.raises(BadInput, match=f"^x.g2o.*{says}") as caught:
        parse((line + "\n").encode(), "x.g2o")
    assert "\n" not in str(caught.value)


tokens = st.sampled_from(["0", "1", "2", "3", "-1", "1e9", "nan", "inf", "1e-9", "x", "", "99999999999999999999", "5"])
graph_lines = st.builds(
    lambda tag, words: " ".join([tag, *words]),
    st.sampled_from(["EDGE_SE2", "EDGE_SE2", "VERTEX_SE2", "FIX", "EDGE_SE3:QUAT", "#"]),
    st.lists(tokens, max_size=13),
)
whole_lines = st.builds(
    lambda a, b, x, y, t, i: f"EDGE_SE2 {a} {b} {x!r} {y!r} {t!r} {i!r} 0 0 {i!r} 0 {i!r}",
    st.integers(0, 9),
    st.integers(0, 9),
    *[st.floats(allow_nan=False) | st.floats(-9, 9)] * 3,
    st.floats(1e-300, 1e300) | st.floats(0.1, 1e6),
)


@settings(max_examples=300, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(lines=st.lists(graph_lines | whole_lines, max_size=12), junk=st.binary(max_size=20), headings_only=st.booleans())
@example(lines=[*SQUARE[:2], *["EDGE_SE2 1 0 0 94906266 0 1 0 0 1 0 1"] * 2], junk=b"", headings_only=False)
@example(lines=[*SQUARE[:2], *["EDGE_SE2 0 1 0 4129696645 0 1 0 0 1 0 1"] * 2], junk=b"", headings_only=False)
def test_whatever_a_file_holds_only_our_errors_escape(lines, junk, headings_only):
    for head in ([], SQUARE):
        for content in ("\n".join(head + lines).encode() + junk, junk + "\n".join(head + lines).encode()):
            with suppress(NinefoldError):
                judged = judge_closures(parse(content, "x.g2o"), headings_only=headings_only)
                assert len(judged.rejected) <= judged.graph.closures.size


@pytest.mark.parametrize("seed", range(3))
def test_wrong_closures_of_a_drive_through_a_district_are_found(tmp_path, seed):
    lines, bad = pose_graph(samples.load("helsinki_district").to_world(), seed=seed, wrong=20)
    (tmp_path / "drive.g2o").write_text("\n".join(lines) + "\n")
    graph = read_pose_graph(tmp_path / "drive.g2o")
    judged = judge_closures(graph)
    assert {(one.a, one.b) for one in judged.rejected} == bad
    assert judged.silent == 0
    write_without(graph, [one.edge for one in judged.rejected], tmp_path / "clean.g2o")
    kept = (tmp_path / "clean.g2o").read_text().splitlines()
    assert kept == [line for line in lines if not any(line.startswith(f"EDGE_SE2 {a} {b} ") for a, b in bad)]


@pytest.mark.parametrize("seed", range(4))
def test_right_closures_stay_where_errors_are_as_declared(tmp_path, seed):
    lines, _ = pose_graph(samples.load("office").to_world(), seed=seed, odometry=(0.1, 0.01), closing=(0.1, 0.01), step=1.0)
    graph = parse("\n".join(lines).encode(), "office.g2o")
    assert judge_closures(graph).rejected == ()
    assert judge_closures(graph, headings_only=True).rejected == ()


def test_headings_alone_find_what_is_turned_and_nothing_else():
    half = [*SQUARE, f"EDGE_SE2 0 4 0 0 1 {SURE}"]
    far = [*SQUARE, f"EDGE_SE2 0 4 30 0 0 {SURE}"]
    for lines, found in ((half, 1), (far, 0)):
        judged = judge_closures(parse("\n".join(lines).encode(), "x.g2o"), headings_only=True)
        assert len(judged.rejected) == found
    assert len(judge_closures(parse("\n".join(far).encode(), "x.g2o")).rejected) == 1


def test_the_expected_miss_of_a_loop_is_what_noise_gives():
    """The squared miss in standard deviations of many loops has the mean that three degrees of freedom have."""
    from ninefold.io.graphs import closures

    rng = np.random.default_rng(0)
    alone, pairs = [], []
    for _ in range(200):
        turn = rng.uniform(-1, 1, 12)
        true = [(0j, 0.0)]
        for t in turn:
            true.append((true[-1][0] + np.exp(1j * true[-1][1]) * 3, true[-1][1] + t))
        lines = []
        for a, b in [*((k, k + 1) for k in range(12)), (1, 9), (3, 12)]:
            (p, yaw), (q, after) = true[a], true[b]
            back = rng.random() < 0.5  # measured the other way round
            if back:
                (p, yaw), (q, after), a, b = (q, after), (p, yaw), b, a
            away = np.exp(-1j * yaw) * (q - p)
            x, y, z = np.array([away.real, away.imag, after - yaw]) + rng.normal(0, (0.02, 0.01, 0.004))
            lines.append(f"EDGE_SE2 {a} {b} {x} {y} {z} {0.02**-2} 0 0 {0.01**-2} 0 {0.004**-2}")
        judge = closures.judge_of(parse("\n".join(lines).encode(), "x.g2o"))
        alone += judge.alone().ratio.tolist()
        pairs += judge.with_another(0, np.array([1])).ratio.tolist()
    assert np.mean(alone) == pytest.approx(3, abs=0.35)
    assert 1 < np.mean(pairs) < 3.4  # odometry in both stretches counts double, which can only make less of a miss


def test_a_break_in_the_odometry_leaves_pairs_of_closures():
    other = [line.replace(f"EDGE_SE2 {k} {k + 1}", f"EDGE_SE2 {k + 10} {k + 11}") for k, line in enumerate(SQUARE)]
    across = [f"EDGE_SE2 {k} {k + 10} 0 0 0 {SURE}" for k in range(3)] + [f"EDGE_SE2 3 13 5 0 0 {SURE}"]
    judged = judge_closures(parse("\n".join([*SQUARE, *other, *across]).encode(), "x.g2o"))
    assert [(one.a, one.b) for one in judged.rejected] == [(3, 13)]
    assert "it contradicts 3 closures that are kept" in judged.rejected[0].reason
    lonely = judge_closures(parse("\n".join([*SQUARE, *other, across[0]]).encode(), "x.g2o"))
    assert (lonely.rejected, lonely.silent) == ((), 1)


def test_a_graph_without_closures_has_nothing_to_judge():
    judged = judge_closures(parse("\n".join(SQUARE).encode(), "x.g2o"))
    assert (judged.rejected, judged.silent, judged.exact) == ((), 0, True)


def test_closures_that_clash_at_random_are_told_apart_within_a_budget(tmp_path, capsys):
    """Two robots whose closures are noise: to find the fewest to reject is hard, and a budget ends it."""
    rng = np.random.default_rng(0)
    lines = [f"EDGE_SE2 {k + s} {k + s + 1} 1 0 0 1e4 0 0 1e4 0 1e4" for s in (0, 1000) for k in range(200)]
    lines += [
        f"EDGE_SE2 {k} {1000 + k} {rng.normal(0, 2)} {rng.normal(0, 2)} 0 40 0 0 40 0 1e4" for k in rng.permutation(200)
    ]
    (tmp_path / "noise.g2o").write_text("\n".join(lines) + "\n")
    code, out, err = answer(capsys, "claims", str(tmp_path / "noise.g2o"), "--budget", "0.2", "--json")
    found = json.loads(out)
    assert code == 3
    assert not found["exact"]
    assert "the budget is spent" in err
    graph = read_pose_graph(tmp_path / "noise.g2o")
    gone = {(one["a"], one["b"]) for one in found["rejected"]}
    kept = [line for line in lines if (int(line.split()[1]), int(line.split()[2])) not in gone]
    assert judge_closures(parse("\n".join(kept).encode(), "x.g2o")).rejected == ()  # what is left agrees
    assert len(kept) < len(graph.lines)
