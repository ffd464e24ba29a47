"""Checks what the program printed."""

Result = tuple[int, str, str]  # exit code, stdout, stderr


def assert_one_line(result: Result, *parts: str) -> None:
    """Check for exit code 2 and a single line on stderr that contains all ``parts``."""
    code, _, errors = result
    assert code == 2
    assert errors.startswith("akap-editor: ")
    assert errors.count("\n") == 1
    assert errors.endswith("\n")
    for part in parts:
        assert part in errors
