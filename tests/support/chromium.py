"""A Chromium without a window, for tests of web pages; they are skipped where none is installed."""

import base64
import io
import json
import os
import select
import shutil
import subprocess
from pathlib import Path
from typing import Any, Self

import numpy as np
import pytest
from PIL import Image

from .pictures import Picture

_NAMES = ("chromium", "chromium-browser", "google-chrome", "chrome")
_PATIENCE = 30  # seconds until a browser that says nothing is given up
_OPTIONS = (
    "--headless",
    "--no-sandbox",
    "--hide-scrollbars",
    "--enable-unsafe-swiftshader",  # WebGL without a graphics card
    "--force-color-profile=srgb",
    "--remote-debugging-pipe",
    "about:blank",
)


class Chromium:
    """A page in a browser, driven by the DevTools protocol over pipes; a context manager."""

    def __init__(self, folder: Path) -> None:
        program = next(filter(None, map(shutil.which, _NAMES)), None)
        if program is None or shutil.which("bash") is None:
            pytest.skip("Chromium is not installed (Debian: apt-get install chromium)")
        to_read, self._write = os.pipe()
        self._read, to_write = os.pipe()
        command = f'exec "$0" "$@" 3<&{to_read} 4>&{to_write}'  # the numbers that Chromium expects
        self._process = subprocess.Popen(
            ["bash", "-c", command, program, f"--user-data-dir={folder}", *_OPTIONS],
            pass_fds=(to_read, to_write),
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        os.close(to_read)
        os.close(to_write)
        self._received, self._count, self._session = b"", 0, None
        infos = self._call("Target.getTargets")["targetInfos"]
        target = next(info["targetId"] for info in infos if info["type"] == "page")
        self._session = self._call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        self._call("Page.enable")
        self._call("Emulation.setDefaultBackgroundColorOverride", color={"r": 0, "g": 0, "b": 0, "a": 0})

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *error: object) -> None:
        os.close(self._write)  # the browser ends with its pipe
        try:
            self._process.wait(10)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        os.close(self._read)

    def open(self, path: Path, fragment: str = "", size: tuple[int, int] = (800, 600)) -> None:
        """Load a page in a viewport of ``size``, width and height in pixels."""
        width, height = size
        self._call(
            "Emulation.setDeviceMetricsOverride",
            width=width,
            height=height,
            deviceScaleFactor=1,
            mobile=False,
        )
        self._call("Page.navigate", url="about:blank")  # else another fragment would not load it again
        self._call("Page.navigate", url=path.as_uri() + fragment)
        self.wait_for("document.readyState === 'complete'")

    def evaluate(self, expression: str) -> Any:
        """The value of an expression of JavaScript; a promise is awaited."""
        result = self._call("Runtime.evaluate", expression=expression, awaitPromise=True, returnByValue=True)
        if "exceptionDetails" in result:
            raise RuntimeError(json.dumps(result["exceptionDetails"]))
        return result["result"].get("value")

    def wait_for(self, expression: str) -> None:
        """Wait until an expression is true: it is asked for in every frame of the page."""
        self.evaluate(
            "new Promise((done) => { const ask = () => { let value = false; try { value = "
            + expression
            + " } catch {} value ? done() : setTimeout(ask, 5) }; ask() })"
        )

    def move_mouse(self, x: float, y: float) -> None:
        self._call("Input.dispatchMouseEvent", type="mouseMoved", x=x, y=y)

    def click(self, x: float, y: float) -> None:
        for kind in ("mousePressed", "mouseReleased"):
            self._call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=1)

    def screenshot(self) -> Picture:
        """The viewport, (h, w, 4) uint8, straight alpha."""
        data = base64.b64decode(self._call("Page.captureScreenshot", format="png")["data"])
        return np.asarray(Image.open(io.BytesIO(data)).convert("RGBA"))

    def _call(self, method: str, **parameters: object) -> dict[str, Any]:
        self._count += 1
        message: dict[str, object] = {"id": self._count, "method": method, "params": parameters}
        if self._session is not None:
            message["sessionId"] = self._session
        os.write(self._write, json.dumps(message).encode() + b"\0")
        while True:
            answer = json.loads(self._next_message())
            if answer.get("id") == self._count:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']}")
                return answer["result"]

    def _next_message(self) -> bytes:
        while b"\0" not in self._received:
            if not select.select([self._read], [], [], _PATIENCE)[0]:
                raise TimeoutError("the browser does not answer")
            data = os.read(self._read, 2**20)
            if not data:
                raise RuntimeError("the browser has ended")
            self._received += data
        message, _, self._received = self._received.partition(b"\0")
        return message
