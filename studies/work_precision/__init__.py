"""What accuracy costs: error against time and against work that does not depend on the machine."""
