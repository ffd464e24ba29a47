"""A clipboard that stands in for the system's, which needs a display."""

from copykitten import CopykittenError


class FakeClipboard:
    """Has the functions of copykitten. content: text, or a picture as bytes, width and height."""

    CopykittenError = CopykittenError

    def __init__(self) -> None:
        self.content: str | tuple[bytes, int, int] | None = None
        self.is_refused = False

    def copy(self, text: str) -> None:
        self._put(text)

    def copy_image(self, data: bytes, width: int, height: int) -> None:
        self._put((data, width, height))

    def paste(self) -> str:
        if not isinstance(self.content, str):
            raise CopykittenError("no text")
        return self.content

    def paste_image(self) -> tuple[bytes, int, int]:
        if not isinstance(self.content, tuple):
            raise CopykittenError("no picture")
        return self.content

    def _put(self, content: str | tuple[bytes, int, int]) -> None:
        if self.is_refused:
            raise CopykittenError("there is no clipboard")
        self.content = content
