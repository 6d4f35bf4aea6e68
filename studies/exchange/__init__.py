"""Answers in the formats of other programs: VTK for ParaView, SVG, CSV, Parquet and JSON."""
