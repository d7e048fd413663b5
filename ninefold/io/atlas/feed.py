"""A walk that is still going on: lines as they come, each event in the atlas before the next line is looked at."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Self

from ninefold._files import refuse_existing
from ninefold.errors import BadInput, WalkError, located
from ninefold.mapping.robot.walk import Samples, Walk

from ..walks.json_lines import WalkReader
from ..walks.streams import STANDARD_INPUT
from .atlas import Atlas
from .records import Provenance

if TYPE_CHECKING:
    from os import PathLike

    from ninefold.mapping.robot.walk import Event

__all__ = ["Feed"]

_MUST_AGREE = ("compass", "tolerance", "sigma", "drift", "exits")


class Feed:
    """Takes the lines of a walk one by one and keeps an atlas current; a context manager that closes the atlas.

    Parameters
    ----------
    path
        The atlas. It is made when the header line comes.
    name
        What to call the source of the lines in messages.
    tolerance
        Radians, instead of the header's.
    resume
        Go on with the walk of an atlas that is there, made by an earlier feed; one that is not there is made.
    force
        Replace a file that is there.

    Attributes
    ----------
    atlas
        None until the header line has come.
    kept
        Number of events that the atlas had before the first line.

    Raises
    ------
    BadInput
        At once, if the file cannot be made; with `resume`, if it is no atlas of a walk.

    Examples
    --------
    >>> import tempfile, pathlib
    >>> folder = tempfile.TemporaryDirectory()
    >>> with Feed(pathlib.Path(folder.name) / "live.atlas") as feed:
    ...     for line in (b'{"ninefold": "walk", "version": 1, "heading": "bearing-deg"}',
    ...                  b'{"place": "gate"}', b'{"heading": 90}', b'{"place": "well"}'):
    ...         event = feed.take(line)
    ...     feed.atlas.plane, event
    (PlaneMap(2 vertices, 1 edge, 1 face), Visit(place='well', exits=None, edge=None, t=None))
    >>> folder.cleanup()
    """

    def __init__(
        self,
        path: str | PathLike[str],
        *,
        name: str = STANDARD_INPUT,
        tolerance: float | None = None,
        resume: bool = False,
        force: bool = False,
    ) -> None:
        self.path = Path(path)
        self.name = name
        self.kept = 0
        self._force = force
        self._reader = WalkReader(name, tolerance=tolerance)
        self._began = False
        self.atlas: Atlas | None = None
        if not (resume and self.path.exists()):
            refuse_existing(self.path, force=force)
            return
        self.atlas = Atlas.open(self.path)
        if self.atlas.origin != "walk":
            self.close()
            raise BadInput(
                f"{self.path}: made from a finished map, so no walk goes on in it; give the walk an atlas of its own"
            )
        self.kept = self.atlas.n_events

    def take(self, line: bytes) -> Event | None:
        """Take one line; when this returns, its event is on disk. None for the header and for a blank line.

        Raises
        ------
        WalkError, AmbiguousDart, NotPlane
            With source and line, for a line that is no event or contradicts what was seen before. The atlas is as it was
            before the line.
        AtlasError, BadInput
            If the atlas cannot be written.
        """
        event = self._reader.take(line)
        if self._reader.started and not self._began:
            self._begin()
            self._began = True
        if event is not None and self.atlas is not None:
            try:
                self.atlas.append(event)
            except BadInput as error:
                raise located(error, f"{self.name}, line {self._reader.line}") from None
        return event

    def finish(self) -> Walk:
        """Return the whole walk, once no more lines come; its header names the unit of the lines.

        Raises
        ------
        WalkError
            If there was no header, or no place.
        """
        if not self._began or self.atlas is None:
            raise WalkError("nothing came; a walk begins with a header line", where=self.name)
        events = self.atlas.walk.events
        if not events:
            raise WalkError("it ended before the first place", where=self.name)
        return Walk(self._reader.header, events)

    def close(self) -> None:
        """Close the atlas. Safe to call twice."""
        if self.atlas is not None:
            self.atlas.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _begin(self) -> None:
        """Make the atlas, or let the lines follow on what it holds."""
        header = self._reader.header
        if self.atlas is None:
            source = Provenance.of(self.name, "walk")
            self.atlas = Atlas.create(self.path, header=header, provenance=source, force=self._force)
            return
        stored = self.atlas.walk
        for key in _MUST_AGREE:
            ours, theirs = getattr(header, key), getattr(stored.header, key)
            if ours != theirs:
                told = ["left out" if value is None else json.dumps(value) for value in (ours, theirs)]
                raise WalkError(
                    f'the header\'s "{key}" is {told[0]}, but {told[1]} in the walk that {self.path} holds; a walk that '
                    "goes on keeps its header",
                    where=f"{self.name}, line {self._reader.line}",
                )
        if stored.events:
            self._reader.go_on(on_leg=isinstance(stored.events[-1], Samples))
