"""Where a robot can be, slowly: every place, every way back, every assignment of exits to darts, every offset.

Nothing is clever here. Densities are normalised, and without a compass an integral over all offsets is a plain sum.
"""

from __future__ import annotations

from itertools import product
from math import pi, sqrt, tau

import numpy as np

from ninefold.mapping import PlaneMap

State = tuple[int, int | None]


class Belief:
    """The probability of each place and way back, as a dictionary."""

    def __init__(
        self, plane: PlaneMap, sigma: float, *, compass: bool, missed: float = 0.0, extra: float = 0.0, start=None
    ) -> None:
        self.plane, self.sigma, self.compass, self.missed, self.extra = plane, sigma, compass, missed, extra
        places = range(plane.n_vertices) if start is None else start
        self.p: dict[State, float] = {(v, None): 1 / len(places) for v in places}
        self.before = dict(self.p)
        self.exits: list[float] | None = None
        self.came_by: int | float | None = None
        self.offsets = np.zeros(1) if compass else np.arange(0, tau, sigma / 6)

    def darts(self, v: int) -> list[int]:
        return [d for d in self.plane.darts_at(v) if not self.plane.tether[d >> 1]]

    def density(self, error):
        wrapped = (error + pi) % tau - pi
        likely = np.exp(-wrapped * wrapped / (2 * self.sigma**2)) / (self.sigma * sqrt(tau))
        return np.where(abs(wrapped) <= 6 * self.sigma, likely, 0.0)

    def observe(self, exits: list[float] | None, came_by: int | float | None) -> None:
        """`came_by` is a position for an int, a yaw for a float."""
        before = self.p
        if came_by is not None:
            before = {}
            for (v, back), p in self.p.items():
                ways = [back] if back is not None else self.darts(v)
                for d in ways:
                    before[v, d] = before.get((v, d), 0.0) + p / len(ways)
        self.before, self.exits, self.came_by = before, exits, came_by
        self.p = self.normal({state: p * self.weight(state) for state, p in before.items()})

    def move(self, by: int | float, turn: float | None = None) -> None:
        after: dict[State, float] = {}
        for state, p in self.before.items():
            for out in self.darts(state[0]):
                share = p * self.weight(state, out, by)
                if turn is not None:
                    error = turn - self.plane.turn[out >> 1] * (-1 if out & 1 else 1)
                    if self.compass:
                        share *= abs(error) <= min(12 * self.sigma, pi)
                    else:
                        share *= np.exp(-error * error / (4 * self.sigma**2))
                back = out ^ 1
                there = int(self.plane.tail[back]), back
                after[there] = after.get(there, 0.0) + share
        self.p = self.before = self.normal(after)
        self.exits = self.came_by = None

    def weight(self, state: State, out: int | None = None, by: int | float | None = None) -> float:
        v, back = state
        heading, darts = self.plane.heading, self.darts(v)
        value = np.zeros_like(self.offsets)
        for given in self.assignments(len(darts)):
            part = np.ones_like(self.offsets)
            for i, j in enumerate(given):
                if j is None:
                    part = part / tau
                else:
                    part = part * self.density(self.exits[i] - self.offsets - heading[darts[j]])
            used = [j for j in given if j is not None]
            if self.exits is not None:
                part = part * self.missed ** (len(darts) - len(used)) * (1 - self.missed) ** len(used)
                part = part * (self.extra if None in given else 1 - self.extra)
            if isinstance(self.came_by, float):
                part = part * self.density(self.came_by - self.offsets - heading[back])
            elif self.came_by is not None:
                at = given[self.came_by]
                part = part * (at is not None and darts[at] == back)
            if isinstance(by, float):
                part = part * self.density(by - self.offsets - heading[out])
            elif by is not None:
                at = given[by]
                part = part * (at is not None and darts[at] == out)
            value = value + part
        return float(value.mean())

    def assignments(self, k: int) -> list[tuple[int | None, ...]]:
        if self.exits is None:
            return [()]
        choices = list(range(k)) + ([None] if self.extra else [])
        found = []
        for given in product(choices, repeat=len(self.exits)):
            used = [j for j in given if j is not None]
            if len(set(used)) == len(used) and given.count(None) <= 1 and (self.missed or len(used) == k):
                found.append(given)
        return found

    @staticmethod
    def normal(p: dict[State, float]) -> dict[State, float]:
        total = sum(p.values())
        return {state: x / total for state, x in p.items()}
