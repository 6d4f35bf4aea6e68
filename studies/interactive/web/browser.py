"""A Chromium without a window, driven through its debugging socket: pages, scripts, mouse, keys, pictures."""

import json
import os
import shutil
import subprocess
import tempfile
import time
from contextlib import ExitStack, closing, suppress
from http.client import HTTPConnection
from pathlib import Path
from typing import Any, Self

from websockets.sync.client import connect

NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome")
#: How long a browser may take to start, and a script or a condition to be answered [s].
PATIENCE = 60.0
OPTIONS = (
    "--headless=new",
    "--disable-gpu",
    "--disable-background-networking",
    "--disable-dev-shm-usage",
    "--hide-scrollbars",
    "--remote-debugging-port=0",
    "--use-fake-ui-for-media-stream",
)


def executable() -> str | None:
    """Return the path of a Chromium, or None if there is none on the PATH."""
    return next((path for path in map(shutil.which, NAMES) if path), None)


class Browser:
    """One page of one browser, ended with the context.

    Args:
        film: a .mjpeg or .y4m file that stands for the camera; without one there is no camera.
        width, height: of the page [px].
    """

    def __init__(self, *, film: Path | None = None, width: int = 1280, height: int = 1000) -> None:
        path = executable()
        if path is None:
            raise FileNotFoundError(f"no browser: expected one of {', '.join(NAMES)} on the PATH")
        self._number = 0
        self.console: list[str] = []
        with ExitStack() as stack:  # whatever fails from here on, the process must not stay
            self._folder = stack.enter_context(
                tempfile.TemporaryDirectory(prefix="browser-", ignore_cleanup_errors=True)
            )
            words = [path, *OPTIONS, f"--user-data-dir={self._folder}", f"--window-size={width},{height}"]
            if film is not None:
                words += ["--use-fake-device-for-media-stream", f"--use-file-for-fake-video-capture={film}"]
            if hasattr(os, "geteuid") and os.geteuid() == 0:
                words.append("--no-sandbox")  # its sandbox refuses to run for root
            silent = subprocess.DEVNULL
            self._process = subprocess.Popen([*words, "about:blank"], stdout=silent, stderr=silent)
            stack.callback(self._process.wait)
            stack.callback(self._process.kill)
            socket = connect(self._page_address(), max_size=None, compression=None)
            self._socket = stack.enter_context(socket)
            for name in ("Page", "Runtime", "Log"):
                self.call(f"{name}.enable")
            size = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False}
            self.call("Emulation.setDeviceMetricsOverride", **size)
            self._stack = stack.pop_all()

    def _page_address(self) -> str:
        """The address of the page's debugging socket, which the browser writes into its folder."""
        note, end = Path(self._folder) / "DevToolsActivePort", time.monotonic() + PATIENCE
        while time.monotonic() < end:
            if self._process.poll() is not None:
                raise RuntimeError(f"browser: ended at once with code {self._process.returncode}")
            text = note.read_text(encoding="utf-8").split() if note.is_file() else []
            if len(text) >= 2:
                with closing(HTTPConnection("127.0.0.1", int(text[0]), timeout=PATIENCE)) as known:
                    known.request("GET", "/json/list")
                    pages = [page for page in json.load(known.getresponse()) if page["type"] == "page"]
                return str(pages[0]["webSocketDebuggerUrl"])
            time.sleep(0.05)
        raise TimeoutError("browser: did not start")

    def call(self, method: str, **parameters: Any) -> dict[str, Any]:
        """Call a method of the debugging protocol and return its result; RuntimeError for an error."""
        self._number += 1
        self._socket.send(json.dumps({"id": self._number, "method": method, "params": parameters}))
        while True:
            answer = json.loads(self._socket.recv(PATIENCE))
            self._note(answer)
            if answer.get("id") == self._number:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']}")
                return dict(answer["result"])

    def _note(self, answer: dict[str, Any]) -> None:
        """Keep what the page complains of."""
        given = answer.get("params", {})
        if answer.get("method") == "Runtime.exceptionThrown":
            self.console.append(str(given["exceptionDetails"].get("exception", given)))
        if answer.get("method") == "Log.entryAdded" and given["entry"]["level"] == "error":
            self.console.append(given["entry"]["text"])

    def open(self, address: str) -> None:
        """Load a page."""
        self.call("Page.navigate", url=address)

    def ask(self, script: str) -> Any:
        """Return the value of a script, awaited where it is a promise; RuntimeError where it throws."""
        answer = self.call("Runtime.evaluate", expression=script, awaitPromise=True, returnByValue=True)
        if "exceptionDetails" in answer:
            raise RuntimeError(str(answer["exceptionDetails"].get("exception", answer)))
        return answer["result"].get("value")

    def wait(self, script: str, patience: float = PATIENCE) -> Any:
        """Return the script's value once it is true; TimeoutError after `patience` seconds."""
        end = time.monotonic() + patience
        while time.monotonic() < end:
            with suppress(RuntimeError):  # a page that is being loaded lacks objects of the script
                if value := self.ask(script):
                    return value
            time.sleep(0.03)
        raise TimeoutError(f"page: {script} did not come true in {patience:g} s; it said {self.console[:3]}")

    def key(self, key: str, *, shift: bool = False) -> None:
        """Press and release a key, by the name that events use."""
        text = key if len(key) == 1 else ("\r" if key == "Enter" else "")
        code = {"Enter": 13, "Tab": 9, "Escape": 27, " ": 32}.get(key, 0)
        event = {"key": key, "modifiers": 8 * shift, "windowsVirtualKeyCode": code}
        self.call("Input.dispatchKeyEvent", type="keyDown" if text else "rawKeyDown", text=text, **event)
        self.call("Input.dispatchKeyEvent", type="keyUp", **event)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *raised: object) -> None:
        self._stack.close()
