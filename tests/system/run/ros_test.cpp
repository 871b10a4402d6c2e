#include "support/trials.h"

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

/// Nodes of ROS 1 fly as they are, if ROS is installed.
namespace tether::system_test {
namespace {

const std::string kExamples = TETHER_SOURCE_DIR "/examples/";

class Ros1 : public testing::Test {
 protected:
  void SetUp() override { need("cv2, cv_bridge", "python3-cv-bridge and python3-opencv"); }
  static void need(const std::string& modules, const std::string& packages) {
    const std::string needed = "import geometry_msgs.msg, roslaunch, rospy, " + modules;
    if (run({{"/usr/bin/python3", "-c", needed}}).code != 0)
      GTEST_SKIP() << "needs Debian's python3-roslaunch, " << packages;
  }
  Output fly(const std::string& flight, const std::string& condition = "host") const {
    const auto library =
        std::filesystem::path(TETHER_EXEC_PROGRAM).parent_path().parent_path() / "lib";
    return run(with(tether({"run", flight, "--quiet", "--force", "--condition", condition, "--out",
                            folder_ / "out"}),
                    {},
                    {{"PYTHONPATH", TETHER_SOURCE_DIR "/python"},
                     {"TETHER_CLIENT_LIBRARY", library / "libtether-client.so.1"}}));
  }
  std::string said() const { return read_text(folder_ / "out" / "sut-uav1.log"); }
  /// From an image or a scan to its command, each as the node says: "… 29.87 ms".
  std::vector<double> latencies_ms() const {
    std::vector<double> all;
    std::istringstream lines(said());
    for (std::string line; std::getline(lines, line);)
      if (line.ends_with(" ms"))
        all.push_back(std::stod(line.substr(line.rfind(' ', line.size() - 4))));
    std::ranges::sort(all);
    return all;
  }

  TempFolder folder_;
};

const std::string kFaceBox = kExamples + "ros1-face-box/face_box.toml";

TEST_F(Ros1, NodesFaceABoxAndOnASlowComputerTheyDoNot) {
  const Output fast = fly(kFaceBox);
  EXPECT_EQ(fast.code, 0) << fast.err << said();
  EXPECT_EQ(audit_code(folder_ / "out"), 0);
  const std::vector<double> on_fast = latencies_ms();
  ASSERT_GT(on_fast.size(), 20U) << said();
  const Output slow = fly(kFaceBox, "target");
  EXPECT_EQ(slow.code, 1) << slow.err << said();
  EXPECT_EQ(audit_code(folder_ / "out"), 0);
  const std::vector<double> on_slow = latencies_ms();
  ASSERT_GT(on_slow.size(), 10U) << said();
  // The slow computer also waits for images that queue up.
  EXPECT_GT(on_slow[on_slow.size() / 2], 5.0 * on_fast[on_fast.size() / 2]);
}

// --- by the driver, without a flight controller -------------------------------------------------

class Ros1Driver : public Ros1 {
 protected:
  void SetUp() override {
    need("message_filters, nav_msgs.msg, sensor_msgs.msg, tf2_ros, numpy",
         "python3-message-filters, python3-nav-msgs, python3-sensor-msgs, python3-tf2-ros and "
         "python3-numpy");
  }
  /// One that has each kind of sensor, with the driver and `probe` as its nodes. A clock of 0 Hz:
  /// there is no /clock.
  std::string write_flight(int clock_hz, const std::string& probe) const;
};

TEST_F(Ros1Driver, ANodeKeepsItsDistanceAndOnASlowComputerItDoesNot) {
  const std::string wall = kExamples + "ros1-driver/wall.toml";
  const Output fast = fly(wall);
  EXPECT_EQ(fast.code, 0) << fast.err << said();
  EXPECT_EQ(audit_code(folder_ / "out"), 0);
  EXPECT_GT(latencies_ms().size(), 40U) << said();
  const Output slow = fly(wall, "target");
  EXPECT_EQ(slow.code, 1) << slow.err << said();
  EXPECT_EQ(audit_code(folder_ / "out"), 0);
}

const char* const kUav = R"(<sdf version="1.9"><model name="every">
  <include merge="true"><uri>model://hummingbird_gimbal</uri></include>
  <link name="more"><pose>0 0 0.06 0 0 0</pose>
    <sensor name="depth" type="rgbd_camera"><update_rate>10</update_rate>
      <camera><horizontal_fov>1.2</horizontal_fov><image><width>80</width><height>60</height></image>
        <clip><near>0.05</near><far>50</far></clip></camera></sensor>
    <sensor name="labels" type="segmentation_camera"><update_rate>10</update_rate>
      <camera><horizontal_fov>1.2</horizontal_fov><image><width>80</width><height>60</height></image>
        <clip><near>0.05</near><far>50</far></clip></camera></sensor>
    <sensor name="lidar" type="gpu_lidar"><update_rate>20</update_rate>
      <lidar><scan><horizontal><samples>91</samples><resolution>1</resolution>
          <min_angle>-1.57</min_angle><max_angle>1.57</max_angle></horizontal></scan>
        <range><min>0.1</min><max>10</max></range></lidar></sensor>
    <sensor name="lidar3" type="gpu_lidar"><update_rate>10</update_rate>
      <lidar><scan><horizontal><samples>91</samples><resolution>1</resolution>
          <min_angle>-1.57</min_angle><max_angle>1.57</max_angle></horizontal>
          <vertical><samples>4</samples><resolution>1</resolution>
          <min_angle>-0.2</min_angle><max_angle>0.2</max_angle></vertical></scan>
        <range><min>0.1</min><max>10</max></range></lidar></sensor>
    <sensor name="magnetometer" type="magnetometer"><update_rate>50</update_rate></sensor>
    <sensor name="barometer" type="air_pressure"><update_rate>25</update_rate></sensor>
    <sensor name="gnss" type="navsat"><update_rate>5</update_rate></sensor>
  </link>
  <joint name="more_joint" type="fixed"><parent>base_link</parent><child>more</child></joint>
  <plugin filename="gz-sim-odometry-publisher-system" name="gz::sim::systems::OdometryPublisher">
    <odom_publish_frequency>100</odom_publish_frequency></plugin>
</model></sdf>)";

std::string Ros1Driver::write_flight(int clock_hz, const std::string& probe) const {
  write_text(folder_ / "uav.sdf", kUav);
  const std::string world = R"(<world name="yard">)";
  write_text(folder_ / "place.sdf",
             substituted(read_text(TETHER_SOURCE_DIR "/data/worlds/yard.sdf"),
                         {{world, world + R"(<spherical_coordinates>
<surface_model>EARTH_WGS84</surface_model><world_frame_orientation>ENU</world_frame_orientation>
<latitude_deg>47.4</latitude_deg><longitude_deg>8.5</longitude_deg><elevation>500</elevation>
</spherical_coordinates>)"}}));
  write_text(folder_ / "probe.py", probe);
  const std::string is_simulated = clock_hz > 0 ? "true" : "false";
  write_text(folder_ / "start.sh",
             "cd \"$(dirname \"$0\")\"\n"
             "export ROS_MASTER_URI=http://127.0.0.1:$((11311 + $$ % 1000)) ROS_IP=127.0.0.1\n"
             "export ROS_LOG_DIR=$PWD\nroscore -p ${ROS_MASTER_URI##*:} &\n"
             "until rosparam set use_sim_time " +
                 is_simulated + " 2> /dev/null; do sleep 0.1; done\n" + kExamples +
                 "ros1-driver/driver.py _clock:=" + std::to_string(clock_hz) +
                 " &\ndriver=$!\n/usr/bin/python3 probe.py || exit 1\n"
                 "kill $driver\nwait $driver\n");
  write_text(folder_ / "every.toml", substituted(R"(name = "every"
world = "place.sdf"
time_limit_s = 40
[[uav]]
name = "uav1"
model = "uav.sdf"
energy = "hummingbird"
position_m = [-3.0, 3.0, 1.5]
[uav.sensors.joint_state]
kind = "joint_state"
timing = "periodic"
rate_hz = 50
[sut]
command = ["/bin/bash", "START"]
as_is = true
all_processes = true
[[condition]]
name = "host"
policy = "conservative_barrier"
clock = "cpu"
)",
                                                 {{"START", (folder_ / "start.sh").string()}}));
  return folder_ / "every.toml";
}

// Stamps are those of the program's own clock: frames are known at each scan's instant, and
// messages are not older than the simulation and the other nodes make them, nor from the future by
// more than a period of the clock.
const char* const kProbe = R"(
import math, rospy, tf2_ros, message_filters
from geometry_msgs.msg import Twist, TwistStamped
from nav_msgs.msg import Odometry
from sensor_msgs.msg import *
TOPICS = {"camera/image_raw": (Image, 30), "camera/camera_info": (CameraInfo, 30), "depth/image_raw": (Image, 10),
          "depth/depth/image_raw": (Image, 10), "labels/labels/image_raw": (Image, 10), "imu/data": (Imu, 20),
          "range": (Range, 30), "scan": (LaserScan, 20), "points": (PointCloud2, 10), "fix": (NavSatFix, 5),
          "fix_velocity": (TwistStamped, 5), "imu/mag": (MagneticField, 50), "pressure": (FluidPressure, 25),
          "odom": (Odometry, 100), "joint_states": (JointState, 50), "battery_state": (BatteryState, 1)}
rospy.init_node("probe")
ages_s, last, together = {name: [] for name in TOPICS}, {}, []
def hear(message, name):
    ages_s[name].append((rospy.Time.now() - message.header.stamp).to_sec())
    last[name] = message
frames = tf2_ros.Buffer()
listener = tf2_ros.TransformListener(frames)
for name, (kind, _) in TOPICS.items():
    rospy.Subscriber(name, kind, hear, name, buff_size=2**24)
pair = message_filters.ApproximateTimeSynchronizer([message_filters.Subscriber("scan", LaserScan),
                                                    message_filters.Subscriber("odom", Odometry)], 20, 0.02)
pair.registerCallback(lambda scan, odom: together.append(odom))
command = rospy.Publisher("cmd_vel", Twist, queue_size=1)
while len(last) < len(TOPICS):
    rospy.sleep(0.1)
for ages in [together, *ages_s.values()]:
    ages.clear()
begin_m = last["odom"].pose.pose.position.x
ahead = Twist()
ahead.linear.x = 0.5
command.publish(ahead)
rospy.sleep(3)
for name, (_, rate_hz) in TOPICS.items():
    ages = sorted(ages_s[name])
    assert 0.8 <= len(ages) / (3 * rate_hz) <= 1.4, (name, len(ages))
    assert -0.02 < ages[0] and ages[len(ages) // 2] < 0.06, (name, ages)
assert 1 < last["odom"].pose.pose.position.x - begin_m < 1.6
assert len(together) > 50, len(together)
for frame in ("camera_optical", "gimbal_camera_optical", "lidar"):
    assert frames.can_transform("odom", frame, last["scan"].header.stamp, rospy.Duration(0.5)), frame
down = frames.lookup_transform("base_link", "camera_optical", rospy.Time(0)).transform.rotation
assert max(abs(a - b) for a, b in zip((down.x, down.y, down.z, down.w), (-0.5, 0.5, -0.5, 0.5))) < 1e-6
assert last["depth/depth/image_raw"].encoding == "32FC1" and last["labels/labels/image_raw"].encoding == "mono16"
assert abs(last["imu/data"].linear_acceleration.z - 9.8) < 1 and last["battery_state"].current < 0
)";

TEST_F(Ros1Driver, EachSensorHasItsTopicWithTheStampsOfEitherClock) {
  for (const int clock_hz : {0, 100}) {
    const Output output = fly(write_flight(clock_hz, kProbe));
    EXPECT_EQ(output.code, 0) << output.err << said();
    EXPECT_EQ(audit_code(folder_ / "out"), 0);
  }
}

}  // namespace
}  // namespace tether::system_test
