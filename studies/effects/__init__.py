"""What each effect of a scene is worth: in the answer, in unknowns and steps, and in time."""
