"""A strip as a plate: its stiffness in the linear range, and the rigidity along the strip that has it."""
