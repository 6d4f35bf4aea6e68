"""Independent finite-element reference for flexural pivots: thin strips and rigid bodies, on scikit-fem."""
