"""The package for Python in flight: from this tree and as it is installed."""

import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

import numpy as np
import tether

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[3]
EXAMPLE = ROOT / "examples/python-face-anchor"

IMAGE = "<horizontal_fov>1.2</horizontal_fov><image><width>64</width><height>48</height></image>"
SENSORS = f"""
<sensor name="rgbd" type="rgbd_camera"><update_rate>10</update_rate><camera>{IMAGE}
  <clip><near>0.05</near><far>50</far></clip><depth_camera><clip><near>0.3</near><far>8</far></clip></depth_camera>
</camera></sensor>
<sensor name="labels" type="segmentation_camera"><update_rate>10</update_rate><camera>{IMAGE}
  <clip><near>0.05</near><far>50</far></clip></camera></sensor>
<sensor name="lidar" type="lidar"><update_rate>10</update_rate><lidar>
  <scan><horizontal><samples>90</samples><min_angle>-1.5</min_angle><max_angle>1.5</max_angle></horizontal></scan>
  <range><min>0.1</min><max>20</max></range></lidar></sensor>
<sensor name="navsat" type="navsat"><update_rate>10</update_rate></sensor>
<sensor name="compass" type="magnetometer"><update_rate>10</update_rate></sensor>
<sensor name="barometer" type="air_pressure"><update_rate>10</update_rate></sensor>
"""
ODOMETRY = """<plugin filename="gz-sim-odometry-publisher-system" name="gz::sim::systems::OdometryPublisher">
<odom_publish_frequency>20</odom_publish_frequency></plugin>"""


def scenario(command, more=""):
    return f"""name = "python"
world = "room"
time_limit_s = 30
anchors = ["blue_box"]
[[uav]]
name = "uav1"
model = "uav/model.sdf"
profile = "paper_streaming"
position_m = [1.2, 0.0, 1.2]
energy = "hummingbird"
[sut]
command = ["{command}"]
[[condition]]
name = "scripted"
policy = "conservative_barrier"
clock = "scripted"
computing_ms = 0.1
[[condition]]
name = "target"
policy = "conservative_barrier"
clock = "cpu"
cpu_factor = 10.0
{more}"""


class Python(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def fly(self, program, condition):
        shutil.copytree(ROOT / "data/models/hummingbird", self.folder / "uav")
        model = self.folder / "uav/model.sdf"
        text = model.read_text()
        self.assertIn('<sensor name="range"', text)
        text = text.replace('<sensor name="range"', SENSORS + '<sensor name="range"')
        model.write_text(text.replace("</model>", ODOMETRY + "</model>"))
        file = self.folder / "python.toml"
        file.write_text(scenario(HERE / program))
        result = tether.run(file, condition=condition, out=self.folder / "out")
        self.assertTrue(result.data["suts"][0]["finished"], f"{result.reason}\n{result.log()}")
        self.assertTrue(result.data["audit"]["passed"], result.data["audit"])
        return result

    def test_every_sensor_and_every_command(self):
        result = self.fly("every_sensor.py", "scripted")
        self.assertEqual(result.data["this_run"].get("notes", []), [], "the program's exit code")
        self.assertTrue(result.data["suts"][0]["sut"].startswith("every_sensor"))
        record = result.record
        self.assertEqual(record.damage, "")
        seen = next(record.messages("/task/uav1"))["data"]
        self.assertAlmostEqual(seen["imu"], 9.81, delta=3)
        self.assertTrue(0.3 < seen["scan_m"] < 4)
        self.assertTrue(20e-6 < seen["field_T"] < 70e-6)
        self.assertTrue(0.9 < seen["charge"] <= 1)
        self.assertEqual(seen["anchor"], [0.4, 0.4, 0.4])
        # The odometry is the truth, as it has no noise.
        truth = record.columns("/ground_truth/uav1")
        nearest = np.linalg.norm(truth["p_WB_m"] - seen["p_WS"], axis=1).min()
        self.assertLess(nearest, 0.01)
        reads = record.columns("/interactions", kind="sensor")
        self.assertEqual(set(reads["sensor"]), {"camera", "imu", "rgbd", "labels", "lidar", "range", "navsat", "compass",
                                                "barometer", "odometry"})
        commands = record.columns("/interactions", kind="command")
        self.assertEqual(len(commands["st_s"]), 7, "what was refused is no interaction")
        self.assertEqual({stage["stage"] for stage in result.pace["stages"]} & {"pairs"}, {"pairs"})

    def test_only_what_follows_connect_is_charged(self):
        details = self.fly("charged.py", "target").data["suts"][0]["details"]
        self.assertGreater(details["before_s"], 0.01)
        self.assertLess(details["start_s"], 0.1, "the start of the interpreter, ten times slower")
        self.assertGreater(details["imported_s"], 0.2)

    def test_a_campaign_of_the_example_whose_fast_computer_reaches_the_goal_and_whose_slow_one_does_not(self):
        file = self.folder / "campaign.toml"
        file.write_text(f'name = "c"\ntrials = 1\n[[scenario]]\nfile = "{EXAMPLE / "face_anchor.toml"}"\n'
                        'conditions = ["host", "target"]\n')
        campaign = tether.campaign(file, out=self.folder / "campaign")
        fast, slow = campaign.results
        self.assertEqual(fast.outcome, "goal_reached", fast.reason + fast.log())
        self.assertEqual((slow.outcome, slow.exit_code), ("goal_missed", 1), slow.reason + slow.log())
        self.assertLess(slow.pace["read_hz"], 5)
        columns = campaign.columns()
        self.assertEqual([list(columns[name]) for name in ("condition", "seed", "outcome")],
                         [["host", "target"], [1, 1], ["goal_reached", "goal_missed"]])
        self.assertLess(columns["final_bearing_error"][0], 5)
        self.assertIn("“target”", campaign.answer)
        bearings = fast.record.columns("/task/uav1", topic="estimate")["data.bearing_rad"]
        self.assertGreater(bearings[0], 0.3)
        self.assertLess(abs(bearings[-1]), 0.036)

    def test_wrong_use_is_told_by_the_program(self):
        with self.assertRaisesRegex(tether.CommandError, "no_such_scenario") as raised:
            tether.run("no_such_scenario")
        self.assertEqual(raised.exception.exit_code, 2)

    def test_what_is_installed_finds_what_is_installed_beside_it(self):
        prefix = self.folder / "installed"
        for component in ("client", "python"):
            subprocess.run([os.environ["TETHER_CMAKE"], "--install", os.environ["TETHER_BINARY_DIR"], "--prefix", prefix,
                            "--component", component], check=True, stdout=subprocess.DEVNULL)
        package = prefix / "lib/python3/dist-packages"
        code = """import json, tether
tether.library_version()
print(json.dumps([tether.__file__, [line.split()[-1] for line in open("/proc/self/maps") if "tether-client" in line][0]]))"""
        clean = {name: value for name, value in os.environ.items() if not name.startswith("TETHER_")}
        out = subprocess.run([sys.executable, "-B", "-c", code], env={**clean, "PYTHONPATH": str(package)}, text=True,
                             stdout=subprocess.PIPE, check=True, cwd="/").stdout
        file, library = json.loads(out)
        self.assertTrue(file.startswith(str(package)), file)
        self.assertTrue(library.startswith(str(prefix)), library)
        self.assertTrue((package / "tether/py.typed").exists())
        self.assertTrue(os.access(prefix / "share/doc/python3-tether/examples/python-face-anchor/face_anchor.py", os.X_OK))


if __name__ == "__main__":
    unittest.main()
