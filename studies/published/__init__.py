"""Problems that others published with their values: a case file each, and our answers beside them."""
