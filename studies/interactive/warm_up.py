"""Every kernel of the interactive environment entered once, so that no frame waits for a compiler."""

import importlib.util

from studies.interactive.pivot.motion import MOTIONS
from studies.interactive.session.session import Session


def warm_up() -> None:
    """Hold, turn, release and catch a pivot, squeeze it until it buckles, and track a picture if OpenCV is
    there."""
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
    from studies.interactive.film.demo import demo_film
    from studies.interactive.tracking.tracker import Tracker

    Tracker().see(demo_film().picture(0), 0.0)
