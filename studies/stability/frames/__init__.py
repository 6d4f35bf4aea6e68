"""Columns, frames and the pushed pivot: designs, paths in arc length, questions, curves and figure."""
