"""Convergence of both models with their refinement."""
