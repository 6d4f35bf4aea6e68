"""What accuracy costs: error against time, and what a user waits for."""
