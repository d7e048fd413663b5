"""Interchange with networkx, and the graph questions that networkx answers.

networkx orders a ``PlanarEmbedding`` clockwise; it is converted here, on the way in and out. networkx is imported at the
first call, so that maps load fast.
"""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from ninefold._wording import quoted
from ninefold.errors import BadInput

from .numbering import Edge, Vertex
from .select import darts_between
from .sets import Line, Point, same_map

if TYPE_CHECKING:
    from .plane import PlaneMap

__all__ = ["bridges", "cut_vertices", "rotation_of_embedding", "shortest_path", "to_networkx"]


def rotation_of_embedding(graph: Any) -> dict[str | int, list[str]]:
    """Return the neighbours of every node of a ``networkx.PlanarEmbedding``, counter-clockwise, nodes named by ``str``.

    Raises
    ------
    BadInput
        For a graph that is no embedding, or nodes of equal names.
    """
    import networkx as nx

    if not isinstance(graph, nx.PlanarEmbedding):
        raise BadInput(
            f"a {type(graph).__name__} has no rotation system; pass a networkx.PlanarEmbedding, for instance from "
            "networkx.check_planarity"
        )
    rotation: dict[str | int, list[str]] = {str(v): [str(w) for w in graph.neighbors_cw_order(v)][::-1] for v in graph}
    if len(rotation) != len(graph):
        raise BadInput("two nodes have the same name once they are read as strings; relabel the graph")
    return rotation


def to_networkx(plane: PlaneMap, kind: str = "multigraph") -> Any:
    """Export a plane map.

    Parameters
    ----------
    kind
        ``"multigraph"``: a ``networkx.MultiGraph`` with the edge names as keys and no tether. ``"embedding"``: a
        ``networkx.PlanarEmbedding``, which knows neither parallel edges, loops nor tethers.

    Raises
    ------
    BadInput
        For an embedding of a map that has any of those.
    """
    import networkx as nx

    names = plane.vertex_names
    ends = plane.tail.reshape(-1, 2)
    if kind == "multigraph":
        graph = nx.MultiGraph()
        graph.add_nodes_from(names)
        for e in np.flatnonzero(~plane.tether).tolist():
            graph.add_edge(names[int(ends[e, 0])], names[int(ends[e, 1])], key=plane.edge_names[e])
        return graph
    if kind != "embedding":
        raise BadInput(f"kind is 'multigraph' or 'embedding', not {quoted(kind)}")
    ordered = np.sort(ends, axis=1)
    if plane.tether.any() or len(np.unique(ordered, axis=0)) < len(ends) or (ends[:, 0] == ends[:, 1]).any():
        raise BadInput("a networkx.PlanarEmbedding has no parallel edges, loops or tethers; export kind='multigraph'")
    embedding = nx.PlanarEmbedding()
    embedding.add_nodes_from(names)
    for v in range(plane.n_vertices):
        before = None
        for d in reversed(plane.darts_at(Vertex(v))):  # clockwise
            w = names[int(plane.tail[d ^ 1])]
            embedding.add_half_edge(names[v], w, ccw=before)  # w comes clockwise after `before`
            before = w
    embedding.check_structure()
    return embedding


def shortest_path(source: Point, target: Point) -> Line:
    """Return a path with the fewest legs between two vertices.

    Raises
    ------
    BadInput
        If the two are the same vertex, or no path joins them.
    """
    import networkx as nx

    plane = same_map(source, target)
    if source.index == target.index:
        raise BadInput(f"{quoted(source)} and {quoted(target)} are one vertex: there is no leg between them")
    try:
        way = nx.bidirectional_shortest_path(to_networkx(plane), source.name, target.name)
    except nx.NetworkXNoPath:
        raise BadInput(
            f"no path joins {quoted(source.name)} and {quoted(target.name)}: they are in separate components"
        ) from None
    rows = [plane.vertex_names.row(name) for name in way]
    darts = tuple(min(darts_between(plane, u, v)) for u, v in pairwise(rows))
    return Line(plane, tuple(Edge(d >> 1) for d in darts), darts)


def bridges(plane: PlaneMap) -> tuple[str, ...]:
    """Return the names of the edges whose loss would disconnect their component, in edge order.

    In a plane map those are the edges with one face on both sides. O(E).
    """
    left, right = plane.face_of[0::2], plane.face_of[1::2]
    return tuple(plane.edge_names[e] for e in np.flatnonzero((left == right) & ~plane.tether).tolist())


def cut_vertices(plane: PlaneMap) -> tuple[str, ...]:
    """Return the names of the vertices whose loss would disconnect their component, in vertex order."""
    import networkx as nx

    graph = nx.Graph(to_networkx(plane))
    cuts = {plane.vertex_names.row(name) for name in nx.articulation_points(graph)}
    return tuple(plane.vertex_names[v] for v in sorted(cuts))
