"""A writer that is killed loses at most the event in flight; an atlas being made is there whole or not at all."""

from __future__ import annotations

import random
import signal
import subprocess
import sys
import time

import pytest

from ninefold.io import Atlas, read_walk, samples
from ninefold.io.walks.json_lines import write_walk
from ninefold.mapping import build
from ninefold.mapping.robot.mapper import Mapper
from ninefold.mapping.robot.simulated import explore

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="SIGKILL is a Unix thing")

WRITER = """
import os, sys
from ninefold.io import Atlas, read_walk
events = read_walk(sys.argv[2]).events
os.write(1, b"ready\\n")
with Atlas.open(sys.argv[1]) as atlas:
    for event in events[atlas.n_events:]:
        atlas.append(event)
        os.write(1, b"%d\\n" % atlas.n_events)
"""

MAKER = """
import os, sys
from ninefold.io import Atlas, read_walk
walk = read_walk(sys.argv[2])
os.write(1, b"ready\\n")
Atlas.from_walk(walk, sys.argv[1]).close()
"""

KILLS = 25


@pytest.fixture(scope="module")
def log(tmp_path_factory):
    """A long walk in a file."""
    path = tmp_path_factory.mktemp("log") / "walk.jsonl"
    write_walk(explore(samples.load("helsinki_district").to_world(), seed=8, step=10.0).walk, path)
    return path


def killed(program, path, log, *, after=0, delay):
    """Run a program, kill it `delay` seconds after the line number `after` past "ready", and return the lines it got out."""
    with subprocess.Popen([sys.executable, "-c", program, path, log], stdout=subprocess.PIPE) as writer:
        assert writer.stdout.readline() == b"ready\n"
        lines = [line for _ in range(after) if (line := writer.stdout.readline())]
        time.sleep(delay)
        writer.kill()
        lines += writer.stdout.read().splitlines(keepends=True)
    assert writer.returncode in (-signal.SIGKILL, 0)
    return [line[:-1] for line in lines if line.endswith(b"\n")], writer.returncode == 0


def test_killing_the_writer_loses_at_most_the_event_in_flight(tmp_path, log):
    path = tmp_path / "live.atlas"
    walk = read_walk(log)
    Atlas.create(path, header=walk.header).close()
    rng = random.Random(4)
    stored, follower, interrupted = 0, Mapper(walk.header), 0
    for _ in range(KILLS):
        # by what was written, not by the clock: a quick writer and a slow one are both caught on the way
        few = rng.randint(1, len(walk.events) // (2 * KILLS))
        lines, finished = killed(WRITER, path, log, after=few, delay=rng.uniform(0.0, 0.003))
        interrupted += not finished
        reported = int(lines[-1]) if lines else stored
        with Atlas.open(path) as atlas:
            found = atlas.n_events
            assert reported <= found <= reported + 1
            for event in walk.events[stored:found]:
                follower.step(event)
            if found:
                assert atlas.plane == follower.plane
                atlas.plane.validate()
            assert atlas.walk.events == walk.events[:found]
        stored = found
    assert interrupted > KILLS // 2, "the writer was too quick to be killed"
    assert stored > KILLS, "the writer was killed before it got anywhere"


def test_killing_the_maker_leaves_the_old_file_or_the_new_one(tmp_path, log):
    whole = build(read_walk(log))
    rng = random.Random(6)
    outcomes = set()
    for k in range(8):
        path = tmp_path / f"{k}.atlas"
        _, finished = killed(MAKER, path, log, delay=0.0 if k == 0 else rng.uniform(0.0, 0.25))
        outcomes.add(finished)
        if path.exists():
            with Atlas.open(path) as atlas:
                assert atlas.plane == whole
        else:
            assert not finished
    assert False in outcomes
