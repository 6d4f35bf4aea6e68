"""The paper's figures, redrawn with both models and their errors."""
