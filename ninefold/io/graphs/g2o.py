"""Pose graphs in the plane, ``.g2o``.

::

    VERTEX_SE2 0 0 0 0
    VERTEX_SE2 1 1.03 0.01 -0.02
    EDGE_SE2 0 1 1.03 0.01 -0.02 500 0 0 500 0 5000

A vertex is a pose: number, x, y, yaw. An edge measures the second pose in the frame of the first; after that comes how sure
it is, the upper triangle of the information matrix, row by row. Edges between a pose and the next are odometry, all others
loop closures; if two edges join a pose and the next, the first is odometry. Vertices need not be listed. Other lines
(``FIX``, landmarks, comments) are passed over and kept.

References
----------
R. Kuemmerle, G. Grisetti, H. Strasdat, K. Konolige and W. Burgard, "g2o: a general framework for graph optimization",
ICRA 2011.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ninefold._files import published, shown
from ninefold._wording import quoted
from ninefold.errors import BadInput

from ..formats import recognise

if TYPE_CHECKING:
    from collections.abc import Iterable
    from os import PathLike

    from numpy.typing import NDArray

__all__ = ["PoseGraph", "read_pose_graph", "write_without"]

_INTEGER = re.compile(r"[+-]?\d{1,18}")
LARGEST = 1e9
"""Metres or radians of a measurement at most."""


@dataclass(frozen=True, slots=True, eq=False)
class PoseGraph:
    """A pose graph of V poses and E edges.

    Attributes
    ----------
    name
        What to call it in messages.
    lines
        The file, line by line, with the ends of lines.
    poses
        (V,) int64, the numbers of the poses, ascending.
    first, second
        (E,) int64, the ends of every edge, counted in `poses`.
    measured
        (E, 3) float64: the second pose in the frame of the first: x, y in metres, yaw in radians.
    covariance
        (E, 3, 3) float64, the inverse of the information matrix.
    line
        (E,) int64, the line of every edge, counted from 0.
    odometry
        (E,) bool, whether it joins a pose and the next.
    """

    name: str
    lines: tuple[bytes, ...] = field(repr=False)
    poses: NDArray[np.int64] = field(repr=False)
    first: NDArray[np.int64] = field(repr=False)
    second: NDArray[np.int64] = field(repr=False)
    measured: NDArray[np.float64] = field(repr=False)
    covariance: NDArray[np.float64] = field(repr=False)
    line: NDArray[np.int64] = field(repr=False)
    odometry: NDArray[np.bool_] = field(repr=False)

    @property
    def closures(self) -> NDArray[np.int64]:
        """The edges that are loop closures, ascending."""
        return np.flatnonzero(~self.odometry)


def read_pose_graph(path: str | PathLike[str]) -> PoseGraph:
    """Read a pose graph.

    Raises
    ------
    BadInput
        For a file that cannot be read or is none, with the line that is wrong: too few numbers, one that is none or is not
        finite, an edge from a pose to itself, an information matrix that is not positive definite, a graph in space.
    """
    recognise(path, "graph")
    try:
        content = Path(path).read_bytes()
    except OSError as error:
        raise BadInput(f"{shown(path)}: cannot be read ({error.strerror or error})") from None
    return parse(content, str(path))


def parse(content: bytes, name: str) -> PoseGraph:
    """Read a pose graph from the bytes of a file; see `read_pose_graph`."""
    lines = tuple(content.splitlines(keepends=True))
    listed: list[int] = []
    ends: list[tuple[int, int]] = []
    numbers: list[list[float]] = []
    at: list[int] = []
    for row, line in enumerate(lines):
        words = line.decode("utf-8", "replace").removeprefix("\ufeff").split()
        if not words:
            continue
        where = f"{shown(name)}, line {row + 1}"
        match words[0]:
            case "VERTEX_SE2":
                _fields(words, 5, where)
                listed.append(_integer(words[1], where))
                for word in words[2:5]:
                    _number(word, where)
            case "EDGE_SE2":
                _fields(words, 12, where)
                a, b = _integer(words[1], where), _integer(words[2], where)
                if a == b:
                    raise BadInput(f"{where}: an edge from pose {a} to itself")
                ends.append((a, b))
                numbers.append([_number(word, where) for word in words[3:12]])
                at.append(row)
            case "EDGE_SE3:QUAT" | "VERTEX_SE3:QUAT":
                raise BadInput(f"{where}: {words[0]}; this graph is in space, and only those in the plane (SE2) are read")
            case _:
                continue
    if not ends:
        raise BadInput(f"{shown(name)}: no EDGE_SE2 line, so there is no odometry and no loop closure to judge")
    return _graph(name, lines, listed, ends, np.array(numbers), np.array(at, np.int64))


def _graph(
    name: str,
    lines: tuple[bytes, ...],
    listed: list[int],
    ends: list[tuple[int, int]],
    numbers: NDArray[np.float64],
    at: NDArray[np.int64],
) -> PoseGraph:
    pairs = np.array(ends, np.int64)
    poses = np.unique(np.concatenate([pairs.reshape(-1), np.array(listed, np.int64)]))
    first, second = np.searchsorted(poses, pairs[:, 0]), np.searchsorted(poses, pairs[:, 1])
    information = np.empty((len(pairs), 3, 3))
    rows, columns = np.triu_indices(3)
    information[:, rows, columns] = numbers[:, 3:]
    information[:, columns, rows] = numbers[:, 3:]
    smallest = np.linalg.eigvalsh(information)[:, 0]
    largest = np.abs(information).max(axis=(1, 2))
    wrong = np.flatnonzero(~(smallest > 1e-12 * np.maximum(largest, 1e-300)) | (largest < 1e-12))
    if wrong.size:
        raise BadInput(
            f"{shown(name)}, line {at[wrong[0]] + 1}: the information matrix is not positive definite, so it does not say "
            "how sure the measurement is"
        )
    odometry = np.zeros(len(pairs), np.bool_)
    low = np.minimum(first, second)
    beside = np.flatnonzero(np.abs(first - second) == 1)
    beside = beside[np.abs(pairs[beside, 0] - pairs[beside, 1]) == 1]  # numbers one apart, not neighbours in the list
    odometry[beside[np.unique(low[beside], return_index=True)[1]]] = True
    covariance = np.asarray(np.linalg.inv(information), np.float64)
    return PoseGraph(name, lines, poses, first, second, numbers[:, :3], covariance, at, odometry)


def write_without(graph: PoseGraph, edges: Iterable[int], path: str | PathLike[str], *, force: bool = False) -> None:
    """Write the file again without the lines of some edges; every other line is kept to the byte."""
    gone = {int(graph.line[edge]) for edge in edges}
    with published(path, force=force) as temporary:
        temporary.write_bytes(b"".join(line for row, line in enumerate(graph.lines) if row not in gone))


def _fields(words: list[str], count: int, where: str) -> None:
    if len(words) < count:
        raise BadInput(f"{where}: {words[0]} with {len(words) - 1} numbers; it takes {count - 1}")


def _integer(word: str, where: str) -> int:
    if not _INTEGER.fullmatch(word):
        raise BadInput(f"{where}: {quoted(word)} is no number of a pose")
    return int(word)


def _number(word: str, where: str) -> float:
    try:
        value = float(word)
    except ValueError:
        raise BadInput(f"{where}: {quoted(word)} is no number") from None
    if not abs(value) < LARGEST * LARGEST:
        raise BadInput(f"{where}: {quoted(word)} is too large or not finite")
    return value
