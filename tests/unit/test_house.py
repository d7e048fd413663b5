"""The house itself: no circle of imports, one table of public names a package, no private name used from another module."""

from __future__ import annotations

import ast
import importlib
import inspect
import pkgutil
from functools import cache
from pathlib import Path

import networkx as nx
import pytest

import ninefold

ROOT = Path(ninefold.__file__).parent
MODULES = sorted(
    ".".join(file.relative_to(ROOT.parent).with_suffix("").parts).removesuffix(".__init__") for file in ROOT.rglob("*.py")
)
PACKAGES = [name for name in MODULES if (ROOT.parent / Path(*name.split(".")) / "__init__.py").exists()]
LAZY = [name for name in PACKAGES if name == "ninefold" or (name.count(".") == 1 and not name.endswith(".cli"))]


@cache
def tree_of(module: str) -> ast.Module:
    path = ROOT.parent / Path(*module.split("."))
    return ast.parse((path / "__init__.py" if path.is_dir() else path.with_suffix(".py")).read_text())


def type_checking_nodes(module: str) -> set[int]:
    blocks = [
        node for node in ast.walk(tree_of(module)) if isinstance(node, ast.If) and "TYPE_CHECKING" in ast.dump(node.test)
    ]
    return {id(inner) for block in blocks for inner in ast.walk(block)}


def absolute(module: str, node: ast.ImportFrom) -> str:
    here = module.split(".") if module in PACKAGES else module.split(".")[:-1]
    base = here[: len(here) - node.level + 1] if node.level else []
    return ".".join([*base, *([node.module] if node.module else [])])


@cache
def home_of(package: str, name: str) -> str | None:
    """Return the module that a package's public name comes from, by its block of imports for type checkers."""
    typed = type_checking_nodes(package)
    for node in ast.walk(tree_of(package)):
        if isinstance(node, ast.ImportFrom) and id(node) in typed and name in [alias.name for alias in node.names]:
            found = absolute(package, node)
            return f"{found}.{name}" if f"{found}.{name}" in MODULES else found
    return None


def imports_of(module: str) -> set[str]:
    """Return the modules that a module imports at run time, inside functions too; lazy names count as their home."""
    found: set[str] = set()
    typed = type_checking_nodes(module)
    for node in ast.walk(tree_of(module)):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        if not isinstance(node, ast.ImportFrom) or id(node) in typed:
            continue
        source = absolute(module, node)
        for alias in node.names:
            if f"{source}.{alias.name}" in MODULES and not (source in LAZY and home_of(source, alias.name)):
                found.add(f"{source}.{alias.name}")
            elif source in LAZY and (home := home_of(source, alias.name)):
                found.add(home)
            else:
                found.add(source)
    return {name for name in found if name in MODULES} - {module}


def test_no_circle_of_imports() -> None:
    graph = nx.DiGraph([(module, other) for module in MODULES for other in imports_of(module)])
    circles = [sorted(part) for part in nx.strongly_connected_components(graph) if len(part) > 1]
    assert circles == []


def test_the_circle_test_sees_imports() -> None:
    assert "ninefold.mapping.plane" in imports_of("ninefold.mapping.robot.mapper")
    assert "ninefold.mapping.sets" in imports_of("ninefold.layout.truth")  # by way of the lazy package


@pytest.mark.parametrize("package", LAZY)
def test_a_package_says_once_and_consistently_what_is_public(package: str) -> None:
    module = importlib.import_module(package)
    assert sorted(module.__all__) == dir(module)
    for name in module.__all__:
        value = getattr(module, name)
        home = home_of(package, name)
        assert home is not None
        origin = importlib.import_module(home)
        assert value is (origin if inspect.ismodule(value) else getattr(origin, name))
    with pytest.raises(AttributeError, match="nonsense"):
        module.nonsense  # noqa: B018


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


def private_uses(module: str) -> list[str]:
    """Return the private names of other modules that a module reads, by import or by attribute of a module or object."""
    own = {
        name
        for node in ast.walk(tree_of(module))
        for name in (
            [node.name] if isinstance(node, ast.FunctionDef | ast.ClassDef)
            else [node.id] if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)
            else [node.attr] if isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Store)
            else [slot.value for slot in ast.walk(node.value) if isinstance(slot, ast.Constant)]
            if isinstance(node, ast.Assign) and any(isinstance(t, ast.Name) and t.id == "__slots__" for t in node.targets)
            else []
        )
    }  # fmt: skip
    found = []
    for node in ast.walk(tree_of(module)):
        if isinstance(node, ast.ImportFrom):
            source = absolute(module, node)
            found += [
                f"{source}.{alias.name}"
                for alias in node.names
                if alias.name.startswith("_") and source.startswith("ninefold") and f"{source}.{alias.name}" not in MODULES
                and not alias.name.startswith("__")
            ]  # fmt: skip
            # a private module is for its own folder
            folder = module if module in PACKAGES else module.rpartition(".")[0]
            parts = source.split(".")
            private = [k for k, part in enumerate(parts) if part.startswith("_")]
            if source.startswith("ninefold.") and private and source != "ninefold._lazy" and source != "ninefold._kernels":
                inside = ".".join(parts[: private[0]])
                if folder != inside and not folder.startswith(f"{inside}."):
                    found.append(source)
        if (
            isinstance(node, ast.Attribute)
            and node.attr.startswith("_")
            and not node.attr.startswith("__")
            and node.attr not in own
            and node.attr not in ("_replace", "_fields", "_asdict")
        ):
            found.append(f"{ast.unparse(node.value)}.{node.attr}")
    return found


@pytest.mark.parametrize("module", MODULES)
def test_no_private_name_of_another_module_is_used(module: str) -> None:
    assert private_uses(module) == []
