"""Dynamic splines: flexure strips as curves of a few control points, with Lagrange multipliers."""
