"""Hard cases: each is answered rightly, or refused with the reason; never wrongly in silence."""
