"""What the local server lets in: this machine, this page, this token."""

import hmac
import secrets
from collections.abc import Mapping

#: Bytes of the token that stands in the address behind the #.
TOKEN_BYTES = 24
#: Sockets at a time.
MOST_SOCKETS = 4
HOSTS = ("127.0.0.1", "localhost")


def new_token() -> str:
    """Return a token that cannot be guessed."""
    return secrets.token_urlsafe(TOKEN_BYTES)


def same(token: str, given: object) -> bool:
    """Return whether `given` is the token, in a time that does not depend on where they differ."""
    return isinstance(given, str) and hmac.compare_digest(token.encode(), given.encode())


def good_host(host: str | None, port: int) -> bool:
    """Return whether a request's Host is this machine by a name that no foreign page can take."""
    return host in {f"{name}:{port}" for name in HOSTS}


def good_origin(origin: str | None, port: int) -> bool:
    """Return whether a socket was opened by a page of this server."""
    return origin in {f"http://{name}:{port}" for name in HOSTS}


def headers(port: int) -> Mapping[str, str]:
    """Return the headers of every answer: nothing from elsewhere is loaded, framed, sniffed or kept."""
    sockets = " ".join(f"ws://{name}:{port}" for name in HOSTS)
    policy = (
        "default-src 'none'; script-src 'self'; style-src 'self'; "
        "img-src 'self' blob: data:; media-src blob:; "
        f"connect-src 'self' {sockets}; frame-ancestors 'none'; base-uri 'none'; form-action 'none'"
    )
    return {
        "Content-Security-Policy": policy,
        "X-Content-Type-Options": "nosniff",
        "Cross-Origin-Opener-Policy": "same-origin",
        "Cross-Origin-Resource-Policy": "same-origin",
        "Permissions-Policy": "camera=(self), microphone=(), geolocation=()",
        "Referrer-Policy": "no-referrer",
        "Cache-Control": "no-store",
    }
