"""Engine: what a study declares, and what answers it."""
