"""Runs the cells of the example's notebook in their order, as a person does, and looks at what came of them."""

import atexit
import json
import os
import pathlib
import shutil
import sys
import tempfile
import unittest

FOLDER = pathlib.Path(__file__).resolve().parents[4] / "examples/python-face-anchor"

try:
    import matplotlib
except ImportError:
    print("skipped: install python3-matplotlib")
    sys.exit(77)
matplotlib.use("Agg")
tempfile.tempdir = tempfile.mkdtemp()
atexit.register(shutil.rmtree, tempfile.tempdir)  # after the flights, whose folders it has
os.chdir(FOLDER)


class Notebook(unittest.TestCase):
    def test_all_cells_run_and_the_slow_computer_tells_the_trackers_apart(self):
        notebook = json.loads((FOLDER / "compare_trackers.ipynb").read_text())
        cells = ["".join(cell["source"]) for cell in notebook["cells"] if cell["cell_type"] == "code"]
        names = {}
        for number, cell in enumerate(cells, 1):
            exec(compile(cell, f"code cell {number}", "exec"), names)
        self.assertEqual({key: flight.outcome for key, flight in names["flights"].items()}, {
            ("camshift", "host"): "goal_reached", ("camshift", "target"): "goal_missed",
            ("moments", "host"): "goal_reached", ("moments", "target"): "goal_reached"})
        # The estimates lie on the truth, so the plot's arithmetic is right.
        bearings, costs = (names["plt"].figure(number).axes for number in names["plt"].get_fignums())
        truth, estimates = bearings[0].lines[:2]
        error_deg = estimates.get_ydata() - names["np"].interp(estimates.get_xdata(), *truth.get_data())
        self.assertLess(abs(error_deg).max(), 6, "an image is some 0.1 s old, of a turn at 25 degrees a second")
        self.assertEqual(len(costs[0].patches), 4)


if __name__ == "__main__":
    unittest.main()
