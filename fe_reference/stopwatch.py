"""Where the time of a solution goes."""

from time import perf_counter


class Stopwatch:
    """Seconds by part: "compile" (structure and spans), "solve" (the path or motion alone), "recover" (fields
    of the solved states).
    """

    def __init__(self) -> None:
        self.seconds: dict[str, float] = {}
        self.since = perf_counter()

    def stop(self, part: str) -> dict[str, float]:
        """Book what passed since the last stop to a part and return all parts so far [s]."""
        now = perf_counter()
        self.seconds[part] = self.seconds.get(part, 0.0) + now - self.since
        self.since = now
        return self.seconds
