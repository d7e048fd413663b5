"""Elimination orders and chordal completions."""

import itertools

import networkx as nx
import numpy as np
import pytest

from ninefold.encodings import ORDERS, triangulate
from ninefold.errors import BadInput, UnknownName

ALL = pytest.mark.parametrize("order", ORDERS)


def random_graph(seed, n, p):
    rng = np.random.default_rng(seed)
    return [pair for pair in itertools.combinations(range(n), 2) if rng.random() < p]


@ALL
@pytest.mark.parametrize("seed", range(12))
def test_completion_is_chordal_and_complete(order, seed):
    n = 4 + seed
    edges = random_graph(seed, n, 0.35)
    chordal = triangulate(n, edges, order)
    graph = nx.Graph(chordal.edges)
    graph.add_nodes_from(range(n))
    assert nx.is_chordal(graph)
    assert set(chordal.edges) == set(edges) | set(chordal.fill)
    assert not set(edges) & set(chordal.fill)
    assert sorted(chordal.order) == list(range(n))
    adjacent = {frozenset(edge) for edge in chordal.edges}
    triangles = [t for t in itertools.combinations(range(n), 3) if all(map(adjacent.__contains__, _sides(t)))]
    assert list(chordal.triangles) == triangles
    place = {v: at for at, v in enumerate(chordal.order)}
    later = [sum(place[u] > place[v] for u in graph[v]) for v in range(n)]
    assert chordal.width == max(later)
    assert chordal.width == nx.chordal_graph_treewidth(graph)


def _sides(t):
    return (frozenset(pair) for pair in itertools.combinations(t, 2))


def greedy(n, edges, order):
    """The rules as the module's table states them, recounted from nothing at every step."""
    graph = nx.Graph(edges)
    graph.add_nodes_from(range(n))
    fill = set()

    def cost(v):
        degree = graph.degree(v)
        missing = sum(not graph.has_edge(*pair) for pair in itertools.combinations(graph[v], 2))
        return {"min-degree": (degree,), "min-fill": (missing, degree), "greedy-fill-in": (missing + degree, degree)}[
            order
        ] + (v,)

    eliminated = []
    while graph:
        v = min(graph, key=cost)
        for a, b in itertools.combinations(sorted(graph[v]), 2):
            if not graph.has_edge(a, b):
                graph.add_edge(a, b)
                fill.add((a, b))
        graph.remove_node(v)
        eliminated.append(v)
    return tuple(eliminated), tuple(sorted(fill))


@ALL
@pytest.mark.parametrize("seed", range(10))
def test_order_is_the_greedy_one(order, seed):
    edges = random_graph(100 + seed, 14, 0.3)
    chordal = triangulate(14, edges, order)
    assert (chordal.order, chordal.fill) == greedy(14, edges, order)


@ALL
def test_chordal_graphs_are_left_alone(order):
    tree = [(0, 1), (1, 2), (1, 3), (3, 4)]
    assert triangulate(6, tree, order).fill == ()
    clique = list(itertools.combinations(range(6), 2))
    assert triangulate(6, [(j, i) for i, j in clique] * 2, order).edges == tuple(clique)
    assert triangulate(0, [], order).order == ()


def test_bad_input():
    with pytest.raises(UnknownName, match="did you mean 'min-fill'"):
        triangulate(3, [], "minfill")
    for edge in [(0, 3), (-1, 0), (1, 1)]:
        with pytest.raises(BadInput, match="two different vertices of 0 to 2"):
            triangulate(3, [edge])
