"""Other people's models of the same pivot: surrogates in closed form, and other codes where installed."""
