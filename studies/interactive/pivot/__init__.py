"""The pivot at work: designs to start from, their mechanics held and released, where the markers sit."""
