"""Problems that others published with values, our answers beside them, and what beams leave out of them."""
