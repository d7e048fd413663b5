"""What the numbers of a plane map number: types that a checker tells apart and that are plain ints when the code runs.

Names are for people, numbers index the arrays of one map. Dart ``d`` is a directed half of edge ``d // 2``, its twin is
``d ^ 1``. Face numbers live as long as the map; vertex and edge numbers follow the order of the names.

Examples
--------
>>> from ninefold.mapping import Dart, PlaneMap
>>> path = PlaneMap.from_rotation({"a": ["b"], "b": ["a", "c"], "c": ["b"]})
>>> path.darts_at(path.vertex("b").index)
[1, 2]
>>> Dart(1) == 1
True
"""

from __future__ import annotations

from typing import NewType

__all__ = ["Dart", "Edge", "Face", "Vertex"]

Vertex = NewType("Vertex", int)
"""A vertex of a map, from 0 to ``n_vertices - 1``."""

Dart = NewType("Dart", int)
"""A directed half of an edge, from 0 to ``2 * tether.size - 1``."""

Edge = NewType("Edge", int)
"""An edge of a map, tethers included, from 0 to ``tether.size - 1``."""

Face = NewType("Face", int)
"""A face of a map, from 0 to ``n_faces - 1``, numbered by its lowest dart."""
