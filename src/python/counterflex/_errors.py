"""The exception of bad input."""

from __future__ import annotations


class InputError(ValueError):
    """Bad input: a machine, force, measurement or program file, or the value of an option.

    ``str(error)`` is ``file:line:column: error: message``, as the program prints it.

    file: name of the file, None where the error is not in a file
    line, column: place in the file, from 1, columns in bytes; None where it is not known
    """

    file: str | None
    line: int | None
    column: int | None

    def __init__(self, message: str, file: str | None = None, line: int | None = None, column: int | None = None):
        super().__init__(message, file, line, column)
        self.file = file or None
        self.line = line or None
        self.column = column or None

    def __str__(self) -> str:
        return self.args[0]
