"""The local web server: the page's files, and one web socket at /ws; on the loopback, and, where the user
shares it, at one address of the own network."""

import asyncio
import contextlib
import hmac
import ipaddress
import logging
import mimetypes
import secrets
import socket as sockets
import threading
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from typing import Self

import uvicorn
from starlette.applications import Starlette
from starlette.datastructures import Headers
from starlette.requests import Request
from starlette.responses import FileResponse, PlainTextResponse, Response
from starlette.routing import Mount, Route, WebSocketRoute
from starlette.staticfiles import StaticFiles
from starlette.types import Receive, Scope, Send
from starlette.websockets import WebSocket, WebSocketClose, WebSocketDisconnect

from spline_model.reduced import many
from studies.errors import BadInput
from studies.interactive.session import Session
from studies.interactive.web import protocol
from studies.interactive.web.connection import Connection
from studies.interactive.web.protocol import Settings

LOG = logging.getLogger(__name__)
# a machine may know scripts by another kind, which browsers refuse
mimetypes.add_type("text/javascript", ".js")

#: The page's files.
PAGE = Path(__file__).parent / "page"
#: Closing codes: bad message, no right, too many.
BAD, FORBIDDEN, FULL = 4400, 4403, 4429
#: Bytes of the token behind the # of the address; sockets at a time, one of them of this machine; its names.
TOKEN_BYTES, MOST_SOCKETS, HOSTS = 24, 4, ("127.0.0.1", "localhost")
#: How long a socket may take to say hello [s].
PATIENCE = 5.0


class Server:
    """A server with a token; `run` blocks, and within a context it serves in a thread of its own."""

    def __init__(self, settings: Settings) -> None:
        self.settings = settings
        self.token = secrets.token_urlsafe(TOKEN_BYTES)
        self.port = settings.port
        self.open, self.guests = 0, 0
        self._listeners: list[sockets.socket] = []
        self._uvicorn: uvicorn.Server | None = None
        self._app = Starlette(
            routes=[
                Route("/", lambda _: FileResponse(PAGE / "index.html")),
                Mount("/page", StaticFiles(directory=PAGE)),
                Route("/markers.pdf", self._sheet),
                WebSocketRoute("/ws", self._socket),
            ]
        )

    @property
    def _hosts(self) -> list[str]:
        """Names of this machine with the port; who shares the page adds the one by which its network knows
        it."""
        names = filter(None, (*HOSTS, self.settings.share))
        return [f"{name}:{self.port}" for name in names]

    async def _guarded(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer a request, or refuse that of a foreign host (DNS rebinding) or page."""
        given, hosts = Headers(scope=scope), self._hosts
        known = given.get("host") in hosts
        if scope["type"] == "websocket":
            known = known and given.get("origin") in [f"http://{each}" for each in hosts]
        if not known and scope["type"] == "websocket":
            await WebSocketClose()(scope, receive, send)  # 403: uvicorn logs any other answer as an error
        elif not known:
            await PlainTextResponse("host: expected this machine", status_code=400)(scope, receive, send)
        else:
            await self._app(scope, receive, send)

    @property
    def address(self) -> str:
        """The page's address with its token, which the browser keeps to itself."""
        return self.address_at("127.0.0.1")

    def address_at(self, name: str) -> str:
        """The same by a name of this machine."""
        return f"http://{name}:{self.port}/#token={self.token}"

    def bind(self) -> None:
        """Take the port, on the loopback and the address that is shared; BadInput if it is taken."""
        refusal = f"--share: got {self.settings.share}, expected this machine's address in its own network"
        if (share := self.settings.share) is not None and not _is_private(share):
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
        except (OSError, OverflowError) as error:  # the latter of a port beyond 65535
            for each in (listener, *self._listeners):
                each.close()
            raise BadInput(f"{refusal} ({error})") from None
        self._listeners.append(listener)
        self.port = listener.getsockname()[1]

    def run(self) -> None:
        """Serve at the bound addresses until interrupted."""
        self._uvicorn = uvicorn.Server(
            uvicorn.Config(
                self._guarded,
                interface="asgi3",
                log_level="warning",
                lifespan="off",
                ws="websockets-sansio",
                ws_max_size=protocol.LARGEST_PICTURE,
                ws_per_message_deflate=False,
                timeout_graceful_shutdown=1,
                server_header=False,
                headers=list(protocol.headers(self._hosts).items()),
            )
        )
        self._uvicorn.run(sockets=self._listeners)

    def __enter__(self) -> Self:
        self.bind()
        self._thread = threading.Thread(target=self.run, daemon=True)
        self._thread.start()
        return self

    def __exit__(self, *raised: object) -> None:
        if self._uvicorn is not None:
            self._uvicorn.should_exit = True
        self._thread.join(10.0)

    async def _sheet(self, request: Request) -> Response:
        from studies.interactive.tracking.sheet import sheet  # matplotlib, for who asks for it

        return Response(await asyncio.to_thread(sheet), media_type="application/pdf")

    async def _socket(self, socket: WebSocket) -> None:
        """One socket: hello with the token, then its connection; any fault closes this socket only."""
        await socket.accept()
        counted = False
        guest = socket.client is None or socket.client.host not in HOSTS
        try:
            async with asyncio.timeout(PATIENCE):
                hello = protocol.event((await socket.receive()).get("text") or "")
            if hello["do"] != "hello" or hello.get("version") != protocol.VERSION:
                raise BadInput("do: got no hello of this version, expected one first")
            if not hmac.compare_digest(str(hello.get("token")).encode(), self.token.encode()):
                await _close(socket, FORBIDDEN, "token: expected the one of the address that was printed")
            elif max(self.open, guest * (self.guests + 1)) >= MOST_SOCKETS:  # one place is the owner's
                await _close(socket, FULL, "too many pages are open")
            else:
                counted = True
                self.open, self.guests = self.open + 1, self.guests + guest
                await Connection(socket, self.settings, first=self.open == 1).serve()
        except BadInput as error:
            await _close(socket, BAD, str(error))
        except TimeoutError:
            await _close(socket, FORBIDDEN, "no hello")
        except (WebSocketDisconnect, RuntimeError) as error:
            LOG.debug("the page has gone: %s", error)
        finally:
            self.open, self.guests = self.open - counted, self.guests - counted * guest


def _is_private(name: str) -> bool:
    """Return whether a name is the address of one machine in a network of one's own."""
    try:
        address = ipaddress.IPv4Address(name)
    except ValueError:
        return False
    return address.is_private and not address.is_unspecified


async def _close(socket: WebSocket, code: int, reason: str) -> None:
    """Close with a reason as long as the protocol takes it."""
    with contextlib.suppress(RuntimeError, WebSocketDisconnect):  # it is closed already, or the page has gone
        await socket.close(code, reason.encode()[:120].decode(errors="ignore"))


def warm_up() -> None:
    """Enter every kernel once, so that no picture waits for a compiler.

    What was never compiled is so in a process of its own: one that compiles a kernel may round otherwise
    than one that loads it, and a session that it records would not replay digit by digit.
    """
    if not any((Path(many.__file__).parent / "__pycache__").glob("many.follow_all*.nbi")):
        with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
            pool.submit(_enter_kernels).result()
    _enter_kernels()


def _enter_kernels() -> None:
    """Enter what a session calls: a pivot is held, squeezed and turned, and released."""
    session = Session()
    events: tuple[dict[str, object], ...] = (
        {"do": "pose", "pose": [0.0, -0.002, 0.1]},
        {"do": "release"},
        {"do": "tick"},
    )
    for event in events:
        session.feed({**event, "t": 0.0})
