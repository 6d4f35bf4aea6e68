"""Families of motions."""
