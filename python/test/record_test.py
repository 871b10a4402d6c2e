"""Records, whole and damaged. Real ones are read in tests/system/packages/python."""

import json
import pathlib
import random
import struct
import tempfile
import unittest
import zlib

import numpy as np
import tether
import zstandard


def text(value):
    return struct.pack("<I", len(value)) + value.encode()


def record(opcode, content):
    return struct.pack("<BQ", opcode, len(content)) + content


def chunk(records, compression, checksum=None):
    packed = zstandard.ZstdCompressor().compress(records) if compression == "zstd" else records
    checksum = zlib.crc32(records) if checksum is None else checksum
    return record(0x06, struct.pack("<QQQI", 0, 0, len(records), checksum) + text(compression) +
                  struct.pack("<Q", len(packed)) + packed)


def message(channel, at_ns, value):
    return record(0x05, struct.pack("<HIQQ", channel, 0, at_ns, at_ns) + json.dumps(value).encode())


def channel(number, topic):
    return record(0x04, struct.pack("<HH", number, 0) + text(topic) + text("json") + struct.pack("<I", 0))


POSES = [{"at_ns": 10 * i, "p_WB_m": [i, 0, 1.5], "is_there": i > 1, "uav": "uav1"} for i in range(4)]
MIXED = [{"topic": "roi", "data": {"u_px": 1}}, {"topic": "estimate", "data": {"bearing_rad": 0.5, "anchor": "box"}}]
METADATA = text("tether") + struct.pack("<I", len(text("seed") + text("7"))) + text("seed") + text("7")


def sample(compression="zstd"):
    first = channel(1, "/poses") + b"".join(message(1, 10**7 * i, pose) for i, pose in enumerate(POSES))
    second = channel(2, "/task") + b"".join(message(2, 10**9, value) for value in MIXED)
    return (b"\x89MCAP0\r\n" + record(0x01, text("") + text("")) + record(0x0C, METADATA) +
            chunk(first, compression) + chunk(second, compression) + record(0x0F, b"\0" * 4) +
            record(0x02, b"\0" * 20) + b"\x89MCAP0\r\n")


class Records(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def read(self, data):
        file = pathlib.Path(self.folder.name) / "record.mcap"
        file.write_bytes(data)
        return tether.Record(file)

    def test_messages_and_metadata(self):
        for compression in ("zstd", ""):
            read = self.read(sample(compression))
            self.assertEqual(read.damage, "")
            self.assertEqual(read.topics, {"/poses": 4, "/task": 2})
            self.assertEqual(read.metadata, {"tether": {"seed": "7"}})
            self.assertEqual(list(read.messages("/poses"))[2], {"st_s": 0.02, **POSES[2]})

    def test_columns(self):
        columns = self.read(sample()).columns("/poses")
        np.testing.assert_allclose(columns["st_s"], [0, 0.01, 0.02, 0.03])
        self.assertEqual((columns["at_ns"].dtype, columns["is_there"].dtype), (np.int64, np.bool_))
        np.testing.assert_array_equal(columns["p_WB_m"], [[i, 0, 1.5] for i in range(4)])
        self.assertEqual(list(columns["uav"]), ["uav1"] * 4)

    def test_what_a_message_does_not_have_is_nan_or_none(self):
        columns = self.read(sample()).columns("/task")
        np.testing.assert_array_equal(columns["data.u_px"], [1, np.nan])
        self.assertEqual(list(columns["data.anchor"]), [None, "box"])

    def test_messages_are_selected(self):
        read = self.read(sample())
        self.assertEqual(list(read.columns("/task", topic="estimate")["data.bearing_rad"]), [0.5])
        self.assertEqual(read.columns("/task", topic="none"), {})

    def test_an_unknown_topic_is_told_with_those_that_there_are(self):
        with self.assertRaisesRegex(tether.RecordError, "no topic /pose. It has: /poses, /task"):
            self.read(sample()).columns("/pose")

    def test_a_file_of_another_kind_is_refused(self):
        with self.assertRaises(tether.RecordError):
            self.read(b"PK\3\4")

    def test_of_a_torn_record_all_before_the_tear_is_read(self):
        whole = sample()
        second = whole.rindex(chunk(channel(2, "/task") + b"".join(message(2, 10**9, m) for m in MIXED), "zstd"))
        read = self.read(whole[:second + 20])
        self.assertEqual((read.topics, read.damage), ({"/poses": 4}, "a field is cut off"))
        self.assertEqual(self.read(whole[:second]).damage, "the file has no end")

    def test_a_wrong_checksum_is_damage(self):
        read = self.read(b"\x89MCAP0\r\n" + chunk(channel(1, "/poses"), "zstd", checksum=1))
        self.assertEqual((read.topics, read.damage), ({}, "a chunk is not as it was written"))

    def test_any_flipped_bits_are_damage_or_an_error_of_records(self):
        draw = random.Random(1)
        for compression in ("zstd", "") * 150:
            data = bytearray(sample(compression))
            for _ in range(draw.randint(1, 4)):
                data[draw.randrange(8, len(data))] ^= 1 << draw.randrange(8)
            try:
                read = self.read(bytes(data))
                for topic in read.topics:
                    read.columns(topic)
            except tether.RecordError:
                pass

    def test_frames_need_pandas(self):
        try:
            import pandas  # noqa: F401
        except ImportError:
            with self.assertRaisesRegex(ImportError, "python3-pandas"):
                self.read(sample()).frame("/poses")
        else:
            frame = self.read(sample()).frame("/poses")
            self.assertEqual(list(frame.columns), ["at_ns", "p_WB_m.0", "p_WB_m.1", "p_WB_m.2", "is_there", "uav"])
            self.assertEqual(frame["p_WB_m.0"].iloc[3], 3)


if __name__ == "__main__":
    unittest.main()
