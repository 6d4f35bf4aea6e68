"""Compiled leapfrog for straight Bezier strips under one body.

``leapfrog`` and ``acceleration`` let the body go, with the constants of ``swing`` (``release`` is their
way in); ``spline_model.integrators.explicit`` is the reference.
"""
