"""A strip as an element between two end frames: point laws, element, condensation."""
