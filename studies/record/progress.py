"""Progress bars on the error stream, for whatever takes longer than two seconds."""

from typing import Any, Self

from tqdm import tqdm

#: Nothing is shown for work shorter than this [s].
DELAY = 2.0


def silent(done: int, total: int) -> None:
    """Show nothing: the default wherever progress can be reported."""


class Bar:
    """A progress callable `bar(done, total)` that draws once the work has lasted two seconds."""

    def __init__(self, label: str) -> None:
        self._label = label
        self._bar: Any = None  # tqdm is generic in its stubs only

    def __call__(self, done: int, total: int) -> None:
        """Show that `done` of `total` parts are done."""
        if self._bar is None:
            self._bar = tqdm(total=total, desc=self._label, delay=DELAY, leave=False, dynamic_ncols=True)
        self._bar.total = total
        self._bar.update(done - self._bar.n)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        if self._bar is not None:
            self._bar.close()
