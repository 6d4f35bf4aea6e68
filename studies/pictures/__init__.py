"""Pictures of answers: of one design or of several over one another, at the width of a page."""
