"""Values that hold arrays: read-only from the start, and still so after a pickle or a deep copy."""

import copy
import pickle

import numpy as np
import pytest

from ninefold.immutable import frozen_copy
from ninefold.io import samples
from ninefold.layout import Drawing, draw, schnyder
from ninefold.mapping import Names, PlaneMap, Region, health
from ninefold.reasoner import Network, relate

SOURCE = samples.load("figure8")
PLANE = SOURCE.to_map()
ISLANDS = PlaneMap.from_geometry([(0, 0), (9, 0), (0, 9), (2, 2), (3, 2), (1, 1)], [(0, 1), (1, 2), (2, 0), (3, 4)])
BARE = PlaneMap.from_rotation({"a": []})
ROOM = PLANE.face(1)


def constraints():
    net = Network("rcc8")
    net.add("a", "b", "NTPP")
    net.add("b", "c", "EC")
    return net.constraints()


VALUES = {
    "map": PLANE,
    "map in parts": ISLANDS,
    "map of one vertex": BARE,
    "index": PLANE.containment,
    "names": PLANE.vertex_names,
    "rows for names": Names("edge", 10),
    "point": PLANE.vertex("v3"),
    "line": PLANE.line(list(PLANE.edge_names)[:3]),
    "path": PLANE.path(["v0", "v1"]),
    "region": ROOM,
    "drawing": draw(PLANE, highlight={"room": ROOM}),
    "grid": schnyder(ISLANDS),
    "given drawing": Drawing(PLANE, np.zeros((9, 2)), np.zeros((0, 2)), np.zeros(14, np.int64)),
    "health": health(ISLANDS),
    "source": SOURCE,
    "constraints": constraints(),
}


def arrays_of(value, seen=None):
    """Every array a value holds or has cached, with a name; those of the maps and names inside it too."""
    seen = set() if seen is None else seen
    if id(value) in seen:
        return
    seen.add(id(value))
    if isinstance(value, np.ndarray):
        yield value
    elif isinstance(value, tuple | list):
        for item in value:
            yield from arrays_of(item, seen)
    elif type(value).__module__.startswith("ninefold."):
        names = [*getattr(value, "__dict__", {}), *(s for cls in type(value).__mro__ for s in getattr(cls, "__slots__", ()))]
        for name in names:
            yield from arrays_of(getattr(value, name), seen)


def use(value):
    """Have everything derived that a value derives at first use."""
    for name in dir(type(value)):
        if not name.startswith("__") and not callable(getattr(type(value), name, None)):
            getattr(value, name)


@pytest.mark.parametrize("name", VALUES)
@pytest.mark.parametrize("way", ["as made", "pickle", "old pickle", "copy", "deepcopy", "deepcopy in a list"])
def test_arrays_are_read_only(name, way):
    value = VALUES[name]
    again = {
        "as made": lambda: value,
        "pickle": lambda: pickle.loads(pickle.dumps(value, protocol=5)),
        "old pickle": lambda: pickle.loads(pickle.dumps(value, protocol=2)),
        "copy": lambda: copy.copy(value),
        "deepcopy": lambda: copy.deepcopy(value),
        "deepcopy in a list": lambda: copy.deepcopy([value])[0],
    }[way]()
    assert type(again) is type(value)
    use(again)
    found = list(arrays_of(again))
    assert len(found) == len(list(arrays_of(value))) or way != "deepcopy"
    for array in found:
        assert not array.flags.writeable
        if array.size:
            with pytest.raises(ValueError, match="read-only"):
                array[...] = 0


@pytest.mark.parametrize("name", VALUES)
def test_arrays_are_there_at_all(name):
    expected = 0 if name in ("names", "rows for names") else 3
    assert len(list(arrays_of(VALUES[name]))) >= expected


@pytest.mark.parametrize("name", [name for name in VALUES if name not in ("index", "constraints", "health")])
def test_a_pickle_is_the_same_value(name):
    value = VALUES[name]
    again = pickle.loads(pickle.dumps(value))
    if isinstance(value, Drawing):
        assert np.array_equal(again.points, value.points)
        assert again.highlight == value.highlight
    elif value is SOURCE:
        assert repr(again) == repr(value)
        assert again.to_map() == PLANE
    else:
        assert again == value
        assert hash(again) == hash(value)


def test_what_comes_out_of_a_pickle_works():
    plane, room, way = pickle.loads(pickle.dumps((PLANE, ROOM, PLANE.path(["v0", "v1"]))))
    plane.validate()
    assert room.plane is plane
    assert relate(way, room) == relate(PLANE.path(["v0", "v1"]), ROOM)
    assert way.darts == PLANE.path(["v0", "v1"]).darts
    assert plane.vertex_names.row("v3") == PLANE.vertex_names.row("v3")
    assert len(pickle.dumps(ROOM)) < 20_000


def test_a_deep_copy_of_an_immutable_value_is_the_value():
    for value in VALUES.values():
        assert copy.deepcopy(value) is value
        assert copy.copy(value) is value


def test_the_makers_array_is_not_taken_over():
    points, edges = np.array([(0.0, 0.0), (1.0, 0.0)]), np.array([(0, 1)], np.int32)
    path = np.array([(0.0, 0.0), (0.5, 0.5), (1.0, 0.0)])
    names = ("a", "b"), ("e",), (None,)
    source = type(SOURCE)(points, edges, [path], *names)
    drawn = Drawing(BARE, points[:1], points[:0], np.zeros(1, np.int64))
    points[0], path[1], edges[0] = 7, 7, (1, 1)
    assert source.points[0].tolist() == [0, 0]
    assert source.paths[0][1].tolist() == [0.5, 0.5]
    assert source.edges.tolist() == [[0, 1]]
    assert drawn.points.tolist() == [[0, 0]]
    tail = np.array([0, 1], np.int32)
    plane = PlaneMap.from_darts(tail, [0, 1])
    tail[0] = 5
    assert plane.tail.tolist() == [0, 1]
    ends, darts = ROOM.ends.copy(), ROOM.darts.copy()
    region = Region(PLANE, ends, darts)
    ends[0] = 0
    assert region == ROOM


def test_a_read_only_view_of_a_writeable_array_is_copied():
    base = np.arange(4)
    view = base[:2]
    view.setflags(write=False)
    kept = frozen_copy(view)
    base[0] = 9
    assert kept.tolist() == [0, 1]
    assert frozen_copy(kept[:1]).base is kept


def test_names_cannot_be_changed():
    names = Names("vertex", 2, ["a", "b"])
    for change in (lambda: setattr(names, "size", 3), lambda: delattr(names, "kind")):
        with pytest.raises(AttributeError, match="cannot be changed"):
            change()
    assert (names.size, names.kind) == (2, "vertex")
