"""Hard cases: each is answered correctly or refused with the reason; no result is wrong without a warning."""
