"""Every snippet of the documents runs: Python blocks as one session a file, console blocks with their output compared.

A ``python`` block may hold doctest prompts (compared) or plain statements (run). In a ``console`` block each line starting
with ``$ ninefold`` is run in the file's own folder and what follows must be its output; ``...`` stands for anything.
"""

import doctest
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
FILES = sorted([*ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md")])
FENCE = re.compile(r"^```(python|console)\n(.*?)^```", re.MULTILINE | re.DOTALL)
LOOSE = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE


def snippets(file):
    text = file.read_text("utf-8")
    return [(m[1], m[2], text[: m.start()].count("\n") + 1) for m in FENCE.finditer(text)]


def run_python(code, session, name, line):
    if ">>>" not in code:
        exec(compile("\n" * line + code, name, "exec"), session)
        return
    test = doctest.DocTestParser().get_doctest(code, session, name, name, line)
    out = []
    runner = doctest.DocTestRunner(optionflags=LOOSE)
    runner.run(test, out=out.append, clear_globs=False)
    session.update(test.globs)
    assert not runner.failures, "".join(out)


def run_console(text, folder):
    for part in re.split(r"^\$ ", text, flags=re.MULTILINE)[1:]:
        command, _, expected = part.partition("\n")
        if not command.startswith("ninefold"):
            continue
        done = subprocess.run(
            f"{Path(sys.executable).parent}/{command}", shell=True, cwd=folder, capture_output=True, text=True, timeout=300,
            env={**os.environ, "COLUMNS": "120", "NO_COLOR": "1"},
        )  # fmt: skip
        got = done.stdout if done.returncode == 0 else done.stdout + done.stderr
        assert done.returncode in (0, 1) or "ninefold:" in expected, (command, done.stderr)
        if expected.strip():
            assert doctest.OutputChecker().check_output(expected, got, LOOSE), f"$ {command}\n{got}"


@pytest.mark.parametrize("file", [f for f in FILES if snippets(f)], ids=lambda f: str(f.relative_to(ROOT)))
def test_snippets_run(file, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    session = {"__name__": "__main__"}
    for kind, code, line in snippets(file):
        if kind == "python":
            run_python(code, session, str(file.relative_to(ROOT)), line)
        else:
            run_console(code, tmp_path)


def test_links_between_documents_lead_somewhere():
    for file in FILES:
        for target in re.findall(r"\]\(([^)#\s]+)(?:#[^)]*)?\)", file.read_text("utf-8")):
            if not target.startswith(("http:", "https:", "mailto:")):
                assert (file.parent / target).exists(), f"{file.name}: {target}"
