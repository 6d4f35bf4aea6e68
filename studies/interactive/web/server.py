"""The local web server: the page's files, and one web socket at /ws; on the loopback, and, where the user
shares it, at one address of the own network."""

import asyncio
import importlib.util
import logging
import socket as sockets
import threading
import time
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from importlib.resources import files
from multiprocessing import get_context
from pathlib import Path
from typing import Self

import uvicorn
from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import PlainTextResponse, Response
from starlette.routing import Route, WebSocketRoute
from starlette.types import ASGIApp, Message, Receive, Scope, Send
from starlette.websockets import WebSocket, WebSocketDisconnect

from spline_model.reduced import pose
from studies.errors import BadInput
from studies.interactive.pivot.motion import MOTIONS
from studies.interactive.pivot.session import Session
from studies.interactive.web import protocol
from studies.interactive.web.connection import Connection
from studies.interactive.web.sources import Settings

LOG = logging.getLogger(__name__)

#: Kinds of the page's files.
KINDS = {".html": "text/html; charset=utf-8", ".js": "text/javascript; charset=utf-8", ".css": "text/css"}
#: Closing codes: bad message, no right, too many.
BAD, FORBIDDEN, FULL = 4400, 4403, 4429
LAST_PORT = 65535
#: How long a socket may take to say hello [s].
PATIENCE = 5.0


class _Guard:
    """Refuses foreign hosts and adds the headers of `security` to every answer."""

    def __init__(self, app: ASGIApp, port: Callable[[], int], names: tuple[str, ...]) -> None:
        self._app, self._port, self._names = app, port, names

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer one request."""
        if scope["type"] not in ("http", "websocket"):
            await self._app(scope, receive, send)
            return
        given = {name.decode("latin-1"): value.decode("latin-1") for name, value in scope["headers"]}
        port = self._port()
        if not protocol.good_host(given.get("host"), port, self._names):
            await self._refuse(scope, receive, send, 400, "host: expected this machine")
            return
        if scope["type"] == "websocket":
            if not protocol.good_origin(given.get("origin"), port, self._names):
                await self._refuse(scope, receive, send, 403, "origin: expected this page")
                return
            await self._app(scope, receive, send)
            return

        async def with_headers(message: Message) -> None:
            if message["type"] == "http.response.start":
                extra = [(k.encode(), v.encode()) for k, v in protocol.headers(port, self._names).items()]
                message["headers"] = [*message.get("headers", []), *extra]
            await send(message)

        await self._app(scope, receive, with_headers)

    @staticmethod
    async def _refuse(scope: Scope, receive: Receive, send: Send, code: int, text: str) -> None:
        if scope["type"] == "http":
            await PlainTextResponse(text, status_code=code)(scope, receive, send)
        else:
            await WebSocket(scope, receive, send).send_denial_response(
                PlainTextResponse(text, status_code=code)
            )


class Server:
    """A server with a token; `run` blocks, `start` and `stop` are for tests."""

    def __init__(self, settings: Settings) -> None:
        self.settings = settings
        self.token = protocol.new_token()
        self.port = settings.port
        self.open = 0
        self._listeners: list[sockets.socket] = []
        self._uvicorn: uvicorn.Server | None = None
        app = Starlette(
            routes=[
                Route("/", self._file),
                Route("/page/{name}", self._file),
                Route("/markers.pdf", self._sheet),
                WebSocketRoute("/ws", self._socket),
            ]
        )
        names = protocol.HOSTS if settings.share is None else (*protocol.HOSTS, settings.share)
        self.app: ASGIApp = _Guard(app, lambda: self.port, names)

    @property
    def address(self) -> str:
        """The page's address with its token, which the browser keeps to itself."""
        return self.address_at("127.0.0.1")

    def address_at(self, name: str) -> str:
        """The same by a name of this machine."""
        return f"http://{name}:{self.port}/#token={self.token}"

    def bind(self) -> None:
        """Take the port, on the loopback and the address that is shared; BadInput if it is taken."""
        if not 0 <= self.settings.port <= LAST_PORT:
            raise BadInput(f"--port: got {self.settings.port}, expected 0 (any) to {LAST_PORT}")
        refusal = f"--share: got {self.settings.share}, expected this machine's address in its own network"
        if (share := self.settings.share) is not None and not protocol.is_private(share):
            raise BadInput(refusal)
        self._listen("127.0.0.1", f"--port: got {self.settings.port}, expected a free one")
        if share is not None:
            self._listen(share, refusal)

    def _listen(self, name: str, refusal: str) -> None:
        """Listen at an address of this machine, at the port of those before."""
        # asyncio lets small answers leave at once (TCP_NODELAY) where a socket says what it speaks
        listener = sockets.socket(sockets.AF_INET, sockets.SOCK_STREAM, sockets.IPPROTO_TCP)
        listener.setsockopt(sockets.SOL_SOCKET, sockets.SO_REUSEADDR, 1)
        try:
            listener.bind((name, self.port))
            listener.listen(16)
        except OSError as error:
            for each in (listener, *self._listeners):
                each.close()
            raise BadInput(f"{refusal} ({error.strerror})") from None
        self._listeners.append(listener)
        self.port = listener.getsockname()[1]

    def run(self) -> None:
        """Serve until interrupted."""
        asyncio.run(self.serve())

    async def serve(self) -> None:
        """Serve within a running loop, until `stop`."""
        if not self._listeners:
            self.bind()
        self._uvicorn = uvicorn.Server(
            uvicorn.Config(
                self.app,
                log_level="warning",
                access_log=False,
                lifespan="off",
                ws="websockets-sansio",
                ws_max_size=protocol.LARGEST_PICTURE,
                ws_per_message_deflate=False,
                timeout_graceful_shutdown=1,
                server_header=False,
            )
        )
        await self._uvicorn.serve(sockets=self._listeners)

    def stop(self) -> None:
        """End `serve` soon."""
        if self._uvicorn is not None:
            self._uvicorn.should_exit = True

    async def _file(self, request: Request) -> Response:
        name = request.path_params.get("name", "index.html")
        known = {path.name: path for path in (files("studies.interactive.web") / "page").iterdir()}
        suffix = "." + name.rpartition(".")[2]
        if name not in known or suffix not in KINDS:
            return PlainTextResponse("not found", status_code=404)
        return Response(known[name].read_bytes(), media_type=KINDS[suffix])

    async def _sheet(self, request: Request) -> Response:
        from studies.interactive.tracking.sheet import sheet  # matplotlib, for who asks for it

        return Response(await asyncio.to_thread(sheet), media_type="application/pdf")

    async def _socket(self, socket: WebSocket) -> None:
        """One socket: hello with the token, then its connection; any fault closes this socket only."""
        await socket.accept()
        begin, counted = time.monotonic(), False
        try:
            if not await self._hello(socket):
                return
            if self.open >= protocol.MOST_SOCKETS:  # who has no token takes no page's place
                await _close(socket, FULL, "too many pages are open")
                return
            counted = True
            self.open += 1
            await Connection(socket, self.settings, first=self.open == 1).serve()
        except BadInput as error:
            await _close(socket, BAD, str(error))
        except WebSocketDisconnect:
            pass
        except RuntimeError as error:
            LOG.debug("socket closed while it was written to: %s", error)
        finally:
            self.open -= counted
            LOG.info("a page was open for %.0f s", time.monotonic() - begin)

    async def _hello(self, socket: WebSocket) -> bool:
        """Whether the first message holds the token; closes the socket if not."""
        try:
            message = await asyncio.wait_for(socket.receive(), PATIENCE)
        except TimeoutError:
            await _close(socket, FORBIDDEN, "no hello")
            return False
        if message["type"] == "websocket.disconnect":
            return False
        event = protocol.event(message.get("text") or "")
        if event["do"] != "hello" or event.get("version") != protocol.VERSION:
            raise BadInput("do: got no hello of this version, expected one first")
        if not protocol.same(self.token, event.get("token")):
            await _close(socket, FORBIDDEN, "token: expected the one of the address that was printed")
            return False
        return True


async def _close(socket: WebSocket, code: int, reason: str) -> None:
    """Close with a reason as long as the protocol takes it."""
    try:
        await socket.close(code, reason.encode()[:120].decode(errors="ignore"))
    except RuntimeError:
        LOG.debug("socket was closed already")


class Hosted:
    """Serves within a context; `server` has the address and the token."""

    def __init__(self, settings: Settings) -> None:
        self.server = Server(settings)
        self.server.bind()
        self._thread = threading.Thread(target=lambda: asyncio.run(self.server.serve()), daemon=True)

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(self, *raised: object) -> None:
        self.server.stop()
        self._thread.join(10.0)


def warm_up() -> None:
    """Enter every kernel once, so that no picture waits for a compiler.

    What was never compiled is so in a process of its own: one that compiles a kernel may round otherwise
    than one that loads it, and a session that it records would not replay digit by digit.
    """
    if not any((Path(pose.__file__).parent / "__pycache__").glob("pose.hold*.nbi")):
        with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
            pool.submit(_enter_kernels).result()
    _enter_kernels()


def _enter_kernels() -> None:
    """Enter what a session calls.

    A pivot is held, turned, released, caught and squeezed until it buckles; a picture is tracked where OpenCV
    is there.
    """
    session = Session()
    for name in MOTIONS:
        events = (
            {"do": "solver", "name": name},
            {"do": "drive", "by": "rotation"},
            {"do": "pose", "pose": [0.0, 0.0, 0.1]},
            {"do": "drive", "by": "pose"},
            {"do": "pose", "pose": [0.0, -0.002, 0.0]},
            {"do": "release"},
            {"do": "tick"},
            {"do": "catch"},
        )
        for event in events:
            session.feed({**event, "t": 0.0})
    if importlib.util.find_spec("cv2") is None:
        return
    from studies.interactive.tracking.demo import demo_film
    from studies.interactive.tracking.tracker import Tracker

    Tracker().see(demo_film().picture(0), 0.0)
