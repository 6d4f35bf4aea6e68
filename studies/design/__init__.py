"""Design questions answered: sizing by exact gradients, checked by the finite elements; design charts."""
