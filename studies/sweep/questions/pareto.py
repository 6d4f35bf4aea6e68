"""Designs that no other one betters: arrays in, marks out."""

import numpy as np
from numpy.typing import NDArray

from studies.kinds import Array


def not_dominated(costs: Array) -> NDArray[np.bool_]:
    """Return which designs are on the Pareto front: no other is at most as costly in all and less in one.

    Args:
        costs: (D, C), each to be small; of designs that are equal in all, all are kept.
    """
    front = np.ones(len(costs), dtype=bool)
    # what dominates another has the smaller sum: so those that stay are known by the time they are asked
    scale = np.ptp(costs, axis=0)
    order = np.argsort((costs / np.where(scale > 0.0, scale, 1.0)).sum(axis=1), kind="stable")
    for place, design in enumerate(order):
        if front[design]:
            later = order[place + 1 :]
            later = later[front[later]]
            worse = (costs[later] >= costs[design]).all(axis=1) & (costs[later] > costs[design]).any(axis=1)
            front[later[worse]] = False
    return front


def dominating(costs: Array, design: Array) -> NDArray[np.bool_]:
    """Return which designs (D, C) are at most as costly as `design` (C,) in all and less in one."""
    return np.asarray((costs <= design).all(axis=1) & (costs < design).any(axis=1))
