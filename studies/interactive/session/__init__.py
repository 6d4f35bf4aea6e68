"""What the environment does, without input or output: events in, states out."""
