"""Exact derivatives of a static path with respect to the design of the pivot."""
