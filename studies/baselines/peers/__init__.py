"""The same pivot in other codes; each is optional (`pip install '.[peers]'`)."""
