"""Leapfrog steps with a corrected force: a whole run in compiled code.

    w(t + h/2) = w(t - h/2) + h A(r + h^2/12 A(r, w), w),   r(t + h) = r(t) + h w(t + h/2)

Two evaluations a step give fourth order in the phase of every oscillation (effective order,
Takahashi and Imada's scheme with the force gradient as a displacement) and stability up to
omega h = sqrt(12), against 2 for one evaluation. Source: Wisdom, Holman and Touma, Fields Inst
Comm 10 (1996) 217; Hairer, McLachlan and Skeel, ESAIM: M2AN 43 (2009) 631.
"""

from __future__ import annotations

from spline_model.fast.acceleration import accelerate, stored_energy
from spline_model.strip.compiled import copy, kernel


@kernel()
def leap(r, w, acceleration, h, steps, swing, space):
    """Take ``steps`` steps in place; False if the state diverges.

    w are the rates at the steps' ends, acceleration the corrected one there: both are
    advanced with r. The rates that A depends on, by centripetal parts only, are extrapolated.
    """
    ahead, mean, size = space.ahead, space.mean, r.size
    shift = h * h / 12.0
    for i in range(size):
        mean[i] = w[i] + 0.5 * h * acceleration[i]
    for _ in range(steps):
        for i in range(size):
            r[i] += h * mean[i]
            w[i] = mean[i] + 0.5 * h * acceleration[i]
        accelerate(r, w, swing, space, acceleration)
        for i in range(size):
            ahead[i] = r[i] + shift * acceleration[i]
        accelerate(ahead, w, swing, space, acceleration)
        for i in range(size):
            mean[i] += h * acceleration[i]
    for i in range(size):
        w[i] = mean[i] - 0.5 * h * acceleration[i]
        if not abs(r[i]) + h * abs(w[i]) < 1e3:  # far outside any pose, or not finite
            return False
    return True


@kernel()
def run(r, w, acceleration, h, every, most_energy, swing, space, records):
    """Fill the rows of the records from row 1 on, ``every`` steps apart; returns the rows filled.

    records: r, w (K, R) and strain energy (K,). A state whose |C'| falls below a
    tenth, whose tangents at the tips turn back or whose energy leaves ``most_energy`` ends the run.
    """
    places, rates, strain = records
    own = 2 * space.x.shape[1] - 6
    for row in range(1, places.shape[0]):
        if not leap(r, w, acceleration, h, every, swing, space):
            return row
        strain[row], slowest = stored_energy(r, swing, space)
        if not (slowest > 0.1 and strain[row] <= most_energy):
            return row
        for s in range(swing.mass.size):
            if not (r[3 + s * own] > 0.0 and r[2 + (s + 1) * own] > 0.0):
                return row
        copy(r, places[row])
        copy(w, rates[row])
    return places.shape[0]
