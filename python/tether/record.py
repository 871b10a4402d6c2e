"""What a run has recorded: the messages of record.mcap as dictionaries, NumPy columns or pandas frames."""

import json
import os
import pathlib
import struct
import zlib
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from .errors import RecordError, need

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

_MAGIC = b"\x89MCAP0\r\n"
_MOST_BYTES = 1 << 30  # of a chunk; one that is longer is damage
_FOOTER, _CHANNEL, _MESSAGE, _CHUNK, _METADATA = 0x02, 0x04, 0x05, 0x06, 0x0C


class _Torn(Exception):
    """Why a file cannot be read on."""


class _Fields:
    """The fields of one record of the format."""

    def __init__(self, data: bytes) -> None:
        self.data, self.at = data, 0

    def take(self, layout: str) -> int:
        size = struct.calcsize(layout)
        if self.at + size > len(self.data):
            raise _Torn("a field is cut off")
        value: int = struct.unpack_from("<" + layout, self.data, self.at)[0]
        self.at += size
        return value

    def bytes(self, length: int) -> bytes:
        if self.at + length > len(self.data):
            raise _Torn("a field is cut off")
        self.at += length
        return self.data[self.at - length:self.at]

    def text(self) -> str:
        return self.bytes(self.take("I")).decode("utf-8", "replace")

    def texts(self) -> dict[str, str]:
        end = self.take("I") + self.at
        found = {}
        while self.at < end:
            name = self.text()
            found[name] = self.text()
        return found

    def records(self) -> Iterator[tuple[int, "_Fields"]]:
        while self.at < len(self.data):
            opcode, length = self.take("B"), self.take("Q")
            yield opcode, _Fields(self.bytes(length))


class Record:
    """A record. Of a damaged one, it has what lies before the damage; `damage` then says what is wrong.

    Topics are in docs/design.md, section 5. Compressed records need Debian's python3-zstandard, columns
    python3-numpy, frames python3-pandas.
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        """Reads a file; raises RecordError if it is no record, OSError if it cannot be read."""
        self.path = pathlib.Path(path)
        self.metadata: dict[str, dict[str, str]] = {}
        self.damage = ""
        self._channels: dict[int, str] = {}
        self._messages: dict[str, list[tuple[int, bytes]]] = {}
        data = self.path.read_bytes()
        if not data.startswith(_MAGIC):
            raise RecordError(f"{path} is no record: it does not begin as MCAP does")
        try:
            self._read(_Fields(data[len(_MAGIC):]))
        except _Torn as torn:
            self.damage = str(torn)

    def _read(self, file: _Fields) -> None:
        for opcode, fields in file.records():
            if opcode == _FOOTER:
                return
            if opcode == _CHUNK:
                for of_chunk, inner in _Fields(_unpacked(fields)).records():
                    self._keep(of_chunk, inner)
            else:
                self._keep(opcode, fields)
        raise _Torn("the file has no end")

    def _keep(self, opcode: int, fields: _Fields) -> None:
        if opcode == _CHANNEL:
            channel, _ = fields.take("H"), fields.take("H")
            self._channels[channel] = fields.text()
            self._messages.setdefault(self._channels[channel], [])
        elif opcode == _MESSAGE:
            channel, _, logged_at_ns, _ = (fields.take(layout) for layout in "HIQQ")
            if channel not in self._channels:
                raise _Torn("a message has no channel")
            self._messages[self._channels[channel]].append((logged_at_ns, fields.data[fields.at:]))
        elif opcode == _METADATA:
            name = fields.text()
            self.metadata[name] = fields.texts()

    @property
    def topics(self) -> dict[str, int]:
        """Each topic, and how many messages it has."""
        return {topic: len(messages) for topic, messages in sorted(self._messages.items())}

    def messages(self, topic: str) -> Iterator[dict[str, Any]]:
        """The messages of a topic in their order. `st_s` is the ST at which one was logged [s]."""
        if topic not in self._messages:
            raise RecordError(f"{self.path} has no topic {topic}. It has: {', '.join(self.topics) or 'none'}")
        for logged_at_ns, data in self._messages[topic]:
            try:
                message = json.loads(data)
            except ValueError as error:
                raise RecordError(f"{self.path}: a message of {topic} is no JSON: {error}") from error
            yield {"st_s": logged_at_ns * 1e-9, **message}

    def columns(self, topic: str, /, **where: Any) -> "dict[str, NDArray[Any]]":
        """The messages of a topic as one array for each field, those of objects within as "object.field".

        Vectors become arrays of two dimensions. What a message does not have is NaN or, of no number, None. `where`
        selects messages: columns("/task/uav1", topic="estimate").
        """
        rows = [row for message in self.messages(topic)
                if (row := dict(_flat(message))) and all(row.get(name) == value for name, value in where.items())]
        names = dict.fromkeys(name for row in rows for name in row)
        return {name: _array([row.get(name) for row in rows]) for name in names}

    def frame(self, topic: str, /, **where: Any) -> Any:
        """The same as a pandas.DataFrame over `st_s`, with a column for each number of a vector: "p_WB_m.0"."""
        pandas = need("pandas", "python3-pandas", "frames")
        columns: dict[str, Any] = {}
        for name, array in self.columns(topic, **where).items():
            if array.ndim == 1:
                columns[name] = array
            else:
                columns.update({f"{name}.{i}": array[:, i] for i in range(array.shape[1])})
        return pandas.DataFrame(columns).set_index("st_s") if columns else pandas.DataFrame()


def _unpacked(fields: _Fields) -> bytes:
    """The records of a chunk."""
    _, _, size, checksum = (fields.take(layout) for layout in "QQQI")
    compression = fields.text()
    data = fields.bytes(fields.take("Q"))
    if compression == "zstd":
        zstandard = need("zstandard", "python3-zstandard", "records")
        try:
            if size > _MOST_BYTES or zstandard.frame_content_size(data) not in (-1, size):
                raise _Torn("a chunk has another size than it says")
            data = zstandard.ZstdDecompressor().decompress(data, max_output_size=size)
        except zstandard.ZstdError as error:
            raise _Torn(f"a chunk cannot be unpacked: {error}") from error
    elif compression:
        raise _Torn(f"a chunk is packed by {compression}")
    if len(data) != size or (checksum and zlib.crc32(data) != checksum):
        raise _Torn("a chunk is not as it was written")
    return data


def _flat(message: dict[str, Any], prefix: str = "") -> Iterator[tuple[str, Any]]:
    for name, value in message.items():
        if isinstance(value, dict):
            yield from _flat(value, f"{prefix}{name}.")
        else:
            yield prefix + name, value


def _array(values: list[Any]) -> "NDArray[np.generic]":
    """An array of integers, floats or vectors of floats if all values are; else of objects."""
    np = need("numpy", "python3-numpy", "columns")
    kinds = {bool if isinstance(value, bool) else type(value) for value in values}
    if kinds == {bool} or kinds == {int}:
        return np.array(values)  # type: ignore[no-any-return]
    if kinds <= {int, float, type(None)} and kinds != {type(None)}:
        return np.array([float("nan") if value is None else value for value in values], float)  # type: ignore[no-any-return]
    if kinds == {list} and len({len(value) for value in values}) == 1:
        if {type(number) for value in values for number in value} <= {int, float, type(None)}:
            return np.array(values, float)  # type: ignore[no-any-return]
    array = np.empty(len(values), object)
    array[:] = values
    return array  # type: ignore[no-any-return]
