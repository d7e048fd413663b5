"""The house itself: no circle of imports, one table of public names a package, no private name used from another module.

Everything is read from the sources, so that imports inside functions count too. The readers are tried on small sources of
their own, to show what they see.
"""

from __future__ import annotations

import ast
import importlib
import inspect
import pkgutil
import subprocess
import sys
from collections import defaultdict
from functools import cache
from pathlib import Path

import networkx as nx
import pytest

import ninefold
from ninefold._kernels import Kernel

ROOT = Path(ninefold.__file__).parent
MODULES = sorted(
    ".".join(file.relative_to(ROOT.parent).with_suffix("").parts).removesuffix(".__init__") for file in ROOT.rglob("*.py")
)
PACKAGES = [name for name in MODULES if (ROOT.parent / Path(*name.split(".")) / "__init__.py").exists()]
LAZY = [name for name in PACKAGES if name == "ninefold" or (name.count(".") == 1 and not name.endswith(".cli"))]
HEAVY = {"numba", "shapely", "pysat", "sympy", "networkx", "scipy", "numpy", "typer", "rich"}


@cache
def tree_of(module: str) -> ast.Module:
    path = ROOT.parent / Path(*module.split("."))
    return ast.parse((path / "__init__.py" if path.is_dir() else path.with_suffix(".py")).read_text())


def type_checking_nodes(tree: ast.Module) -> set[int]:
    """Return what only type checkers see: the body of ``if TYPE_CHECKING:``, but not what is under its ``else``."""
    blocks = [
        node
        for node in ast.walk(tree)
        if isinstance(node, ast.If) and ast.unparse(node.test) in ("TYPE_CHECKING", "typing.TYPE_CHECKING")
    ]
    return {id(inner) for block in blocks for statement in block.body for inner in ast.walk(statement)}


def absolute(module: str, node: ast.ImportFrom) -> str:
    here = module.split(".") if module in PACKAGES else module.split(".")[:-1]
    base = here[: len(here) - node.level + 1] if node.level else []
    return ".".join([*base, *([node.module] if node.module else [])])


def ancestors(module: str) -> set[str]:
    parts = module.split(".")
    return {".".join(parts[:k]) for k in range(1, len(parts))}


@cache
def home_of(package: str, name: str) -> str | None:
    """Return the module that a package's public name comes from, by its block of imports for type checkers."""
    typed = type_checking_nodes(tree_of(package))
    for node in ast.walk(tree_of(package)):
        if isinstance(node, ast.ImportFrom) and id(node) in typed and name in [alias.name for alias in node.names]:
            found = absolute(package, node)
            return f"{found}.{name}" if f"{found}.{name}" in MODULES else found
    return None


def loaded_by(source: str, name: str) -> str:
    """Return the module that importing or reading a name of another module loads: a submodule, a lazy name's home, or it."""
    if source in LAZY and (home := home_of(source, name)):
        return home
    return f"{source}.{name}" if f"{source}.{name}" in MODULES else source


# -- circles ---------------------------------------------------------------------------------------------------------------


def imports_of(module: str, tree: ast.Module | None = None) -> set[str]:
    """Return the modules that a module loads at run time.

    Imports inside functions count. A lazy name counts as its home, also where it is read as an attribute of a package that
    was imported. The packages on the way to a module are run before it, so they count as well.
    """
    tree = tree_of(module) if tree is None else tree
    typed = type_checking_nodes(tree)
    found: set[str] = set()
    bound: dict[str, str] = {}  # local name -> module
    for node in ast.walk(tree):
        if id(node) in typed:
            continue
        if isinstance(node, ast.Import):
            for alias in node.names:
                found.add(alias.name)
                bound[alias.asname or alias.name.split(".")[0]] = alias.name if alias.asname else alias.name.split(".")[0]
        elif isinstance(node, ast.ImportFrom):
            source = absolute(module, node)
            for alias in node.names:
                loaded = loaded_by(source, alias.name)
                found.add(loaded)
                if loaded.rpartition(".")[2] == alias.name:
                    bound[alias.asname or alias.name] = loaded

    def module_at(node: ast.expr) -> str | None:
        """Return the module that a dotted expression is, and note what reading it loads."""
        if isinstance(node, ast.Name):
            return bound.get(node.id)
        if isinstance(node, ast.Attribute) and (source := module_at(node.value)) in MODULES:
            loaded = loaded_by(source, node.attr)
            found.add(loaded)
            return loaded if loaded.rpartition(".")[2] == node.attr else None
        return None

    for node in ast.walk(tree):
        if isinstance(node, ast.Attribute) and id(node) not in typed:
            module_at(node)
    for call in dynamic_imports(tree):
        found |= computed_by(call, tree) or set()
    for name in list(found):
        found |= ancestors(name) - ancestors(module)
    return {name for name in found if name in MODULES} - {module}


def test_no_circle_of_imports() -> None:
    graph = nx.DiGraph([(module, other) for module in MODULES for other in imports_of(module)])
    circles = [sorted(part) for part in nx.strongly_connected_components(graph) if len(part) > 1]
    assert circles == []


@pytest.mark.parametrize(
    ("source", "seen"),
    [
        ("from ninefold.mapping import PlaneMap", "ninefold.mapping.plane"),
        ("from ninefold.mapping import plane", "ninefold.mapping.plane"),
        ("from ..mapping.plane import PlaneMap", "ninefold.mapping.plane"),
        ("def f():\n    from ..mapping import plane", "ninefold.mapping.plane"),
        ("import ninefold.mapping.plane as p", "ninefold.mapping.plane"),
        ("import ninefold\nninefold.mapping.PlaneMap", "ninefold.mapping.plane"),
        ("import ninefold as nf\nnf.check(1)", "ninefold.reasoner.networks.consistency"),
        ("from .. import mapping\ndef f():\n    return mapping.PlaneMap.from_darts", "ninefold.mapping.plane"),
        ("from ninefold.mapping.robot import walk", "ninefold.mapping.robot"),
        ("if TYPE_CHECKING:\n    pass\nelse:\n    from ninefold.mapping import plane", "ninefold.mapping.plane"),
        ("if not TYPE_CHECKING:\n    from ninefold.mapping import plane", "ninefold.mapping.plane"),
    ],
)
def test_the_circle_test_sees(source: str, seen: str) -> None:
    assert seen in imports_of("ninefold.layout.shapes", ast.parse(source))


def test_the_circle_test_leaves_types_alone() -> None:
    assert (
        imports_of("ninefold.layout.shapes", ast.parse("if TYPE_CHECKING:\n    from ninefold.mapping import plane")) == set()
    )
    assert "ninefold.mapping.sets" in imports_of("ninefold.layout.truth")  # by way of the lazy package


def computed_by(call: ast.Call, tree: ast.Module) -> set[str] | None:
    """Return the modules that a call of ``import_module`` may load, or None where that cannot be told.

    ``import_module(f"package.{x}")`` loads those below the package that a string of the same source names, up to a colon.
    """
    match call.args:
        case [ast.Constant(str(name))]:
            return {name}
        case [ast.JoinedStr([ast.Constant(str(package)), _])]:
            strings = [node.value for node in ast.walk(tree) if isinstance(node, ast.Constant)]
            names = {text.partition(":")[0] for text in strings if isinstance(text, str)}
            return {f"{package}{name}" for name in names} & set(MODULES) or None
    return None


def dynamic_imports(tree: ast.Module) -> list[ast.Call]:
    calls = [node for node in ast.walk(tree) if isinstance(node, ast.Call)]
    return [node for node in calls if ast.unparse(node.func).rpartition(".")[2] in ("import_module", "__import__")]


def hidden_imports(tree: ast.Module) -> list[str]:
    """Return what the readers here cannot follow: imports by a name that may be anything, and of everything."""
    everything = [node for node in ast.walk(tree) if isinstance(node, ast.ImportFrom) and node.names[0].name == "*"]
    unclear = [call for call in dynamic_imports(tree) if computed_by(call, tree) is None]
    return [ast.unparse(node) for node in [*unclear, *everything]]


@pytest.mark.parametrize("module", [module for module in MODULES if module != "ninefold._lazy"])
def test_no_import_hides(module: str) -> None:
    assert hidden_imports(tree_of(module)) == []


def test_hidden_imports_are_seen() -> None:
    for source in ("importlib.import_module(name)", "__import__(name)", "from ninefold.io import *"):
        assert hidden_imports(ast.parse(source)) == [source]
    table = ast.parse("READERS = {'walk': 'walks.json_lines:read_walk'}\nimport_module(f'ninefold.io.{READERS[x]}')")
    assert hidden_imports(table) == []
    assert "ninefold.io.walks.json_lines" in imports_of("ninefold.io.files", table)


# -- public names ----------------------------------------------------------------------------------------------------------


def table_of(package: str) -> tuple[dict[str, str], set[str]]:
    """Return the lazy table of a package: home by name, and the names of its public parts; from its call of ``attach``."""
    (call,) = (
        node for node in ast.walk(tree_of(package)) if isinstance(node, ast.Call) and ast.unparse(node.func) == "attach"
    )
    homes = ast.literal_eval(call.args[1])
    names = [(name, f"{package}.{module}") for module, held in homes.items() for name in held]
    parts = {part for keyword in call.keywords if keyword.arg == "parts" for part in ast.literal_eval(keyword.value)}
    assert len(dict(names)) == len(names), "a name with two homes"
    return dict(names) | {part.rpartition(".")[2]: f"{package}.{part}" for part in parts}, parts


def test_every_package_with_a_table_is_tested() -> None:
    loading = [
        module
        for module in MODULES
        for node in ast.walk(tree_of(module))
        if isinstance(node, ast.ImportFrom) and absolute(module, node) == "ninefold._lazy"
    ]
    assert loading == LAZY


@pytest.mark.parametrize("package", LAZY)
def test_a_package_says_once_and_consistently_what_is_public(package: str) -> None:
    module = importlib.import_module(package)
    table, _ = table_of(package)
    assert sorted(module.__all__) == sorted(set(module.__all__)) == dir(module) == sorted(table)
    typed = type_checking_nodes(tree_of(package))
    shown = [
        (alias.name, alias.asname)
        for node in ast.walk(tree_of(package))
        if isinstance(node, ast.ImportFrom) and id(node) in typed
        for alias in node.names
    ]
    assert sorted(name for name, _ in shown) == sorted(module.__all__)  # for type checkers the same names, each once
    assert {other for _, other in shown} == {None}
    for name in module.__all__:
        value = getattr(module, name)
        home = home_of(package, name)
        assert home == table[name]
        origin = importlib.import_module(home)
        assert value is (origin if inspect.ismodule(value) else getattr(origin, name))
        assert inspect.ismodule(value) or name in origin.__all__
    with pytest.raises(AttributeError, match="nonsense"):
        module.nonsense  # noqa: B018


@pytest.mark.parametrize("package", LAZY)
def test_importing_a_package_loads_nothing_else(package: str) -> None:
    program = f"import sys; before = set(sys.modules); import {package}; print(*sorted(set(sys.modules) - before))"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    loaded = done.stdout.split()
    assert not HEAVY & {name.split(".")[0] for name in loaded}
    assert {name for name in loaded if name.startswith("ninefold")} == {package, "ninefold", "ninefold._lazy"}


@pytest.mark.parametrize("package", PACKAGES)
def test_no_module_has_the_name_of_a_function_its_package_exports(package: str) -> None:
    module = importlib.import_module(package)
    submodules = {info.name for info in pkgutil.iter_modules(module.__path__)}
    exported = {name for name in getattr(module, "__all__", ()) if not inspect.ismodule(getattr(module, name))}
    assert submodules & exported == set()


def test_the_front_door_shows_what_a_user_needs() -> None:
    needed = {"PlaneMap", "Mapper", "relate", "Network", "check", "draw", "read_map", "read_walk", "read_network", "Atlas"}
    assert needed <= set(dir(ninefold))
    assert not [name for name in dir(ninefold) if name.startswith("_")]


# -- private names ---------------------------------------------------------------------------------------------------------


def is_private(name: object) -> bool:
    dunder = isinstance(name, str) and name.startswith("__") and name.endswith("__")
    return isinstance(name, str) and name.startswith("_") and name != "_" and not dunder


def classes_of(tree: ast.Module) -> list[ast.ClassDef]:
    return [node for node in ast.walk(tree) if isinstance(node, ast.ClassDef)]


def owned_by(tree: ast.Module) -> set[str]:
    """Return the private attributes of the classes of a module: methods, fields, slots, and what is set on ``self``."""
    names: set[object] = set()
    for owner in classes_of(tree):
        for node in owner.body:
            if isinstance(node, ast.FunctionDef):
                names.add(node.name)
            targets = (
                node.targets if isinstance(node, ast.Assign) else [node.target] if isinstance(node, ast.AnnAssign) else []
            )
            names |= {target.id for target in targets if isinstance(target, ast.Name)}
            if any(isinstance(target, ast.Name) and target.id == "__slots__" for target in targets):
                names |= {slot.value for slot in ast.walk(node) if isinstance(slot, ast.Constant)}
        for node in ast.walk(owner):
            if isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Store) and ast.unparse(node.value) == "self":
                names.add(node.attr)
            if isinstance(node, ast.Call) and ast.unparse(node.func) == "object.__setattr__":
                names |= {word.value for word in node.args[1:2] if isinstance(word, ast.Constant)}
    return {str(name) for name in names if is_private(name)}


@cache
def owners() -> dict[str, set[str]]:
    """Return the modules whose classes have a private attribute of a name."""
    found: dict[str, set[str]] = defaultdict(set)
    for module in MODULES:
        for name in owned_by(tree_of(module)):
            found[name].add(module)
    return found


def of_own_class(tree: ast.Module) -> set[str]:
    """Return the expressions that are evidently objects of the module's own classes: made, annotated or asked so."""
    classes = {owner.name for owner in classes_of(tree)}
    known = {"self", "cls", "super()"}
    for _ in range(2):  # an attribute that is set to a parameter is known once the parameter is
        for node in ast.walk(tree):
            if isinstance(node, ast.arg) and node.annotation is not None and ast.unparse(node.annotation) in classes:
                known.add(node.arg)
            if (
                isinstance(node, ast.Call)
                and ast.unparse(node.func) == "isinstance"
                and ast.unparse(node.args[1]) in classes
            ):
                known.add(ast.unparse(node.args[0]))
            if isinstance(node, ast.Assign) and (
                (isinstance(node.value, ast.Call) and ast.unparse(node.value.func) in {*classes, "cls", "cls.__new__"})
                or ast.unparse(node.value) in known
            ):
                known |= {ast.unparse(target) for target in node.targets}
    return known


def private_uses(module: str, tree: ast.Module | None = None) -> list[str]:
    """Return the private names of other modules that a module uses.

    Imported, of a private module or by name; read as an attribute, where none of the module's own classes has it, or where
    other modules' classes have one too and the object is not evidently of an own class; asked for by ``getattr``.
    """
    tree = tree_of(module) if tree is None else tree
    folder = module if module in PACKAGES else module.rpartition(".")[0]
    own, known = owned_by(tree), of_own_class(tree)
    found = []

    def is_out_of_bounds(path: str) -> bool:
        """Whether a module is private to a folder that this module is not in."""
        parts = path.split(".")
        private = [k for k, part in enumerate(parts) if is_private(part)]
        inside = ".".join(parts[: private[0]]) if private else ""
        return bool(private) and parts[0] == "ninefold" and folder != inside and not folder.startswith(f"{inside}.")

    for node in ast.walk(tree):
        match node:
            case ast.Import():
                found += [alias.name for alias in node.names if is_out_of_bounds(alias.name)]
            case ast.ImportFrom():
                source = absolute(module, node)
                for alias in node.names:
                    path = f"{source}.{alias.name}"
                    is_name = path not in MODULES and is_private(alias.name) and source.startswith("ninefold")
                    if is_name or is_out_of_bounds(path if path in MODULES else source):
                        found.append(path)
            case ast.Attribute() if is_private(node.attr) and node.attr not in ("_replace", "_fields", "_asdict"):
                shared = owners()[node.attr] - {module} and ast.unparse(node.value) not in known
                if node.attr not in own or shared:
                    found.append(ast.unparse(node))
            case ast.Call(func=ast.Name(id="getattr" | "setattr" | "hasattr" | "delattr"), args=[_, ast.Constant(name), *_]):
                if is_private(name) and name not in own:
                    found.append(ast.unparse(node))
    return found


@pytest.mark.parametrize("module", MODULES)
def test_no_private_name_of_another_module_is_used(module: str) -> None:
    assert private_uses(module) == []


@pytest.mark.parametrize(
    "source",
    [
        "from ninefold.mapping.robot.mapper import _at_event",
        "from ninefold.mapping.robot.mapper import _at_event as at",
        "if TYPE_CHECKING:\n    from ninefold.mapping.robot._memory import Memory",
        "from ninefold.mapping.robot._memory import Memory",
        "from ninefold.mapping.robot import _memory",
        "import ninefold.mapping.robot._memory",
        "import ninefold.mapping.robot._memory as m",
        "def f(mapper):\n    return mapper._memory",
        "_memory = 1\ndef f(mapper):\n    return mapper._memory",
        "def f(mapper):\n    _memory = 1\n    return mapper._memory",
        "class A:\n    def __init__(self):\n        self._plane = 1\ndef f(mapper):\n    return mapper._plane",
        "def f(mapper):\n    return getattr(mapper, '_memory')",
        "def f(mapper):\n    mapper._memory = None",
        "from ninefold.layout.svg import __secret",
    ],
)
def test_private_uses_are_seen(source: str) -> None:
    assert len(private_uses("ninefold.layout.shapes", ast.parse(source))) == 1


@pytest.mark.parametrize(
    "source",
    [
        "class A:\n    def __init__(self):\n        self._plane = 1\n    def f(self):\n        return self._plane",
        "class A:\n    __slots__ = ('_plane',)\n    def f(self):\n        other = A()\n        other._plane = self._plane",
        "class A:\n    _plane: int\ndef f(a: A):\n    return a._plane",
        "from ninefold import _lazy",
        "from .methods import schnyder\nfrom ninefold import __version__",
        "import _thread\nx._replace(a=1)",
    ],
)
def test_what_is_allowed_is_let_pass(source: str) -> None:
    assert private_uses("ninefold.layout.shapes", ast.parse(source)) == []


@pytest.mark.parametrize("module", [module for module in MODULES if module not in PACKAGES])
def test_a_module_has_what_it_lists(module: str) -> None:
    loaded = importlib.import_module(module)
    listed = list(getattr(loaded, "__all__", ()))
    assert [name for name in listed if not hasattr(loaded, name)] == []
    assert len(set(listed)) == len(listed)


# -- kernels ---------------------------------------------------------------------------------------------------------------

MOST_ARGUMENTS = 8


@cache
def kernels() -> dict[str, Kernel]:
    """Return every kernel of the house, by where it is written."""
    found = {}
    for module in MODULES:
        for value in vars(importlib.import_module(module)).values():
            if isinstance(value, Kernel):
                found[f"{value.plain.__module__}.{value.plain.__name__}"] = value
    return found


def test_every_kernel_is_found() -> None:
    written = {
        f"{module}.{node.name}"
        for module in MODULES
        for node in ast.walk(tree_of(module))
        if isinstance(node, ast.FunctionDef) and any("kernel" in ast.unparse(mark) for mark in node.decorator_list)
    }
    assert set(kernels()) == written
    assert len(written) > 50


def test_kernels_with_many_arguments_take_the_state() -> None:
    counts = {name: len(inspect.signature(kernel.plain).parameters) for name, kernel in kernels().items()}
    assert {name: count for name, count in counts.items() if count > MOST_ARGUMENTS} == {}
