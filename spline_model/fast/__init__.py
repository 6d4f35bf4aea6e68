"""Compiled code for straight Bezier strips under one body: whole paths, held poses, whole swings.

The clamps are solved instead of enforced and the axial forces condensed. ``path`` follows a
driven rotation (``solve`` is its way in, ``many`` a batch); the multiplier path of
``spline_model.path`` is its readable reference, and both agree to 1e-10. ``pose`` holds the
body (``spline_model.held``). ``leapfrog`` and ``acceleration`` let it go, with the constants of
``swing`` (``release`` is their way in); ``spline_model.integrators.explicit`` is the reference.
"""
