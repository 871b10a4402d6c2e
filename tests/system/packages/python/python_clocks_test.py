"""An interpreter by counted work: the program's flights are the same to the byte."""

import pathlib
import sys
import tempfile
import unittest

import tether

EXAMPLE = pathlib.Path(__file__).resolve().parents[4] / "examples/python-face-anchor"


class CountedPython(unittest.TestCase):
    def test_two_flights_are_the_same_to_the_byte(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "counted.toml"
            text = (EXAMPLE / "face_anchor.toml").read_text()
            file.write_text(text.replace('"./face_anchor.py"', f'"{sys.executable}", "{EXAMPLE / "face_anchor.py"}"'))
            records = []
            for name in ("first", "second"):
                flight = tether.run(file, condition="host", target="counted_host", out=pathlib.Path(folder) / name,
                                    settings={"sut.parameters.tracker": "moments"})
                self.assertEqual(flight.outcome, "goal_reached", flight.reason + flight.log())
                records.append((flight.folder / "record.mcap").read_bytes())
            self.assertEqual(*records)


if __name__ == "__main__":
    unittest.main()
