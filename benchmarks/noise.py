"""Maps from headings that err: how often they are true, in named doubt, or wrong.

A robot walks the district of Helsinki, or a random plane graph (a Delaunay triangulation thinned), and recognises places
alone: the log names no way. Every map that is left is held against the truth by legs, so that parallel ways count, and by
the outer face. A row tells how many of its walks end in

- *true*: one map is left, the true one;
- *doubt*: several are left, and the true one is among them;
- *wrong*: one map is left, another one;
- *lost*: several are left, and the true one is not among them;
- *none*: no map is left, so that the walk is said to err more than declared.

Whether the true map is among those left is judged group by group of what is open together: the maps are the product of the
groups. Where up to 16 maps are left, they are built and their outer faces compared too. Seconds are of process time.

The variable NINEFOLD_NOISE_WALKS gives the number of walks of the three rows that count, 300 if it is not set; other rows
take a third as many, those with drift or understated errors a sixth. The whole takes some six minutes.
"""

from __future__ import annotations

import os
import time
from collections import Counter
from dataclasses import dataclass, replace
from functools import cache
from math import degrees, log2, radians

import numpy as np

from benchmarks.worlds import braced
from ninefold.errors import NinefoldError
from ninefold.io import samples
from ninefold.mapping import Mapper, PlaneMap, SimulatedWorld, Vertex, Visit, Walk, explore
from ninefold.mapping.doubt.estimate import EFFORT
from ninefold.mapping.doubt.evidence import read_evidence
from ninefold.mapping.doubt.noise import NoiseModel
from ninefold.mapping.doubt.outcome import Outcome, outcome_of
from ninefold.mapping.doubt.reading import Reading
from ninefold.mapping.doubt.settling import Choice
from ninefold.mapping.doubt.whole_turns import misses_by_outer_face
from ninefold.mapping.turning import corner_angles

WALKS = int(os.environ.get("NINEFOLD_NOISE_WALKS", "300"))
FEW = max(1, WALKS // 3)
FEWER = max(1, WALKS // 6)

BUILT_UP_TO = 16
"""Maps up to which they are built, to compare their outer faces."""

DRAWS = 2000
"""Draws of the row on gyros."""


@dataclass(frozen=True)
class Truth:
    """A world and its map; edges of the map are numbered as the world's ways."""

    name: str
    world: SimulatedWorld
    plane: PlaneMap

    @classmethod
    def of(cls, name: str, world: SimulatedWorld) -> Truth:
        """Take the component with the most ways, which is where the robot walks."""
        part = max(world.components(), key=len)
        row = {place: new for new, place in enumerate(part)}
        kept = [e for e, (a, _) in enumerate(world.edges.tolist()) if a in row]
        ends = [[row[int(v)] for v in world.edges[e]] for e in kept]
        paths = [world.path(e) for e in kept]
        names = {"vertex_names": [str(v) for v in part], "edge_names": [str(e) for e in kept]}
        return cls(
            name,
            SimulatedWorld(world.points[part], ends, paths, **names),
            PlaneMap.from_geometry(world.points[part], ends, paths, **names),
        )


@cache
def district() -> Truth:
    return Truth.of("district", samples.load("helsinki_district").to_world())


@cache
def random_graph(places: int, seed: int) -> Truth:
    points, edges = braced(places, 0.5, seed)
    return Truth.of(f"{places} places", SimulatedWorld(points * 1000, edges))


def walked(truth: Truth, seed: int, **options: object) -> tuple[Walk, list[int]]:
    """A walk without names of ways, and the way of every leg."""
    robot = explore(truth.world, seed=seed, step=1e6, **options)  # type: ignore[arg-type]
    visits = [event for event in robot.walk.events if isinstance(event, Visit)]
    ways = [truth.plane.edge_names.row(str(visit.edge)) for visit in visits[1:]]
    events = tuple(replace(event, edge=None) if isinstance(event, Visit) else event for event in robot.walk.events)
    return Walk(robot.walk.header, events), ways


class Judge:
    """Holds a reading of a walk against the truth."""

    def __init__(self, truth: Truth, ways: list[int], reading: Reading) -> None:
        self.truth, self.reading = truth, reading
        shares = [{ways[leg] for leg in way.legs.tolist()} for way in reading.ways]
        self.edge = [share.pop() if len(share) == 1 else -1 for share in shares]
        self.same_ways = sorted(self.edge) == list(range(truth.plane.n_edges))
        self.place = {v: truth.plane.vertex_names.row(name) for v, name in enumerate(reading.evidence.places)}

    def has_truth(self) -> bool:
        """Whether the true order at every place is left, jointly in every group that was counted.

        A place with too many orders to be listed excludes none, and nothing was settled then.
        """
        settled, orders = self.reading.settled, self.reading.orders
        if not self.same_ways or self.reading.failure is not None:
            return False
        if settled is None:
            return all(any(self._true_order(v, number) for number in range(len(left))) for v, left in orders.items())
        if settled.failure is not None:
            return False
        if not all(any(self._true_order(v, number) for number in left) for v, left in settled.left.items()):
            return False
        for factor in settled.factors:
            if factor.count is not None and not any(self._true_choice(factor.get(n)) for n in range(factor.count)):
                return False
        return True

    def _true_choice(self, choice: Choice | None) -> bool:
        return choice is not None and all(self._true_order(v, number) for v, number in choice.orders)

    def _true_order(self, place: int, number: int) -> bool:
        darts = self.reading.darts[place]
        found = [self._dart(darts[i]) for i in self.reading.orders[place][number].ways]
        true = [int(d) for d in self.truth.plane.darts_at(Vertex(self.place[place]))]
        at = true.index(found[0]) if found[0] in true else 0
        return found == true[at:] + true[:at]

    def _dart(self, dart: int) -> int:
        """The true dart of a dart of the reading; a loop of the truth has two, told apart by nothing here."""
        edge, way = self.edge[dart >> 1], self.reading.ways[dart >> 1]
        start = self.place[way.tail if dart % 2 == 0 else way.head]
        return 2 * edge + int(self.truth.plane.tail[2 * edge] != start)

    def is_true(self, plane: PlaneMap) -> bool:
        """Whether a map of this reading is the true one, outer face and all."""
        if not self.same_ways:
            return False
        true = self.truth.plane
        dart = np.array([self._dart(d) for d in range(2 * plane.n_edges)])
        if not (dart[plane.next_ccw] == true.next_ccw[dart]).all():
            return False
        outer = np.flatnonzero(plane.face_of == plane.outer_face)
        return bool((true.face_of[dart[outer]] == true.outer_face).all())


def verdict(truth: Truth, ways: list[int], found: Outcome) -> str:
    """Say in a word what a walk came to."""
    if found.count == 0:
        return "none"
    judges = [Judge(truth, ways, reading) for reading in found.readings]
    if found.count is not None and found.count <= BUILT_UP_TO:
        kept = any(judge.is_true(one.plane) for judge in judges for one in judge.reading.found())
    else:
        kept = any(judge.has_truth() for judge in judges)
    if found.count == 1 and not found.doubts:
        return "true" if kept else "wrong"
    return "doubt" if kept else "lost"


COLUMNS = ("walks", "true", "doubt", "wrong", "lost", "none", "bits median", "bits max", "s median", "s max")


def head(name: str) -> None:
    print(f"\n| {name} | " + " | ".join(COLUMNS) + " |")
    print("|---" * (len(COLUMNS) + 1) + "|", flush=True)


def rates(
    name: str, worlds: list[Truth], sigma: float, *, declared: float | None = None, told: bool = True, **options: object
) -> None:
    """Print a row: one walk in every world given.

    Parameters
    ----------
    sigma, declared
        Degrees: what headings err by, and what they are said to; left out, the same.
    told
        Whether drift is declared, if there is any.
    """
    verdicts: Counter[str] = Counter()
    bits, seconds = [], []
    for seed, truth in enumerate(worlds):
        walk, ways = walked(truth, seed, noise=radians(sigma), **options)
        header = walk.header
        begin = time.process_time()
        noise = NoiseModel(
            radians(declared or sigma),
            (header.drift or 0.0) if told else 0.0,
            compass=header.compass,
            in_order=header.exits == "in-order",
        )
        found = outcome_of(read_evidence(walk), noise, effort=EFFORT)
        seconds.append(time.process_time() - begin)
        verdicts[verdict(truth, ways, found)] += 1
        if found.count != 0:
            bits.append(float("inf") if found.count is None else log2(found.count))
    cells = [str(len(worlds)), *(str(verdicts[word]) for word in ("true", "doubt", "wrong", "lost", "none"))]
    cells += [_bits(float(np.median(bits))), _bits(max(bits))] if bits else ["", ""]
    cells += [f"{np.median(seconds):.2f}", f"{max(seconds):.2f}"]
    print(f"| {name} | " + " | ".join(cells) + " |", flush=True)


def _bits(value: float) -> str:
    return f"{value:.1f}" if np.isfinite(value) else "not counted"


def today(name: str, sigma: float, walks: int, tolerance: float | None) -> None:
    """Print what the exact `Mapper` makes of the same walks: it maps or refuses, and knows nothing of doubt."""
    truth = district()
    verdicts: Counter[str] = Counter()
    share = []
    for seed in range(walks):
        walk, _ = walked(truth, seed, noise=radians(sigma), tolerance=tolerance, exits=False)
        mapper = Mapper(walk.header)
        taken = 0
        try:
            for event in walk.events:
                mapper.step(event)
                taken += 1
            plane = mapper.plane
        except NinefoldError:
            verdicts["refused"] += 1
        else:
            verdicts["true" if _same_by_names(plane, truth.plane) else "wrong"] += 1
        share.append(taken / len(walk.events))
    cells = [str(walks), *(str(verdicts[word]) for word in ("true", "wrong", "refused")), f"{np.median(share):.0%}"]
    print(f"| {name} | " + " | ".join(cells) + " |", flush=True)


def _same_by_names(plane: PlaneMap, true: PlaneMap) -> bool:
    """Whether two maps have the same sizes and, at every place, neighbours in the same order."""

    def around(one: PlaneMap) -> dict[str, list[str]]:
        found = {}
        for v in range(one.n_vertices):
            ring = [one.vertex_names[int(one.tail[int(d) ^ 1])] for d in one.darts_at(Vertex(v))]
            found[one.vertex_names[v]] = min((ring[i:] + ring[:i] for i in range(len(ring))), default=[])
        return found

    return (plane.n_edges, plane.n_faces) == (true.n_edges, true.n_faces) and around(plane) == around(true)


def gyro(sigma: float, tau: float) -> None:
    """Print how often the outer face is found by rounding what every face turns, and by likelihood over all faces at once.

    Orders are seen place by place, once each; `sigma` errs at either end of a way, `tau` along it, degrees.
    """
    plane = district().plane
    world = district().world
    rng = np.random.default_rng(0)
    heading = world.heading
    corner = corner_angles(plane.next_ccw, heading)
    edges = plane.n_edges
    next_face = plane.next_face
    face_of = plane.face_of
    true_turn = plane.turn
    assert true_turn is not None
    var_turn = np.full(edges, radians(tau) ** 2 + 2 * radians(sigma) ** 2)
    rounding = likelihood = 0
    due = np.full(plane.n_faces, 1)
    due[plane.outer_face] = -1
    for _ in range(DRAWS):
        seen = heading + rng.normal(0, radians(sigma), 2 * edges)
        felt = true_turn + rng.normal(0, radians(tau), edges)
        corners = corner + (seen - heading)[plane.next_ccw] - (seen - heading)
        total = np.pi - corners[next_face]
        total[0::2] += felt
        total[1::2] -= felt
        turned = np.bincount(face_of, weights=total, minlength=plane.n_faces)
        rounding += bool((np.rint(turned / (2 * np.pi)) == due).all())
        miss = misses_by_outer_face(next_face, face_of, plane.n_faces, corners, felt, var_turn)
        likelihood += int(np.argmin(miss)) == plane.outer_face
    print(f"| {sigma:g} | {tau:g} | {DRAWS} | {rounding / DRAWS:.1%} | {likelihood / DRAWS:.2%} |", flush=True)


def main() -> None:
    plane = district().plane
    began = time.process_time()
    print(f"district: {plane.n_vertices} places, {plane.n_edges} ways, {plane.n_faces} faces")
    head("district, exits listed, one tour")
    for sigma in (2, 5, 10):
        rates(f"{sigma} degrees", [district()] * WALKS, sigma)
    head("district, other walks")
    for sigma in (2, 5, 10):
        rates(f"{sigma} degrees, covering tour", [district()] * FEW, sigma, tour="covering")
    for sigma in (2, 5, 10):
        rates(f"{sigma} degrees, no lists", [district()] * FEW, sigma, exits=False)
    for sigma in (2, 5, 10):
        rates(f"{sigma} degrees, three tours, lists in order", [district()] * FEW, sigma, tours=3, ordered_exits=True)
    head("random plane graphs, exits listed, one tour, each walk in a graph of its own")
    for places in (60, 200):
        for sigma in (2, 5, 10):
            rates(f"{places} places, {sigma} degrees", [random_graph(places, seed) for seed in range(FEW)], sigma)
    head("district, exits listed, one tour, with drift")
    for sigma, drift in ((2, 2), (2, 5), (5, 10), (2, 20)):
        for told in (True, False):
            word = "declared" if told else "not declared"
            rates(f"{sigma} degrees, drift {drift}, {word}", [district()] * FEWER, sigma, drift=radians(drift), told=told)
    rates("2 degrees, drift 5, declared, no lists", [district()] * FEWER, 2, drift=radians(5), exits=False)
    head("district, exits listed, one tour, errors understated")
    for sigma in (2, 5):
        for factor in (2, 3):
            rates(f"{sigma * factor} degrees, said to be {sigma}", [district()] * FEWER, sigma * factor, declared=sigma)
    print("\n| the exact Mapper, district, no lists | walks | true | wrong | refused | events taken, median |")
    print("|---|---|---|---|---|---|")
    for error in (0.05, 0.1, 0.5, 2.0, 5.0):
        today(f"{error:g} degrees, default tolerance", error, 20, None)
    for error in (0.5, 2.0, 5.0):
        tolerance = 6 * radians(error)
        today(f"{error:g} degrees, tolerance six of them ({degrees(tolerance):g} degrees)", error, 20, tolerance)
    print("\n| gyro: at an end of a way | along a way | draws | every face by rounding | outer face by likelihood |")
    print("|---|---|---|---|---|")
    for sigma, tau in ((2, 2), (5, 5), (10, 10), (5, 30), (10, 60)):
        gyro(sigma, tau)
    print(f"\nall of it: {time.process_time() - began:.0f} s of process time")


if __name__ == "__main__":
    main()
