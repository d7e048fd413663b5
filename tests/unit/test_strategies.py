"""Strategies of exploration: what they walk, when they stop, and that they see nothing but what is known."""

import numpy as np
import pytest
from explored import component_map, same_up_to_numbering, simulated
from worlds import KINDS

from ninefold.errors import AmbiguousDart, BadInput, UnknownName
from ninefold.io.sources import samples
from ninefold.mapping import (
    AskDriven,
    DepthFirst,
    DoubtDriven,
    NearestFirst,
    OpenMap,
    SimulatedWorld,
    Visit,
    WallFollowing,
    build,
    explore,
    open_map,
)
from ninefold.mapping.doubt.hypotheses import hypotheses
from ninefold.mapping.doubt.likeness import likeness
from ninefold.mapping.doubt.quotients import QuotientSearch
from ninefold.mapping.doubt.walk_tree import fold


def grid(width, height, missing=0.0, seed=0):
    """A connected grid without a share of its streets."""
    rng = np.random.default_rng(seed)
    points = [(x, y) for x in range(width) for y in range(height)]
    ways = [
        (i, j)
        for i, a in enumerate(points)
        for j, b in enumerate(points)
        if i < j and abs(a[0] - b[0]) + abs(a[1] - b[1]) == 1
    ]
    while True:
        world = SimulatedWorld(points, [way for way in ways if rng.random() >= missing])
        if len(world.components()) == 1:
            return world


def corner_ring(width, height):
    """The names of the places round a grid's inner square."""
    at = lambda x, y: str(x * height + y)  # noqa: E731
    return [at(1, 1), at(2, 1), at(2, 2), at(1, 2)]


# -- walking everything --------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", [None, 0, 1])
def test_a_wall_follower_walks_everything(kind, seed):
    for size in (5, 12):
        world = simulated(7, kind, size)
        robot = explore(world, tour="wall", seed=seed)
        start = world.vertex_names.row(robot.start)
        same_up_to_numbering(build(robot.walk), component_map(world, start), 1e-6)


def test_a_wall_follower_keeps_the_wall_on_its_right():
    # A ring with a dead end inside and one outside, entered at a corner towards the east: inside is on the left.
    world = SimulatedWorld(
        [(0, 0), (4, 0), (4, 4), (0, 4), (1, 1), (6, 0)],
        [(0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (1, 5)],
        vertex_names="abcdio",
    )
    assert explore(world, start="a", tour="wall").walk.places == ("a", "b", "o", "b", "c", "d", "a", "i")
    assert explore(grid(3, 3), tour="wall", seed=4).walk == explore(grid(3, 3), tour="wall", seed=4).walk


@pytest.mark.parametrize(
    ("tour", "strategy"), [("depth-first", DepthFirst), ("covering", NearestFirst), ("wall", WallFollowing)]
)
def test_a_named_tour_is_its_strategy(tour, strategy):
    world = samples.load("office").to_world()
    assert explore(world, tour=tour).walk == explore(world, tour=strategy()).walk
    hidden = explore(world, tour=tour, places=False).walk
    assert set(hidden.places) == {None}
    assert all(event.edge is None for event in hidden.events if isinstance(event, Visit))
    shown = explore(world, tour=tour).walk
    assert [event.exits for event in hidden.events if isinstance(event, Visit)] == [
        event.exits for event in shown.events if isinstance(event, Visit)
    ]


def test_a_strategy_is_given_what_was_walked_and_no_more():
    world = samples.load("office").to_world()
    inner = NearestFirst()
    seen = []

    def watched(known):
        seen.append((known.n_places, known.n_open))
        plane, dart = known.to_plane()
        assert plane.n_edges == sum(mate >= 0 for mate in known.mate) // 2 == len(dart) // 2
        return inner(known)

    walk = explore(world, tour=watched).walk
    assert seen[0] == (1, len(walk.events[0].exits))
    assert seen[-1][1] == 0
    assert len(seen) == walk.n_legs + 1
    same_up_to_numbering(build(walk), component_map(world, world.vertex_names.row(walk.places[0])), 1e-6)


def test_a_strategy_that_errs_is_told():
    world = grid(2, 2)
    with pytest.raises(BadInput, match=r"an exit of the place where the robot is, \[0, 1\], not 7"):
        explore(world, tour=lambda known: 7)
    with pytest.raises(BadInput, match="a strategy makes one tour, not 2"):
        explore(world, tour=NearestFirst(), tours=2)
    assert explore(world, tour=lambda known: None).walk.n_legs == 0


def test_an_open_map_refuses_what_cannot_be():
    known = OpenMap()
    for headings in ([1.0, 0.0], [1.0, 1.0], [-3.2, 3.2]):
        with pytest.raises(BadInput, match="by ascending yaw, within one turn"):
            known.see(headings)
    known.see([0.0])
    known.see([0.0, 1.0])
    with pytest.raises(BadInput, match="not to each other"):
        known.join(0, 0)
    known.join(0, 1)
    known.join(1, 0)
    with pytest.raises(BadInput, match="not to each other"):
        known.join(0, 2)
    assert (known.n_open, known.mate) == (1, [1, 0, -1])


def test_the_open_map_of_a_walk_is_that_of_the_robot():
    world = samples.load("helsinki_district").to_world()
    last = []
    inner = DepthFirst()

    def some(known):
        last[:] = [known]
        return inner(known) if len(known.names) < 60 else None

    walk = explore(world, tour=some).walk
    (known,) = last
    found = open_map(walk)
    assert (found.names, found.mate, found.n_open) == (known.names, known.mate, known.n_open)
    assert found.n_open > 0


# -- ask-driven ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("seed", range(3))
def test_an_answer_is_right_and_comes_before_all_is_walked(seed):
    world = samples.load("helsinki_district").to_world()
    full = explore(world, seed=seed, tour="covering")
    plane = build(full.walk)
    rng = np.random.default_rng(seed)
    legs = []
    rings = [face for face in range(plane.n_faces) if face != plane.outer_face]
    for face in rng.choice(rings, 6, replace=False):
        ring = boundary(plane, plane.face(int(face)))
        if ring is None:
            continue
        name = str(rng.choice(plane.vertex_names))
        question = AskDriven(name, ring)
        walked = explore(world, start=full.start, tour=question).walk
        region = plane.cycle(ring)
        truth = "boundary" if name in ring else "inside" if plane.vertex(name).index in inner(plane, region) else "outside"
        assert question.answer == truth
        legs.append(walked.n_legs)
    assert legs
    assert np.mean(legs) < full.walk.n_legs


def boundary(plane, region):
    """The places round a face, if it is a simple cycle."""
    leaving = {int(plane.tail[d]): int(d) for d in region.darts}
    if len(leaving) != len(region.darts):
        return None
    at = first = int(plane.tail[region.darts[0]])
    ring = []
    while not ring or at != first:
        ring.append(plane.vertex_names[at])
        at = int(plane.tail[leaving[at] ^ 1])
    simple = len(ring) == len(leaving) >= 3
    parallel = any(
        sum(int(plane.tail[d ^ 1]) == plane.vertex(b).index for d in plane.darts_at(plane.vertex(a).index)) > 1
        for a, b in zip(ring, (*ring[1:], ring[0]), strict=True)
    )
    return ring if simple and not parallel else None


def inner(plane, region):
    """Places all of whose faces are in a region."""
    faces = set(region.faces)
    return {v for v in range(plane.n_vertices) if all(int(plane.face_of[d]) in faces for d in plane.darts_at(v))}


def test_a_question_is_settled_when_one_side_is_walked_out():
    world = grid(4, 4)
    for name in ("0", "15", "5"):
        question = AskDriven(name, corner_ring(4, 4))
        walk = explore(world, start=5, tour=question).walk
        assert question.answer == ("boundary" if name == "5" else "outside")
        assert walk.n_legs == (0 if name == "5" else 14)  # of 24 ways: until the square is closed, and nothing is open in it
    ringed = SimulatedWorld(
        [(0, 0), (4, 0), (4, 4), (0, 4), (2, 2), (1, 1), (9, 0)], [(0, 1), (1, 2), (2, 3), (3, 0), (0, 5), (5, 4), (1, 6)]
    )
    question = AskDriven("4", "0123")
    explore(ringed, start=6, tour=question)
    assert (question.answer, question.seen) == ("inside", False)  # nothing is open outside, so there it must be


def test_questions_that_have_no_answer():
    world = grid(3, 3)
    with pytest.raises(UnknownName, match="no place named 'x'"):
        explore(SimulatedWorld([(0, 0), (1, 0), (0, 1)], [(0, 1), (1, 2), (2, 0)]), tour=AskDriven("x", "012"))
    with pytest.raises(UnknownName, match="no place named '99'"):
        explore(world, tour=AskDriven("4", ["0", "1", "99"]))
    with pytest.raises(BadInput, match="all ways at '4' or '0' are walked, and none joins the two"):
        explore(world, tour=AskDriven("8", ["0", "1", "4"]))
    arc = [(0, 0), (2, -1), (4, 0)]
    doubled = SimulatedWorld(
        [(0, 0), (4, 0), (2, 3), (9, 9)], [(0, 1), (1, 2), (2, 0), (0, 1), (2, 3)], [None] * 3 + [arc, None]
    )
    with pytest.raises(AmbiguousDart, match="2 ways join '0' and '1', so the ring is not one cycle"):
        explore(doubled, start=1, tour=AskDriven("3", "012"))
    for ring in (["a", "b"], ["a", "b", "a"], []):
        with pytest.raises(BadInput, match="a ring is three places or more, each once"):
            AskDriven("x", ring)


# -- doubt-driven --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("width", "height", "missing"), [(2, 3, 0.0), (3, 3, 0.0), (3, 3, 0.2), (3, 4, 0.2), (4, 4, 0.2)])
@pytest.mark.parametrize("seed", range(3))
def test_one_map_is_left_and_it_is_the_right_one(width, height, missing, seed):
    world = grid(width, height, missing, seed)
    strategy = DoubtDriven(len(world.points))
    walk = explore(world, start=seed, tour=strategy, places=False).walk
    assert (strategy.left, strategy.exact) == (1, True)
    tree = fold(walk)
    search = QuotientSearch(tree, likeness(tree), most_places=len(world.points))
    found = []
    while not search.done:
        found.extend(search.more(100_000))
    assert len(found) == 1
    (one,) = (one for one in hypotheses(walk, closed=True, max_places=len(world.points)))
    true = component_map(world, 0)
    assert one.closed
    assert (one.plane.n_vertices, one.plane.n_edges, one.plane.n_faces) == (true.n_vertices, true.n_edges, true.n_faces)
    # the map is the world's: its places in the order walked have the exits of the world's
    place = walked_places(world, seed, walk)
    assert len(set(zip(place, one.visits.tolist(), strict=True))) == len(set(place)) == one.n_places


def walked_places(world, start, walk):
    """The true places of a walk, followed by its headings."""
    at, found = start, [start]
    ends = world.edges.reshape(-1)
    for event in walk.events:
        if not isinstance(event, Visit):
            at = next(int(ends[d ^ 1]) for d in world.darts_at(at) if abs(world.heading[d] - event.yaw[0]) < 1e-6)
            found.append(at)
    return found


def test_a_leg_that_tells_two_maps_apart_is_taken_first():
    # A long corridor of doors all alike with an end that differs: where the robot began decides how long it is.
    world = SimulatedWorld(
        [(0, 0), (1, 0), (2, 0), (2, 1), (1, 1), (0, 1)], [(0, 1), (1, 2), (2, 3), (3, 4), (4, 5), (5, 0), (1, 4)]
    )
    telling, plain = DoubtDriven(6), DoubtDriven(6, ahead=0)
    first = explore(world, start=1, tour=telling, places=False).walk
    second = explore(world, start=1, tour=plain, places=False).walk
    assert (telling.left, telling.exact) == (1, True)
    assert first.n_legs <= second.n_legs + 2


def test_too_few_places_leave_no_map():
    strategy = DoubtDriven(3)
    walk = explore(grid(2, 2), tour=strategy, places=False).walk
    assert (strategy.left, strategy.exact) == (0, True)
    assert walk.n_legs < 10


def test_arguments_of_a_doubt_driven_robot_are_checked():
    for options, message in (
        ({"max_places": 0}, "max_places is a whole number, 1 or more, not 0"),
        ({"max_places": 4, "maps": 0}, "maps is a whole number"),
        ({"max_places": 4, "ahead": -1}, "ahead is a whole number, 0 or more, not -1"),
        ({"max_places": 4, "tolerance": 9.0}, "a tolerance is an angle"),
    ):
        with pytest.raises(BadInput, match=message):
            DoubtDriven(**options)
