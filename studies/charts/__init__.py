"""Charts to design with: dimensionless, over crossing ratio and inclination."""
