"""Pose graphs of simulated robots: noisy odometry through a world, closures right and wrong."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from ninefold.mapping import Visit, explore

__all__ = ["pose_graph"]


def pose_graph(world, *, seed=0, step=10.0, right=1.0, wrong=0, odometry=(0.05, 0.003), closing=(0.2, 0.02), near=None):
    """Return the lines of a .g2o file of a robot that explores a world, and the pairs of poses wrongly closed.

    Parameters
    ----------
    step
        Metres between two poses.
    right
        Share of the passes by a known place that are recognised.
    wrong
        Closures between different places, with a rotation that one of the two would have at the other.
    odometry, closing
        Standard deviations of a step and of a closure: metres and radians.
    near
        How far apart, in metres, the places of a wrong closure are at most.
    """
    rng = np.random.default_rng(seed)
    places = [event.place for event in explore(world, seed=seed).walk.events if isinstance(event, Visit)]
    number = {name: k for k, name in enumerate(world.vertex_names)}
    at = [number[place] for place in places]
    beside: dict[tuple[int, int], list[int]] = {}
    for edge, (a, b) in enumerate(np.asarray(world.edges).tolist()):
        beside.setdefault((a, b), []).append(2 * edge)
        beside.setdefault((b, a), []).append(2 * edge + 1)
    poses, stops = [], [0]
    for a, b in pairwise(at):
        dart = beside[a, b][0]
        path = np.asarray(world.path(dart // 2), float)[:: 1 - 2 * (dart % 2)]
        for p, q in pairwise(path):
            length = float(np.hypot(*(q - p)))
            yaw = float(np.arctan2(*(q - p)[::-1]))
            count = max(1, round(length / step))
            poses += [(*(p + (q - p) * k / count), yaw) for k in range(count)]
        stops.append(len(poses))
    poses.append((*np.asarray(world.points)[at[-1]], poses[-1][2]))
    true = np.array(poses)

    def measured(i, j, sigma):
        away, yaw = true[j, :2] - true[i, :2], true[i, 2]
        turn = true[j, 2] - yaw
        seen = np.array(
            [np.cos(yaw) * away[0] + np.sin(yaw) * away[1], -np.sin(yaw) * away[0] + np.cos(yaw) * away[1], turn]
        )
        seen += rng.normal(0, (sigma[0], sigma[0], sigma[1]))
        seen[2] = (seen[2] + np.pi) % (2 * np.pi) - np.pi
        return seen

    def line(i, j, seen, sigma):
        information = f"{sigma[0] ** -2:.9g} 0 0 {sigma[0] ** -2:.9g} 0 {sigma[1] ** -2:.9g}"
        return f"EDGE_SE2 {i} {j} {seen[0]:.9g} {seen[1]:.9g} {seen[2]:.9g} {information}"

    lines = [f"VERTEX_SE2 {k} {x:.6f} {y:.6f} {yaw:.6f}" for k, (x, y, yaw) in enumerate(poses)]
    lines += [line(k, k + 1, measured(k, k + 1, odometry), odometry) for k in range(len(poses) - 1)]
    closures = []
    last: dict[int, int] = {}
    for stop, place in zip(stops, at, strict=True):
        if place in last and stop > last[place] + 1 and rng.random() < right:
            closures.append(line(last[place], stop, measured(last[place], stop, closing), closing))
        last[place] = stop
    points = np.asarray(world.points)
    bad = set()
    while len(bad) < wrong:
        i, j = sorted(rng.choice(len(stops), 2, replace=False).tolist())
        far = float(np.hypot(*(points[at[i]] - points[at[j]])))
        pair = stops[i], stops[j]
        if at[i] == at[j] or pair in bad or pair[1] == pair[0] + 1 or (near is not None and far > near):
            continue
        seen = rng.normal(0, (closing[0], closing[0], closing[1]))
        seen[2] = (true[pair[1], 2] - true[pair[0], 2] + seen[2] + np.pi) % (2 * np.pi) - np.pi
        bad.add(pair)
        closures.append(line(*pair, seen, closing))
    rng.shuffle(closures)
    return lines + closures, bad
