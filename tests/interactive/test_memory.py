"""Ten minutes of film through the server, as fast as it goes."""

import json
import os
from dataclasses import replace
from pathlib import Path

import pytest

pytest.importorskip("cv2", reason="the extra `interactive` is not installed")
pytest.importorskip("uvicorn", reason="the extra `interactive` is not installed")

from websockets.sync.client import connect

from studies.interactive.tracking.painter import Optics
from studies.interactive.web import protocol
from studies.interactive.web.server import Server, Settings
from tests.interactive.films import film
from tests.interactive.sockets import emptied

STATM = Path("/proc/self/statm")
#: Frames of ten minutes, and those after which everything has been allocated once.
FRAMES, WARM = 10 * 60 * 25, 500
#: Growth that is allowed [bytes].
GROWTH = 20e6


def resident():
    """Memory of this process [bytes]."""
    return int(STATM.read_text(encoding="ascii").split()[1]) * os.sysconf("SC_PAGE_SIZE")


@pytest.mark.slow
@pytest.mark.skipif(not STATM.is_file(), reason="needs /proc")
def test_ten_minutes_of_film_do_not_grow(monkeypatch):
    """Requirement: ten minutes of film with a release and a catch every four seconds grow by less than 20 MB
    and leave no socket open."""
    monkeypatch.setattr(protocol, "RATE", 1e9)
    monkeypatch.setattr(protocol, "BURST", 1e9)
    source = replace(film(Optics(width=480, height=360, focal=450.0), frames=40, samples=3), rate=1e6)
    with Server(Settings(camera="film", source=source)) as hosted:
        port, token = hosted.port, hosted.token
        address, origin = f"ws://127.0.0.1:{port}/ws", f"http://127.0.0.1:{port}"
        with connect(address, origin=origin, max_size=None, compression=None) as socket:
            socket.send(json.dumps({"do": "hello", "version": 1, "token": token}))
            shown = found = 0
            start = 0
            while shown < FRAMES:
                message = socket.recv(30)
                if isinstance(message, str):
                    continue
                shown += 1
                found += b'"state":"found"' in message[:8000]
                socket.send('{"do": "shown"}')
                if shown % 100 in (50, 90):
                    socket.send(json.dumps({"do": "release" if shown % 100 == 50 else "catch"}))
                if shown == WARM:
                    start = resident()
            grown = resident() - start
        assert emptied(hosted)
    assert found == FRAMES
    assert grown < GROWTH
