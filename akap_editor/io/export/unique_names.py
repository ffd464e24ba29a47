"""Names of layers in formats that tell parts apart by their names."""


class UniqueNames:
    """Gives out names that differ: a number follows from the second of one name on, as in “eye 2”.

    separator: between name and number.
    """

    def __init__(self, separator: str = " ") -> None:
        self._separator = separator
        self._used: set[str] = set()

    def next(self, name: str) -> str:
        """``name``, or if it was given out before, the first one with a number that was not."""
        number, result = 2, name
        while result in self._used:
            result, number = f"{name}{self._separator}{number}", number + 1
        self._used.add(result)
        return result
