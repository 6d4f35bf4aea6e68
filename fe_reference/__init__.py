"""Independent finite-element reference for flexural pivots: thin strips and one rigid body, on scikit-fem."""
