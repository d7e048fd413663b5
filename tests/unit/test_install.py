"""What `make` shows of pip's work."""

import subprocess
import sys

import pytest

from tools.install import WIDTH, main, step_of


@pytest.mark.parametrize(
    ("line", "step"),
    [
        ("Collecting numpy==2.4.6 (from -c constraints.txt (line 3))", "looking for numpy==2.4.6"),
        ("  Downloading numpy-2.4.6.whl (16 MB)", "downloading numpy-2.4.6.whl (16 MB)"),
        ("Installing collected packages: a, b, c", "installing 3 packages"),
        ("  Installing build dependencies: started", None),
        ("Requirement already satisfied: pip", None),
        ("WARNING: something about an index", None),
        ("", None),
    ],
)
def test_steps(line, step):
    assert step_of(line) == step


def test_steps_are_short():
    assert len(step_of("Collecting " + 500 * "a")) == WIDTH


def test_what_pip_says_is_shown_where_it_fails(capfd):
    assert main(["--no-index", "--editable", "/nowhere"]) != 0
    shown = capfd.readouterr()
    assert shown.out.startswith("installing ninefold and its dependencies into ")
    assert "/nowhere" in shown.err


def test_success_ends_with_the_time(capfd, monkeypatch):
    pip = subprocess.Popen
    done = [sys.executable, "-c", "print('Installing collected packages: a, b')"]
    monkeypatch.setattr(subprocess, "Popen", lambda command, **options: pip(done, **options))
    assert main(["--editable", "."]) == 0
    first, second, last = capfd.readouterr().out.splitlines()
    assert first.startswith("installing ninefold")
    assert second == "  installing 2 packages"
    assert last.startswith("installed in ")
