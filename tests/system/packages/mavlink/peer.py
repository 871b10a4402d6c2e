"""The other side of the exchange: pymavlink, which shares no code with Tether.

peer.py read FRAMES [PASSPHRASE]          one line for each frame, as exchange.cpp prints them
peer.py write FRAMES NAMES [PASSPHRASE]   messages of the types whose names are in the file NAMES
peer.py known LINES                       of such lines, what pymavlink knows: not all messages and new
                                          extensions, and nothing of which fields are extensions
"""

import hashlib
import os
import random
import re
import struct
import sys

os.environ["MAVLINK20"] = "1"
from pymavlink.dialects.v20 import ardupilotmega, common  # noqa: E402

TYPES = {**ardupilotmega.mavlink_map, **common.mavlink_map}


def fields_of(kind):
    """(name, how many values, struct's letter) in the order of the payload."""
    codes = re.findall(r"(\d*)([a-zA-Z])", kind.unpacker.format.lstrip("<"))
    return [(name, int(count or 1), code, bool(count))
            for name, (count, code) in zip(kind.ordered_fieldnames, codes)]


def text_of(value, code):
    return struct.pack(">f", value).hex() if code == "f" else str(value)


def line(message, source, sequence, is_signed):
    kind = type(message)
    words = [f"{kind.id} {kind.msgname} crc_extra={kind.crc_extra} length={kind.unpacker.size} version=2",
             f"from={source[0]}.{source[1]} sequence={sequence} signed={int(is_signed)}"]
    for name, count, code, is_array in fields_of(kind):
        value = getattr(message, name)
        if code == "s":
            text = value.decode() if isinstance(value, bytes) else value
            words.append(f'{name}="{text.split(chr(0))[0]}"')
        else:
            values = value if is_array else [value]
            words.append(f"{name}={','.join(text_of(v, code) for v in values)}")
    return " ".join(words)


def link(key):
    mav = common.MAVLink(None)
    if key:
        mav.signing.secret_key, mav.signing.link_id = key, 7
        mav.signing.timestamp, mav.signing.sign_outgoing = 34_715_520_000_000, True
    return mav


def read(file, key):
    common.mavlink_map.update(TYPES)
    with open(file, "rb") as stream:
        data = stream.read()
    for message in link(key).parse_buffer(data) or []:
        if message.get_type().startswith("UNKNOWN"):
            continue
        if message.get_type() == "BAD_DATA":
            sys.exit(f"not read: {message.reason}")
        source = (message.get_srcSystem(), message.get_srcComponent())
        print(line(message, source, message.get_seq(), message.get_signed()))


def known(file):
    with open(file, encoding="utf-8") as lines:
        for text in lines:
            words = text.replace("(extension)", "").split()
            kind = TYPES.get(int(words[0]))
            if kind is None:
                continue
            names = {"crc_extra", "version", "from", "sequence", "signed", *kind.fieldnames}
            print(*words[:2], *(word for word in words[2:] if word.split("=")[0] in names))


def value_of(code, count, is_array, numbers):
    if code == "s":
        return "".join(chr(33 + numbers.randrange(90)) for _ in range(numbers.randrange(count + 1))).encode()

    def one():
        if code == "f":
            return struct.unpack("f", struct.pack("f", numbers.gauss(0, 1) * 2.0 ** numbers.randrange(-90, 90)))[0]
        bits = 8 * struct.calcsize(code)
        return numbers.getrandbits(bits) - (1 << bits - 1 if code.islower() else 0)

    return [one() for _ in range(count)] if is_array else one()


def write(file, names, key):
    mav, numbers, sequence = link(key), random.Random(1), 0
    with open(file, "wb") as stream:
        for kind in TYPES.values():
            if kind.msgname not in names:
                continue
            for _ in range(6):
                values = {name: value_of(code, count, is_array, numbers)
                          for name, count, code, is_array in fields_of(kind)}
                message = kind(**values)
                mav.srcSystem, mav.srcComponent, mav.seq = numbers.randrange(1, 256), numbers.randrange(256), sequence
                stream.write(bytes(message.pack(mav)))
                print(line(message, (mav.srcSystem, mav.srcComponent), sequence, bool(key)))
                sequence = (sequence + 1) % 256


def main():
    what, file, *rest = sys.argv[1:]
    if what == "known":
        known(file)
        return
    names = set()
    if what == "write":
        with open(rest.pop(0), encoding="utf-8") as of_tether:
            names = set(of_tether.read().split())
    key = hashlib.sha256(rest[0].encode()).digest() if rest else None
    if what == "read":
        read(file, key)
    else:
        write(file, names, key)


if __name__ == "__main__":
    main()
