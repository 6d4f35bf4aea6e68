"""Sockets and requests to a server of the tests."""

import contextlib
import http.client
import json
import time

import pytest
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect


@contextlib.contextmanager
def opened(server, *, token=None, hello=True, **options):
    """A socket that has said hello and taken the welcome."""
    origin = options.pop("origin", f"http://127.0.0.1:{server.port}")
    address = f"ws://127.0.0.1:{server.port}/ws"
    with connect(address, origin=origin, max_size=None, compression=None, **options) as socket:
        if hello:
            say(socket, do="hello", version=1, token=token or server.token)
            assert json.loads(socket.recv(5))["kind"] == "welcome"
            assert json.loads(socket.recv(5))["kind"] == "state"
        yield socket


def emptied(server, within=10.0):
    """Whether all sockets of a server are closed within some seconds."""
    end = time.monotonic() + within
    while server.open and time.monotonic() < end:
        time.sleep(0.05)
    return server.open == 0


def say(socket, **event):
    """Send an event."""
    socket.send(json.dumps(event))


def answer(socket, kind="state"):
    """The next message of that kind."""
    while True:
        message = json.loads(socket.recv(5))
        if message["kind"] == kind:
            return message


def told(socket, **event):
    """The state that answers an event."""
    say(socket, **event)
    return answer(socket)


def closing(socket):
    """Code and reason that the server closes with."""
    with pytest.raises(ConnectionClosed) as caught:
        while True:
            socket.recv(5)
    return caught.value.rcvd.code, caught.value.rcvd.reason


def get(server, path, host=None):
    """Answer to a request."""
    connection = http.client.HTTPConnection("127.0.0.1", server.port, timeout=5)
    connection.request("GET", path, headers={"Host": host or f"127.0.0.1:{server.port}"})
    response = connection.getresponse()
    body = response.read()
    connection.close()
    return response, body


def frame(socket):
    """State and JPEG of the next picture of a film."""
    while True:
        message = socket.recv(10)
        if isinstance(message, bytes):
            size = int.from_bytes(message[:4], "little")
            return json.loads(message[4 : 4 + size]), message[4 + size :]
