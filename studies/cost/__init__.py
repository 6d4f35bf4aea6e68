"""What accuracy costs: both models, surrogates in closed form, and other codes where installed."""
