"""How long a picture of the page takes to become a state of the pivot, and which part of it how much.

    python -m tests.interactive.latency [PICTURES]

One picture is under way at a time, each new one as soon as the state of the last has come, of 640 x 480
px over the loopback; the camera, the page's reading and the drawing come on top in a browser.
"""

import sys
import time
from itertools import pairwise

import numpy as np

from studies.interactive.web import protocol
from studies.interactive.web.server import Server, Settings, warm_up
from tests.interactive.films import PERIOD, film
from tests.interactive.sockets import answer, opened

#: Parts of the way through the server that it times itself; the rest is the loopback's, the threads' and this
#: client's.
PARTS = ("track", "solve", "send")


def measured(count):
    """Milliseconds (count, 5) of `count` pictures: the parts, the rest, and the whole."""
    pictures = [picture.tobytes() for picture in film(frames=PERIOD, samples=3)]
    states, wholes = [], []
    with Server(Settings(camera="browser")) as hosted, opened(hosted) as socket:
        for k in range(count + 1):
            head = protocol.HEADER.pack(protocol.PICTURE, 1, k, 640, 480, 40.0 * k)
            begin = time.perf_counter()
            socket.send(head + pictures[k % PERIOD])
            while (state := answer(socket))["seq"] != k:
                pass
            wholes.append(1e3 * (time.perf_counter() - begin))
            states.append(state)
    # a state tells how long sending the one before took
    parts = [[s["track_ms"], s["solve_ms"], after["send_ms"]] for s, after in pairwise(states)]
    whole = np.array(wholes[:-1])
    return np.column_stack((parts, whole - np.sum(parts, axis=1), whole))


def main(count=250):
    """Print the median and the 95th percentile of each part."""
    warm_up()
    rows = measured(count)
    print(f"{count} pictures [ms]: median and 95th percentile")
    for name, column in zip((*PARTS, "rest", "whole"), rows.T, strict=True):
        print(f"{name:8}{np.median(column):8.2f}{np.percentile(column, 95):8.2f}")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
