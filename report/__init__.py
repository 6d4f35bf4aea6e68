"""Report: `validation.pdf` compiled from `results/` alone; no number in it is typed by hand."""
