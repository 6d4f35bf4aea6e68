"""A server in a thread of this process, for tests and for the figure."""

import asyncio
import threading
from types import TracebackType
from typing import Self

from studies.interactive.web.server import Server, Settings


class Hosted:
    """Serves within a context; `server` has the address and the token."""

    def __init__(self, settings: Settings) -> None:
        self.server = Server(settings)
        self.server.bind()
        self._thread = threading.Thread(target=lambda: asyncio.run(self.server.serve()), daemon=True)

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.server.stop()
        self._thread.join(10.0)
