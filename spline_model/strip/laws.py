"""Point laws: energy per du of bending and stretching in the turning phi and the speed v of the curve.

phi = (x' y'' - y' x'') / |C'|^2 is the turning of the tangent per du, v = |C'|, J0 the speed at
rest. A law gives its energy and its derivatives in (phi, v): all that an element needs. What is
a function of these two alone fits in here, whatever it is. Everything is dimensionless: lengths
over L, energy over EI/L.
"""

from __future__ import annotations

from spline_model.strip.compiled import part

MATERIAL, SPATIAL = range(2)


@part()
def bending_law(phi, v, speed, curvature, rigidity, measure):
    """Energy, its derivatives in phi (the moment), phi phi, phi v, v and v v.

    material (0)  1/2 EI (phi / J0 - kappa_0)^2 J0
    spatial (1)   1/2 EI (phi / v - kappa_0)^2 v     (Eq 10)
    """
    if measure == MATERIAL:
        b = phi / speed - curvature
        return 0.5 * rigidity * b * b * speed, rigidity * b, rigidity / speed, 0.0, 0.0, 0.0
    ratio = phi / v
    b = ratio - curvature
    return (
        0.5 * rigidity * b * b * v,
        rigidity * b,
        rigidity / v,
        -rigidity * ratio / v,
        -rigidity * b * (0.5 * b + curvature),
        rigidity * ratio * ratio / v,
    )


@part()
def stretching_law(v, speed, strain0, rigidity, measure):
    """Stretching by quadrature of the strain: energy, its derivatives in v and v v (Eq 13)."""
    eps = v / speed - 1.0 - strain0
    if measure == MATERIAL:
        return 0.5 * rigidity * eps * eps * speed, rigidity * eps, rigidity / speed
    return (
        0.5 * rigidity * eps * eps * v,
        rigidity * eps * (v / speed + 0.5 * eps),
        rigidity * (v / speed + 2.0 * eps) / speed,
    )


@part()
def mixed_law(v, speed, strain0, force, loss, measure):
    """Mixed stretching, (N eps - 1/2 q) W: value, its derivatives in v, v v and N, and that one's in v.

    force: N; loss: q, the sum of c N^2 over the parts of N. W = J0, or v in the spatial measure;
    the derivative in a part of N is by_n - c N W.
    """
    eps = v / speed - 1.0 - strain0
    if measure == MATERIAL:
        return (force * eps - 0.5 * loss) * speed, force, 0.0, eps * speed, 1.0
    density = force * eps - 0.5 * loss
    return density * v, density + force * v / speed, 2.0 * force / speed, eps * v, eps + v / speed
