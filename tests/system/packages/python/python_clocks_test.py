"""Programs in Python under other clocks: by counted work, and in several threads under tether-exec."""

import pathlib
import sys
import tempfile
import unittest

import tether

HERE = pathlib.Path(__file__).resolve().parent
EXAMPLE = HERE.parents[3] / "examples/python-face-anchor"


class PythonClocks(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def fly(self, out, command, more="", **options):
        file = self.folder / "own.toml"
        text = (EXAMPLE / "face_anchor.toml").read_text()
        self.assertIn('command = ["./face_anchor.py"]', text)
        file.write_text(text.replace('command = ["./face_anchor.py"]', f"command = {command}{more}"))
        return tether.run(file, out=self.folder / out, **options)

    def test_two_flights_by_counted_work_are_the_same_to_the_byte(self):
        records = []
        for out in ("first", "second"):
            flight = self.fly(out, f'["{sys.executable}", "{EXAMPLE / "face_anchor.py"}"]', condition="host",
                              target="counted_host", settings={"sut.parameters.tracker": "moments"})
            self.assertEqual(flight.outcome, "goal_reached", flight.reason + flight.log())
            records.append((flight.folder / "record.mcap").read_bytes())
        self.assertEqual(*records)

    def test_threads_read_side_by_side(self):
        flight = self.fly("out", f'["{HERE / "threads.py"}"]', "\nconcurrent = true", condition="wall")
        sut = flight.data["suts"][0]
        self.assertTrue(sut["finished"] and sut["reached_goal"], flight.reason + flight.log())
        self.assertAlmostEqual(sut["details"]["images"], 30, delta=6, msg="20 measurements of the IMU take a second")


if __name__ == "__main__":
    unittest.main()
