"""Paths that can be trusted: inertia, critical points, resolution, branches and arc length."""
