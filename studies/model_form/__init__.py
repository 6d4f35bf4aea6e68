"""What both models leave out of a real strip."""
