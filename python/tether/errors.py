"""Errors of the client library, one class for each status of <tether/client.h>, and of the commands."""

import enum
import importlib
from typing import Any


class Code(enum.IntEnum):
    """What a call of the client library ended with: `tether_status`."""

    OK = 0
    INVALID = 1
    NOTHING_YET = 2
    REFUSED = 3
    DISCONNECTED = 4
    PROTOCOL = 5
    TIMEOUT = 6
    RUN_ENDED = 7
    NO_MEMORY = 8
    INTERNAL = 9


class TetherError(Exception):
    """An error of the client library, with its message. `code` is the status of the C call."""

    code = Code.INTERNAL


class InvalidError(TetherError, ValueError):
    """An argument cannot be used, or the mission is finished. The next call may succeed."""

    code = Code.INVALID


class RefusedError(TetherError):
    """The coordinator refused: wrong name, token, clock or version."""

    code = Code.REFUSED


class DisconnectedError(TetherError, ConnectionError):
    """The connection ended, or no coordinator is there."""

    code = Code.DISCONNECTED


class ProtocolError(TetherError):
    """The coordinator sent what the protocol does not allow."""

    code = Code.PROTOCOL


class NoAnswerError(TetherError, TimeoutError):
    """No answer within the limit."""

    code = Code.TIMEOUT


class RunEndedError(TetherError):
    """The coordinator ended the run, or another thread finished the mission."""

    code = Code.RUN_ENDED


class NoMemoryError(TetherError, MemoryError):
    """The library has no memory left."""

    code = Code.NO_MEMORY


class InternalError(TetherError):
    """An error in the library."""

    code = Code.INTERNAL


class CommandError(Exception):
    """A command of `tether` could not do what it was asked. `exit_code` is that of the command."""

    def __init__(self, message: str, exit_code: int) -> None:
        """Of a message and an exit code."""
        super().__init__(message)
        self.exit_code = exit_code


class RecordError(ValueError):
    """A file is no record, or has none of what was asked for."""


ERRORS: dict[int, type[TetherError]] = {
    error.code: error
    for error in (InvalidError, RefusedError, DisconnectedError, ProtocolError, NoAnswerError, RunEndedError,
                  NoMemoryError, InternalError)
}


def need(module: str, package: str, purpose: str) -> Any:
    """The module, which not all of Tether needs. Raises ImportError that names Debian's package."""
    try:
        return importlib.import_module(module)
    except ImportError as missing:
        raise ImportError(f"{purpose} need the module {module}: install Debian's {package}") from missing
