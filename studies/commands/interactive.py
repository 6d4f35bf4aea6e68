"""Start the interactive environment of the paper's section 4 and open its page in the browser.

    python -m studies interactive
    python -m studies interactive --film demo
    python -m studies interactive --camera none --preset table-1
    python -m studies interactive my_pivot.toml
    python -m studies interactive --replay session.jsonl
    python -m studies interactive --camera none --share

Two printed markers (`python -m studies markers`) before the browser's camera drive the pivot; without a
camera mouse, touch and keys do. A case file of one's own, or a case of the suite by its name, joins the
presets: a pivot, or any mechanism with one body on strips from the ground. Of its loads an upright force on
the body acts here. The server is open to this machine only, but for `--share`: then a phone or another
machine of the own network drives a pivot of its own with the link that is printed, over a connection that is
not encrypted. It needs the extra `interactive`, which `make interactive` installs.

Exit code 0: stopped with Ctrl-C, or a replay that gave the recorded states; 1: a
replay that did not; 2: bad input.
"""

import argparse
import contextlib
import importlib.util
import socket as sockets
import sys
import webbrowser
from pathlib import Path

from studies.commands.arguments import CASE, OUT_FILE
from studies.commands.parser import Argument, command, whole_number
from studies.errors import BadInput
from studies.record.files import write_whole

#: What the extra brings: module -> package.
EXTRA = {
    "cv2": "opencv-python-headless",
    "starlette": "starlette",
    "uvicorn": "uvicorn",
    "websockets": "websockets",
}


@command(
    CASE.but("a design of one's own to start with, a file or the name of one that comes along", nargs="?"),
    Argument("--port P", "of the server, default any free one", whole_number(0), default=0),
    Argument(
        "--share ADDRESS", "open the page to the own network too (default: closed)", nargs="?", const=""
    ),
    Argument("--no-browser", "print the address, open nothing"),
    Argument("--film FILE|demo", "pictures from a film, not a camera (default: none)"),
    Argument("--camera browser|none|N", "N: number of this machine's, default browser", default="browser"),
    Argument("--calibration FILE", "the camera's constants as JSON (default: none)", Path),
    Argument("--preset NAME", "design to start with: polymer (default), table-1, or a case of the suite"),
    Argument("--record FILE", "store the session's events (default: none)", OUT_FILE.read),
    Argument("--replay FILE", "replay a stored session and compare (default: none)", Path),
)
def main(arguments: argparse.Namespace) -> int:
    """Serve until interrupted, or replay; return the exit code. BadInput: options that exclude each other."""
    from studies.interactive import presets

    if arguments.case is not None:
        if arguments.preset is not None:
            raise BadInput(f"--preset: got {arguments.preset} beside a case, expected one of them")
        presets.PRESETS[presets.OWN] = presets.own(Path(arguments.case))
    if arguments.replay is not None:
        return _replay(arguments.replay)
    _require_extra("interactive")
    from studies.interactive.tracking.planar import Camera
    from studies.interactive.web.server import Server, Settings, warm_up

    preset = arguments.preset or ("polymer" if arguments.case is None else presets.OWN)
    presets.preset(preset)
    source, camera = _source(arguments)
    stream = arguments.record and arguments.record.open("w", encoding="utf-8", buffering=1)
    server = Server(
        Settings(
            port=arguments.port,
            share=_address() if arguments.share == "" else arguments.share,
            camera=camera,
            source=source,
            calibration=None if arguments.calibration is None else Camera.read(arguments.calibration),
            preset=preset,
            keep=stream and stream.write,
        )
    )
    server.bind()
    warm_up()
    print(f"studies: open {server.address}   (Ctrl-C ends it)", file=sys.stderr, flush=True)
    if server.settings.share is not None:
        _say_shared(server.address_at(server.settings.share), camera)
    if not arguments.no_browser:
        webbrowser.open(server.address)
    with contextlib.suppress(KeyboardInterrupt):
        server.run()
    return 0


@command(OUT_FILE.but("default markers.pdf", default="markers.pdf"))
def markers(arguments: argparse.Namespace) -> int:
    """Print the sheet with both markers, the pivot's outline and a ruler, as PDF for A4.

        python -m studies markers --out markers.pdf

    One marker is for the ground, the other moves. Print the sheet at 100 %, measure the ruler, and type its
    length into the page if it is not 100 mm: no picture can tell the printed size. It needs the extra
    `interactive`. Exit code 0: done; 2: bad input.
    """
    _require_extra("markers")
    from studies.interactive.tracking.sheet import sheet

    write_whole(arguments.out, sheet())
    print(f"{arguments.out}: print at 100 %; the ruler must measure 100 mm")
    return 0


@command(
    Argument("source FILM|N", "a film file of the whole sheet, or number N of this machine's cameras"),
    Argument("--views N", "from other sides, default 12", whole_number(3), default=12),
    OUT_FILE.but("default camera.json", default="camera.json"),
)
def calibrate(arguments: argparse.Namespace) -> int:
    """Find a camera's constants from views of the uncut marker sheet, for `interactive --calibration`.

        python -m studies calibrate 0 --out camera.json

    Hold the sheet flat, both markers in view, and tilt it slowly to all sides, 30 degrees and more; each view
    from another side counts. It says how uncertain the constants are, and refuses those that the views do not
    tell. They hold for this camera at this size of picture. The environment works without them: they take a
    lens's distortion out. It needs the extra `interactive`. Exit code 0: done; 2: bad input, or views that do
    not suffice.
    """
    _require_extra("calibrate")
    from studies.interactive.tracking.films import Video
    from studies.interactive.tracking.sheet import calibrated, views

    place = int(arguments.source) if arguments.source.isdecimal() else Path(arguments.source)
    found, size = [], (0, 0)
    for corners, seen in views(Video(place).once(), arguments.views):
        found.append(corners)
        size = seen
        print(f"\rview {len(found)} of {arguments.views}", end="", file=sys.stderr, flush=True)
    print(file=sys.stderr)
    camera, spread, rms = calibrated(found, size)
    camera.write(arguments.out)
    for name, unit in (("fx", "px"), ("fy", "px"), ("cx", "px"), ("cy", "px"), ("k1", ""), ("k2", "")):
        print(f"{name} = {getattr(camera, name):.4g} ± {getattr(spread, name):.2g} {unit}".rstrip())
    print(f"{arguments.out}: {len(found)} views of {size[0]} x {size[1]} px, corners within {rms:.2f} px")
    return 0


def _address() -> str:
    """Return the address by which this machine leaves for its network."""
    with sockets.socket(sockets.AF_INET, sockets.SOCK_DGRAM) as probe:
        try:
            probe.connect(("198.51.100.1", 9))  # sends nothing: the way there tells the address
        except OSError:
            raise BadInput("--share: got no network, expected one, or this machine's address in it") from None
        return str(probe.getsockname()[0])


def _say_shared(address: str, camera: str) -> None:
    """Say what is open to the network, with the link as a code for a phone's camera."""
    import cv2
    import numpy as np

    sees = {"film": " and sees the film", "server": " and SEES WHAT THIS MACHINE'S CAMERA SEES"}.get(
        camera, ""
    )
    print(
        f"studies: shared at {address}\n"
        f"studies: everyone in this network who has this link moves a pivot of their own{sees}; nothing is "
        "encrypted; no file of this machine is read or written\n"
        "studies: a phone's own camera stays closed: browsers open it to https pages with a certificate that "
        "they trust, which a private address cannot have",
        file=sys.stderr,
    )
    code = np.pad(cv2.QRCodeEncoder.create().encode(address) > 0, ((3, 4), (3, 3)), constant_values=True)
    if (sys.stderr.encoding or "").lower().startswith("utf"):
        for upper, lower in zip(code[0:-1:2], code[1::2], strict=False):
            print("".join(" ▄▀█"[2 * a + b] for a, b in zip(upper, lower, strict=True)), file=sys.stderr)
    sys.stderr.flush()


def _require_extra(name: str) -> None:
    """Raise BadInput unless the packages of the extra are installed."""
    missing = [package for module, package in EXTRA.items() if importlib.util.find_spec(module) is None]
    if missing:
        raise BadInput(
            f"{name}: got no {', '.join(missing)}, expected the extra: run `make interactive`, "
            "or pip install 'cross-axis-pivot-validation[interactive]'"
        )


def _source(arguments: argparse.Namespace):  # type: ignore[no-untyped-def]
    """Return the source of the pictures, and its name on the page."""
    from studies.interactive.tracking.films import Video, demo_film

    if arguments.film is not None:
        if arguments.camera != "browser":
            raise BadInput(f"--camera: got {arguments.camera} beside --film, expected one of them")
        made = demo_film() if arguments.film == "demo" else Video(Path(arguments.film))
        return made, "film"
    if arguments.camera in ("browser", "none"):
        return None, arguments.camera
    if not arguments.camera.isdecimal():
        raise BadInput(f"--camera: got {arguments.camera}, expected browser, none or a number")
    return Video(int(arguments.camera)), "server"


def _replay(path: Path) -> int:
    """Replay a session file; 0 where every state is the recorded one."""
    from studies.interactive.session import replay

    try:
        lines = path.read_text(encoding="utf-8").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise BadInput(f"--replay: got {path}, expected a session file ({error})") from None
    same = [good for _, good in replay(lines)]
    print(f"{path}: {sum(same)} of {len(same)} states are those recorded")
    return 0 if same and all(same) else 1
