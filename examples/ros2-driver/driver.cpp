// Makes the UAV a robot of ROS 2: its sensors are topics, and topics command it. It speaks DDS as
// ROS 2's nodes do, so ROS 2 itself is not needed to build it.
//
// An ordinary program on Tether's library. Start it beside your nodes, as the drivers on the UAV.
// Each sensor has a thread of the library, which calls what fills and writes its messages; the
// first thread takes commands. Frames are those of REP 103 and 105.
#include "dds.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <tether/client.hpp>

namespace {

namespace api = tether::api;
using ros2::lend;
using ros2::Publisher;
using std::string;

// --- vectors and rotations
// ------------------------------------------------------------------------

geometry_msgs_msg_dds__Vector3_ vector(const api::Vec3& v) {
  return {v.x, v.y, v.z};
}

geometry_msgs_msg_dds__Quaternion_ quaternion(const api::Quat& q) {
  return {q.x, q.y, q.z, q.w};
}

api::Quat product(const api::Quat& a, const api::Quat& b) {
  return {
      a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
      a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}

api::Quat inverse(const api::Quat& q) {
  return {q.w, -q.x, -q.y, -q.z};
}

api::Vec3 rotate(const api::Quat& q, const api::Vec3& v) {
  const api::Quat turned = product(product(q, {0.0, v.x, v.y, v.z}), inverse(q));
  return {turned.x, turned.y, turned.z};
}

double square(double x) {
  return x * x;
}

/// Right, down, ahead in ahead, left, up.
constexpr api::Quat kOpticalInCamera{0.5, -0.5, 0.5, -0.5};

const string kOdom = "odom", kBody = "base_link";

// --- the driver
// -----------------------------------------------------------------------------------

class Driver {
 public:
  Driver(api::Vehicle& vehicle, dds_entity_t participant)
      : vehicle_(vehicle),
        participant_(participant),
        tf_(participant, "tf"),
        static_tf_(participant, "tf_static", true) {
    using namespace std::chrono;
    // What the clock of the system shows when ST begins.
    epoch_ = duration_cast<nanoseconds>(system_clock::now().time_since_epoch()) -
             vehicle.now().time_since_epoch();
  }

  void start() {
    std::array<bool, 16> seen{};
    for (std::size_t i = 0; i < vehicle_.sensor_count(); ++i) {
      const api::Sensor sensor = *vehicle_.sensor_at(i);
      add_mounting(sensor);
      if (sensor.rate_hz() <= 0.0) {
        std::fprintf(stderr,
                     "ros2_driver: '%s' has no topic: it measures on demand. Give it a rate in the "
                     "profile\n",
                     sensor.name());
        continue;
      }
      const auto kind = static_cast<std::size_t>(sensor.kind());
      const bool is_first = kind < seen.size() && !std::exchange(seen[kind], true);
      begin(sensor, is_first ? "" : string(sensor.name()) + "/", is_first);
    }
    publish(static_tf_, mountings_);
  }

  /// Until the run ends.
  void take_commands() {
    const auto velocity = ros2::make_reader<ros2::Twist>(participant_, "cmd_vel");
    const auto stamped = ros2::make_reader<ros2::TwistStamped>(participant_, "cmd_vel_stamped");
    const auto pose = ros2::make_reader<ros2::PoseStamped>(participant_, "command/pose");
    const dds_entity_t any = dds_create_waitset(participant_);
    for (const dds_entity_t reader : {velocity, stamped, pose})
      dds_waitset_attach(any, dds_create_readcondition(reader, DDS_ANY_STATE), 0);
    while (!has_ended_) {
      dds_waitset_wait(any, nullptr, 0, DDS_MSECS(200));
      ros2::take<ros2::Twist>(velocity, [&](const auto& m) { fly(m, true); });
      ros2::take<ros2::TwistStamped>(stamped, [&](const auto& m) {
        if (knows(m.header.frame_id, {"", kBody, kOdom})) fly(m.twist, m.header.frame_id != kOdom);
      });
      ros2::take<ros2::PoseStamped>(pose, [&](const auto& m) {
        if (knows(m.header.frame_id, {"", kOdom})) fly_to(m.pose);
      });
      for (const auto& one : subscriptions_) heed(one.status());
    }
  }

 private:
  /// `frame` must outlive the message.
  ros2::Header header(std::int64_t sampled_at_ns, const string& frame) const {
    constexpr std::int64_t kSecond = 1'000'000'000;
    const std::int64_t ns = epoch_.count() + sampled_at_ns;
    return {{static_cast<std::int32_t>(ns / kSecond), static_cast<std::uint32_t>(ns % kSecond)},
            lend(frame)};
  }

  void keep(api::Result<api::Subscription> subscription) {
    if (!subscription) ros2::fail(subscription.failure().message());
    subscriptions_.push_back(*std::move(subscription));
  }

  /// What is called with a sample: `fill(sample, message)`, and the message goes out.
  template <class Message, class Fill>
  auto to(const string& topic, const string& frame, Fill fill) {
    return [this, frame, fill, to = Publisher<Message>(participant_, topic)](const auto& sample) {
      Message message{};
      message.header = header(sample.sampled_at_ns, frame);
      fill(sample, message);
      to.publish(message);
    };
  }

  void begin(const api::Sensor& sensor, const string& place, bool is_first);
  void begin_camera(const api::Sensor& sensor);
  void begin_scan(const api::Sensor& sensor, const string& place);
  void begin_points(const api::Sensor& sensor, const string& place);
  void begin_odometry(const api::Sensor& sensor, const string& place, bool moves_body);

  // --- frames ---

  struct Edge {
    string parent, child;
    api::Pose X_PC;
    std::int64_t at_ns = 0;
  };
  void publish(const Publisher<ros2::TFMessage>& where, const std::vector<Edge>& edges) const {
    std::vector<ros2::TransformStamped> all;
    for (const Edge& e : edges)
      all.push_back({header(e.at_ns, e.parent),
                     lend(e.child),
                     {vector(e.X_PC.position_m), quaternion(e.X_PC.attitude)}});
    ros2::TFMessage tree{};
    lend(tree.transforms, all);
    where.publish(tree);
  }
  // Sensors that joints turn have no frame: where they are changes.
  void add_mounting(const api::Sensor& sensor) {
    if (sensor.joints() > 0) return;
    const string name = sensor.name();
    mountings_.push_back({kBody, name, sensor.mounting()});
    if (sensor.camera_model())
      mountings_.push_back({name, name + "_optical", {{}, kOpticalInCamera}});
  }

  // --- commands ---

  static bool knows(const string& frame, const std::vector<string>& known) {
    if (std::find(known.begin(), known.end(), frame) != known.end()) return true;
    std::fprintf(stderr, "ros2_driver: a command in the frame '%s' is refused\n", frame.c_str());
    return false;
  }
  void fly(const ros2::Twist& twist, bool in_heading) {
    api::Setpoint setpoint{};
    setpoint.mask = TETHER_VELOCITY | TETHER_YAW_RATE;
    setpoint.in_heading = in_heading ? 1 : 0;
    setpoint.velocity_m_s = {twist.linear.x, twist.linear.y, twist.linear.z};
    setpoint.yaw_rate_rad_s = twist.angular.z;
    heed(vehicle_.command(setpoint));
  }
  void fly_to(const geometry_msgs_msg_dds__Pose_& pose) {
    const auto& [x, y, z, w] = pose.orientation;
    api::Setpoint setpoint{};
    setpoint.mask = TETHER_POSITION | TETHER_YAW;
    setpoint.position_W_m = {pose.position.x, pose.position.y, pose.position.z};
    setpoint.yaw_rad = std::atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z));
    heed(vehicle_.command(setpoint));
  }
  /// A command that is refused ends nothing.
  void heed(const api::Status& status) {
    if (status) return;
    if (status.failure().code() == api::Code::kInvalid)
      std::fprintf(stderr, "ros2_driver: %s\n", status.failure().message());
    else
      has_ended_ = true;
  }

  api::Vehicle& vehicle_;
  dds_entity_t participant_;
  Publisher<ros2::TFMessage> tf_, static_tf_;
  std::chrono::nanoseconds epoch_{0};
  std::vector<Edge> mountings_;
  std::atomic<bool> has_ended_ = false;
  std::vector<api::Subscription> subscriptions_;
};

// --- one case for each kind
// -----------------------------------------------------------------------

void Driver::begin(const api::Sensor& sensor, const string& place, bool is_first) {
  const char* const name = sensor.name();
  switch (sensor.kind()) {
    case api::SensorKind::kImu:
      return keep(vehicle_.subscribe_imu(
          name, to<ros2::Imu>(place + "imu/data", name, [](const auto& s, ros2::Imu& m) {
            m.angular_velocity = vector(s.angular_velocity_rad_s);
            m.linear_acceleration = vector(s.specific_force_m_s2);
            if (std::isnan(s.q_WS.w))
              m.orientation_covariance[0] = -1.0;  // there is none
            else
              m.orientation = quaternion(s.q_WS);
          })));
    case api::SensorKind::kRange:
      return keep(vehicle_.subscribe_range(
          name, to<ros2::Range>(place + "range", name,
                                [limits = *sensor.range_limits()](const auto& s, ros2::Range& m) {
                                  m.radiation_type = 1;  // infrared
                                  m.min_range = static_cast<float>(limits.min_m);
                                  m.max_range = static_cast<float>(limits.max_m);
                                  m.range = static_cast<float>(s.range_m);
                                })));
    case api::SensorKind::kNavSat:
      return keep(vehicle_.subscribe_navsat(
          name, [fix = to<ros2::NavSatFix>(place + "fix", name,
                                           [](const auto& s, ros2::NavSatFix& m) {
                                             constexpr std::uint8_t kNoFix = 255,
                                                                    kFix = 0;  // -1 as a byte
                                             m.status = {s.has_fix != 0 ? kFix : kNoFix, 1};
                                             m.latitude = s.latitude_deg;
                                             m.longitude = s.longitude_deg;
                                             m.altitude = s.altitude_m;
                                             if (s.has_fix == 0) return;
                                             m.position_covariance[0] = m.position_covariance[4] =
                                                 square(s.horizontal_accuracy_m);
                                             m.position_covariance[8] =
                                                 square(s.vertical_accuracy_m);
                                             m.position_covariance_type =
                                                 2;  // the diagonal is known
                                           }),
                 velocity = to<ros2::TwistStamped>(place + "fix_velocity", kOdom,
                                                   [](const auto& s, ros2::TwistStamped& m) {
                                                     m.twist.linear = vector(s.velocity_ENU_m_s);
                                                   })](const auto& sample) {
            fix(sample);
            velocity(sample);
          }));
    case api::SensorKind::kMagnetometer:
      return keep(vehicle_.subscribe_magnetometer(
          name, to<ros2::MagneticField>(place + "imu/mag", name,
                                        [](const auto& s, ros2::MagneticField& m) {
                                          m.magnetic_field = vector(s.field_T);
                                        })));
    case api::SensorKind::kBarometer:
      return keep(vehicle_.subscribe_barometer(
          name, to<ros2::FluidPressure>(place + "pressure", name,
                                        [](const auto& s, ros2::FluidPressure& m) {
                                          m.fluid_pressure = s.pressure_Pa;
                                        })));
    case api::SensorKind::kOdometry:
      return begin_odometry(sensor, place, is_first);
    case api::SensorKind::kScan:
      return begin_scan(sensor, place);
    default:
      break;
  }
  if (sensor.camera_model()) return begin_camera(sensor);
  std::fprintf(stderr, "ros2_driver: '%s' has no topic\n", name);
}

void Driver::begin_camera(const api::Sensor& sensor) {
  const string name = sensor.name(), frame = name + "_optical";
  const auto images = [&](const string& folder) {
    return Publisher<ros2::Image>(participant_, name + "/" + folder + "image_raw");
  };
  keep(vehicle_.subscribe_camera(
      sensor.name(), [this, frame, lens = *sensor.camera_model(), color = images(""),
                      depth = images("depth/"), labels = images("labels/"),
                      info = Publisher<ros2::CameraInfo>(participant_, name + "/camera_info")](
                         const api::ImageView& image) {
        const ros2::Header at = header(image.sampled_at().time_since_epoch().count(), frame);
        const auto width = static_cast<std::uint32_t>(lens.width_px);
        const auto height = static_cast<std::uint32_t>(lens.height_px);
        const auto publish = [&](const Publisher<ros2::Image>& where, const void* pixels,
                                 std::uint32_t bytes_of_pixel, const string& encoding) {
          if (pixels == nullptr || !where.is_wanted()) return;
          ros2::Image m{at, height, width, lend(encoding), 0, width * bytes_of_pixel, {}};
          lend(m.data, pixels, std::size_t{m.step} * height);
          where.publish(m);
        };
        publish(color, image.rgb(), 3, "rgb8");
        publish(depth, image.depth_m(), 4, "32FC1");
        publish(labels, image.labels(), 2, "mono16");
        const std::vector<double> distortion = {lens.k1, lens.k2, lens.p1, lens.p2, lens.k3};
        const string model = "plumb_bob";
        ros2::CameraInfo m{};
        m.header = at;
        m.height = height;
        m.width = width;
        m.distortion_model = lend(model);
        lend(m.d, distortion);
        m.k[0] = m.p[0] = lens.fx_px;
        m.k[2] = m.p[2] = lens.cx_px;
        m.k[4] = m.p[5] = lens.fy_px;
        m.k[5] = m.p[6] = lens.cy_px;
        m.k[8] = m.p[10] = m.r[0] = m.r[4] = m.r[8] = 1.0;
        info.publish(m);
      }));
}

double step_rad(const api::ScanModel& rays) {
  return (rays.max_azimuth_rad - rays.min_azimuth_rad) / std::max(1, rays.columns - 1);
}

// Stamped with the time of its first ray.
void Driver::begin_scan(const api::Sensor& sensor, const string& place) {
  const api::ScanModel rays = *sensor.scan_model();
  if (rays.rows > 1 || rays.min_elevation_rad != 0.0) return begin_points(sensor, place);
  keep(vehicle_.subscribe_scan(
      sensor.name(),
      [this, rays, frame = string(sensor.name()), rate_hz = sensor.rate_hz(),
       where = Publisher<ros2::LaserScan>(participant_, place + "scan")](const api::Scan& scan) {
        ros2::LaserScan m{};
        m.header = header(scan.sampled_at_ns - std::llround(rays.sweep_s * 1e9), frame);
        m.angle_min = static_cast<float>(rays.min_azimuth_rad);
        m.angle_max = static_cast<float>(rays.max_azimuth_rad);
        m.angle_increment = static_cast<float>(step_rad(rays));
        m.time_increment = static_cast<float>(rays.sweep_s / std::max(1, rays.columns - 1));
        m.scan_time = static_cast<float>(1.0 / rate_hz);
        m.range_min = static_cast<float>(rays.min_m);
        m.range_max = static_cast<float>(rays.max_m);
        lend(m.ranges, scan.ranges_m, scan.rays);
        if (scan.intensities != nullptr) lend(m.intensities, scan.intensities, scan.rays);
        where.publish(m);
      }));
}

// Rays that see nothing are NaN, so that rows and columns stay.
void Driver::begin_points(const api::Sensor& sensor, const string& place) {
  const api::ScanModel rays = *sensor.scan_model();
  std::vector<std::array<float, 3>> directions;
  for (int row = 0; row < rays.rows; ++row)
    for (int column = 0; column < rays.columns; ++column) {
      const double rise = rays.max_elevation_rad - rays.min_elevation_rad;
      const double up = rays.min_elevation_rad + row * rise / std::max(1, rays.rows - 1);
      const double turn = rays.min_azimuth_rad + column * step_rad(rays);
      directions.push_back({static_cast<float>(std::cos(up) * std::cos(turn)),
                            static_cast<float>(std::cos(up) * std::sin(turn)),
                            static_cast<float>(std::sin(up))});
    }
  keep(vehicle_.subscribe_scan(
      sensor.name(), [this, rays, directions, frame = string(sensor.name()),
                      where = Publisher<ros2::PointCloud2>(participant_, place + "points")](
                         const api::Scan& scan) {
        if (!where.is_wanted()) return;
        std::vector<std::array<float, 3>> points = directions;
        for (std::size_t i = 0; i < points.size(); ++i)
          for (float& along : points[i])
            along *= std::isfinite(scan.ranges_m[i]) ? scan.ranges_m[i]
                                                     : std::numeric_limits<float>::quiet_NaN();
        constexpr std::uint8_t kFloat32 = 7;
        const string x = "x", y = "y", z = "z";
        const std::vector<ros2::PointField> fields = {
            {lend(x), 0, kFloat32, 1}, {lend(y), 4, kFloat32, 1}, {lend(z), 8, kFloat32, 1}};
        ros2::PointCloud2 m{};
        m.header = header(scan.sampled_at_ns, frame);
        m.height = static_cast<std::uint32_t>(rays.rows);
        m.width = static_cast<std::uint32_t>(rays.columns);
        lend(m.fields, fields);
        m.point_step = sizeof points[0];
        m.row_step = m.point_step * m.width;
        lend(m.data, points.data(), std::size_t{m.row_step} * m.height);
        where.publish(m);
      }));
}

// Pose of the sensor in "odom", and its velocities along its own axes.
void Driver::begin_odometry(const api::Sensor& sensor, const string& place, bool moves_body) {
  const string name = sensor.name();
  const auto fill = [name](const auto& s, ros2::Odometry& m) {
    m.child_frame_id = lend(name);
    m.pose.pose = {{s.p_WS.x, s.p_WS.y, s.p_WS.z}, quaternion(s.q_WS)};
    m.twist.twist = {vector(rotate(inverse(s.q_WS), s.v_WS_m_s)), vector(s.w_WS_rad_s)};
    const api::Vec3& p = s.position_stddev_m;
    const api::Vec3& a = s.attitude_stddev_rad;
    const api::Vec3& v = s.velocity_stddev_m_s;
    const double stddevs[] = {p.x, p.y, p.z, a.x, a.y, a.z};
    for (int i = 0; i < 6; ++i) m.pose.covariance[7 * i] = square(stddevs[i]);
    // The variances of the velocity are along W's axes.
    const api::Vec3 axes[] = {rotate(s.q_WS, {1, 0, 0}), rotate(s.q_WS, {0, 1, 0}),
                              rotate(s.q_WS, {0, 0, 1})};
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k)
        m.twist.covariance[6 * i + k] = axes[i].x * square(v.x) * axes[k].x +
                                        axes[i].y * square(v.y) * axes[k].y +
                                        axes[i].z * square(v.z) * axes[k].z;
  };
  keep(vehicle_.subscribe_odometry(
      sensor.name(), [this, moves_body, X_BS = sensor.mounting(),
                      odom = to<ros2::Odometry>(place + "odom", kOdom, fill)](const auto& s) {
        odom(s);
        if (!moves_body) return;
        const api::Quat q_WB = product(s.q_WS, inverse(X_BS.attitude));
        const api::Vec3 arm = rotate(q_WB, X_BS.position_m);
        const api::Vec3 p_WB{s.p_WS.x - arm.x, s.p_WS.y - arm.y, s.p_WS.z - arm.z};
        publish(tf_, {{kOdom, kBody, {p_WB, q_WB}, s.sampled_at_ns}});
      }));
}

}  // namespace

int main() {
  auto vehicle = api::connect();
  if (!vehicle) ros2::fail(vehicle.failure().message());
  Driver driver(*vehicle, ros2::make_participant());
  driver.start();
  driver.take_commands();
}
