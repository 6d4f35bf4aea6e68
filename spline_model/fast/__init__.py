"""The fast static path: whole paths of Bezier strips under one body inside compiled code.

The clamps are solved instead of enforced, the axial forces and the strips' own coordinates
condensed, and what remains are the body's x and y. The multiplier path of
``spline_model.path`` is the readable reference; both agree to 1e-10.
"""
