"""How long a picture of the page takes to become a state of the pivot, and which part of it how much.

    python -m tests.interactive.latency [PICTURES]

One picture is under way at a time, each new one as soon as the state of the last has come, as JPEG of 640 x
480 px over the loopback; the camera, the page's coding and the drawing come on top in a browser.
"""

import sys
import time

import numpy as np

from studies.interactive.tracking.tracker import encoded
from studies.interactive.web import protocol
from studies.interactive.web.server import Server, Settings, warm_up
from tests.interactive.films import PERIOD, film
from tests.interactive.sockets import answer, opened

#: Parts of the way through the server that it times itself; the rest is the loopback's, the threads' and this
#: client's.
PARTS = ("decode", "track", "solve", "send")


def measured(count):
    """Milliseconds (count, 6) of `count` pictures: the parts, the rest, and the whole."""
    pictures, rows = [encoded(picture) for picture in film(frames=PERIOD, samples=3)], []
    with Server(Settings(camera="browser")) as hosted, opened(hosted) as socket:
        for k in range(count):
            head = protocol.HEADER.pack(protocol.PICTURE, 1, protocol.JPEG, 0, k, 640, 480, 40.0 * k)
            begin = time.perf_counter()
            socket.send(head + pictures[k % PERIOD])
            while (state := answer(socket))["seq"] != k:
                pass
            whole = 1e3 * (time.perf_counter() - begin)
            parts = [state[f"{name}_ms"] for name in PARTS]
            rows.append([*parts, whole - sum(parts), whole])
    return np.array(rows)


def main(count=250):
    """Print the median and the 95th percentile of each part."""
    warm_up()
    rows = measured(count)
    print(f"{count} pictures [ms]: median and 95th percentile")
    for name, column in zip((*PARTS, "rest", "whole"), rows.T, strict=True):
        print(f"{name:8}{np.median(column):8.2f}{np.percentile(column, 95):8.2f}")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
