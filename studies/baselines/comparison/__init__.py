"""Studies that hold the baselines against the spline."""
