"""The driver for ROS 2 in flight: Fast DDS takes its topics, and other code decodes them.

ros2_test.py TETHER DRIVER PEER FOLDER. Exit code 77: npm cannot fetch the decoder.
"""

import json
import math
import pathlib
import shutil
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[3]

IMAGE = "<horizontal_fov>1.2</horizontal_fov><image><width>64</width><height>48</height></image>"
SENSORS = f"""
<sensor name="rgbd" type="rgbd_camera"><update_rate>10</update_rate><camera>{IMAGE}
  <clip><near>0.05</near><far>50</far></clip><depth_camera><clip><near>0.3</near><far>8</far></clip></depth_camera>
</camera></sensor>
<sensor name="lidar" type="lidar"><update_rate>10</update_rate><lidar>
  <scan><horizontal><samples>90</samples><min_angle>-1.5</min_angle><max_angle>1.5</max_angle></horizontal></scan>
  <range><min>0.1</min><max>20</max></range></lidar></sensor>
<sensor name="lidar3" type="lidar"><update_rate>5</update_rate><lidar>
  <scan><horizontal><samples>20</samples><min_angle>-1</min_angle><max_angle>1</max_angle></horizontal>
  <vertical><samples>4</samples><min_angle>-0.3</min_angle><max_angle>0.3</max_angle></vertical></scan>
  <range><min>0.1</min><max>20</max></range></lidar></sensor>
<sensor name="gnss" type="navsat"><update_rate>10</update_rate></sensor>
<sensor name="compass" type="magnetometer"><update_rate>10</update_rate></sensor>
<sensor name="barometer" type="air_pressure"><update_rate>10</update_rate></sensor>
"""
ODOMETRY = """<plugin filename="gz-sim-odometry-publisher-system" name="gz::sim::systems::OdometryPublisher">
<odom_publish_frequency>20</odom_publish_frequency></plugin>"""
TYPES = {
    "camera/image_raw": "sensor_msgs/Image", "camera/camera_info": "sensor_msgs/CameraInfo",
    "rgbd/image_raw": "sensor_msgs/Image", "rgbd/depth/image_raw": "sensor_msgs/Image", "imu/data": "sensor_msgs/Imu",
    "range": "sensor_msgs/Range", "scan": "sensor_msgs/LaserScan", "lidar3/points": "sensor_msgs/PointCloud2",
    "fix": "sensor_msgs/NavSatFix", "fix_velocity": "geometry_msgs/TwistStamped",
    "imu/mag": "sensor_msgs/MagneticField", "pressure": "sensor_msgs/FluidPressure", "odom": "nav_msgs/Odometry",
    "tf": "tf2_msgs/TFMessage", "tf_static": "tf2_msgs/TFMessage",
}  # fmt: skip
SECONDS = 3
EPOCH_S = 1767225600  # 2026-01-01, when the clock of programs as they are begins


def fly(tether, driver, peer, folder):
    shutil.rmtree(folder / "uav", ignore_errors=True)
    shutil.copytree(ROOT / "data/models/hummingbird", folder / "uav")
    model = folder / "uav/model.sdf"
    text = model.read_text().replace('<sensor name="range"', SENSORS + '<sensor name="range"')
    model.write_text(text.replace("</model>", ODOMETRY + "</model>"))
    topics = " ".join(f"{name} {kind.replace('/', '::msg::dds_::')}_" for name, kind in TYPES.items())
    (folder / "start.sh").write_text(f"#!/bin/sh\n{driver} &\n{peer} {SECONDS} {topics}\n")
    (folder / "ros2.toml").write_text(f"""name = "ros2"
world = "room"
time_limit_s = 30
[[uav]]
name = "uav1"
model = "uav/model.sdf"
profile = "paper_streaming"
position_m = [1.2, 0.0, 1.2]
[sut]
command = ["/bin/sh", "{folder}/start.sh"]
as_is = true
all_processes = true
[[condition]]
name = "host"
policy = "conservative_barrier"
clock = "cpu"
cpu_factor = 1.0
""")
    subprocess.run([tether, "run", folder / "ros2.toml", "--quiet", "--force", "--out", folder / "out"], check=True)
    subprocess.run([tether, "audit", folder / "out/record.mcap"], check=True, stdout=subprocess.DEVNULL)
    return (folder / "out/sut-uav1.log").read_text()


def decode(release, lines, folder):
    (folder / "types.json").write_text(json.dumps(TYPES))
    done = subprocess.run(["node", "decode.mjs", release, "types.json"], cwd=folder, input=lines, text=True, check=True,
                          stdout=subprocess.PIPE)
    return json.loads(done.stdout)


def check(heard):
    for topic, of in heard.items():
        assert of["count"] >= (1 if topic == "tf_static" else SECONDS * 3), (topic, of["count"])
        if "header" in of["last"]:
            stamp = of["last"]["header"]["stamp"]
            at_s = stamp["sec"] - EPOCH_S + stamp["nanosec"] * 1e-9
            # Parts of large images can get lost, for which the reader waits.
            earliest_s = 0.5 if topic == "camera/image_raw" else SECONDS - 0.5
            assert earliest_s < at_s < SECONDS + 2, (topic, at_s)
    last = {topic: of["last"] for topic, of in heard.items()}
    image, lens = last["camera/image_raw"], last["camera/camera_info"]
    assert (image["width"], image["height"], image["encoding"]) == (640, 480, "rgb8"), image
    assert image["data"]["length"] == 640 * 480 * 3 and lens["header"]["frame_id"] == "camera_optical"
    assert lens["k"][0] == lens["p"][0] > 100 and lens["distortion_model"] == "plumb_bob", lens
    depth = last["rgbd/depth/image_raw"]
    assert (depth["step"], depth["encoding"], depth["data"]["length"]) == (256, "32FC1", 256 * 48), depth
    force = last["imu/data"]["linear_acceleration"]
    assert 7 < math.hypot(force["x"], force["y"], force["z"]) < 13, force
    scan, points = last["scan"], last["lidar3/points"]
    assert len(scan["ranges"]) == 90 and abs(scan["angle_increment"] - 3 / 89) < 1e-6, scan
    assert (points["height"], points["width"], points["row_step"]) == (4, 20, 240), points
    assert [field["name"] for field in points["fields"]] == ["x", "y", "z"] and points["data"]["length"] == 960
    assert last["fix"]["status"]["status"] == 0 and last["fix"]["position_covariance_type"] == 2, last["fix"]
    assert 1e-5 < math.hypot(*last["imu/mag"]["magnetic_field"].values()) < 1e-4, last["imu/mag"]
    assert 9e4 < last["pressure"]["fluid_pressure"] < 1.1e5, last["pressure"]
    # It climbs as it was told, and each of its sensors says so.
    begin, end = (heard["odom"][when]["pose"]["pose"]["position"]["z"] for when in ("first", "last"))
    assert end - begin > 0.5, (begin, end)
    assert abs(last["odom"]["twist"]["twist"]["linear"]["z"] - 0.5) < 0.1, last["odom"]["twist"]
    assert abs(last["fix_velocity"]["twist"]["linear"]["z"] - 0.5) < 0.3, last["fix_velocity"]
    body = last["tf"]["transforms"][0]
    assert (body["header"]["frame_id"], body["child_frame_id"]) == ("odom", "base_link"), body
    assert abs(body["transform"]["translation"]["z"] - end) < 0.1, (body, end)
    frames = {(edge["header"]["frame_id"], edge["child_frame_id"]) for edge in last["tf_static"]["transforms"]}
    assert {("base_link", "camera"), ("camera", "camera_optical"), ("base_link", "lidar3")} <= frames, frames


def main():
    tether, driver, peer, folder = sys.argv[1:4] + [pathlib.Path(sys.argv[4]).resolve()]
    folder.mkdir(parents=True, exist_ok=True)
    for name in ("package.json", "package-lock.json", ".npmrc", "decode.mjs"):
        shutil.copy(HERE / name, folder)
    if not (folder / "node_modules/@foxglove").exists() and subprocess.run(["npm", "ci", "--silent"], cwd=folder).returncode:
        print("skipped: npm cannot fetch @foxglove/rosmsg2-serialization")
        return 77
    lines = fly(tether, driver, peer, folder)
    for release in ("ros2humble", "ros2jazzy"):
        check(decode(release, lines, folder))
    return 0


if __name__ == "__main__":
    sys.exit(main())
