"""The markers in pictures: found there, and drawn, as films with known truth and as the printable sheet."""
