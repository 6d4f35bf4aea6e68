"""Pictures of the markers that are drawn: films with known truth, the demo film, the printable sheet."""
