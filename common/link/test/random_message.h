#pragma once

#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <tether/base/random.h>
#include <tether/link/messages.h>

namespace tether::link {

/// Draws valid messages of every kind, edges included, from keyed randomness.
class RandomMessage {
 public:
  explicit RandomMessage(std::uint64_t index) : random_({7, 1, index}) {}

  Message draw() { return draw(random_.bits() % 8); }

  Message draw(std::uint32_t kind) {
    if (kind == 0)
      return Hello{random_.bits(),
                   text(),
                   text(),
                   {static_cast<computer::ClockKind>(random_.bits() % computer::kClockKinds),
                    0.01 + number(), Duration(random_.bits())},
                   text(),
                   coin(),
                   coin() ? "0a9f" : ""};
    if (kind == 1) return welcome();
    if (kind == 2) return Refusal{static_cast<Refusal::Reason>(random_.bits() % 6), text()};
    if (kind == 3) return request();
    if (kind == 4) return reply();
    if (kind == 5) return Progress{time<ExecTime>(), coin(), random_.bits()};
    if (kind == 6) return Due{1 + word() % 1000, time<ExecTime>()};
    return Annotation{time<ExecTime>(), "t" + text(), json()};
  }

 private:
  bool coin() { return random_.bits() % 2 == 0; }
  double number() { return 50.0 * random_.uniform(); }
  uav::Vec3 vec3() { return {number() - 25.0, number(), -number()}; }
  uav::Quat quat() { return uav::from_rpy(number(), number(), number()); }
  uav::Vec3 color() { return {random_.uniform(), random_.uniform(), random_.uniform()}; }
  std::uint64_t word() { return std::uint64_t{random_.bits()} << 32 | random_.bits(); }

  template <class Time>
  Time time() {
    return from_ns<Time>(static_cast<std::int64_t>(word() >> 2));
  }
  std::string text() {
    std::string out(random_.bits() % 40, '\0');
    for (char& c : out) c = static_cast<char>(1 + random_.bits() % 255);
    return out;
  }
  std::string json() {
    std::string letters = text();
    for (char& c : letters) c = static_cast<char>('a' + static_cast<unsigned char>(c) % 26);
    return "{\"text\": \"" + letters + "\"}";
  }

  uav::SensorDescription sensor(std::size_t i) {
    uav::SensorDescription out{"s" + std::to_string(i), {vec3(), quat()}, number(), {}};
    const std::uint32_t kind = random_.bits() % 6;
    if (kind == 0)
      out.properties = uav::CameraProperties{
          {640, 480, 1.0 + number(), 2.0, number(), number(), 0.1, 0.2, 0.3, 0.4, number()},
          static_cast<uav::CameraKind>(random_.bits() % 4),
          0.1,
          0.2 + number(),
          std::vector<std::string>(random_.bits() % 4, text())};
    if (kind == 1) out.properties = uav::ImuProperties{};
    if (kind == 2) out.properties = uav::RangeProperties{0.1, 0.2 + number()};
    if (kind == 3) out.properties = uav::ScanProperties{.columns = 9, .rows = 2, .max_m = number()};
    if (kind == 4) out.properties = uav::OdometryProperties{};
    if (kind == 5) out.properties = uav::JointStateProperties{};
    out.own_stamps = random_.bits() % 2 == 0;
    return out;
  }

  std::vector<StageTime> stages() {
    std::vector<StageTime> out(random_.bits() % 4);
    for (std::size_t i = 0; i < out.size(); ++i)
      out[i] = {"s" + std::to_string(i), time<ExecTime>().time_since_epoch()};
    return out;
  }

  Message welcome() {
    Welcome out;
    out.catalogue.uav = text();
    for (std::size_t i = 0; i < random_.bits() % 5; ++i) {
      out.catalogue.sensors.push_back(sensor(i));
      out.catalogue.anchors.push_back({"a" + std::to_string(i),
                                       static_cast<uav::AnchorShape>(random_.bits() % 3),
                                       {number(), 0.0, number()},
                                       color()});
    }
    out.free_running = coin();
    out.start = time<ExecTime>();
    out.computing = stages();
    out.peers.assign(random_.bits() % 3, text());
    out.real_time_factor = 0.01 + random_.uniform();
    if (coin()) out.catalogue.battery_capacity_C = std::abs(number());
    if (coin()) out.catalogue.limits.joints = {{"yaw", vec3(), {0, 0, 1}, -1.0, 2.0, 3.0}};
    if (coin()) out.catalogue.limits = {random_.bits() % 9, std::abs(number()), 20.0};
    return out;
  }

  std::vector<std::uint8_t> bytes() {
    std::vector<std::uint8_t> out(random_.bits() % 100);
    for (auto& byte : out) byte = static_cast<std::uint8_t>(random_.bits());
    return out;
  }

  std::vector<std::uint32_t> sensors() {
    std::vector<std::uint32_t> out(random_.bits() % 4);
    for (auto& sensor : out) sensor = random_.bits() % 1000;
    return out;
  }

  std::vector<uav::TimedSetpoint> trajectory() {
    std::vector<uav::TimedSetpoint> out;
    for (std::uint32_t i = 0; i <= random_.bits() % 4; ++i) {
      out.push_back({Duration(5 * i), {.mask = uav::kPosition | uav::kYaw, .in_heading = false}});
      out.back().setpoint.p_WB_m = vec3();
      out.back().setpoint.yaw_rad = number();
    }
    if (coin()) out.back().setpoint = {.mask = uav::kRotorSpeeds, .rotor_speeds_rad_s = {1, 2, 3}};
    if (coin()) {
      out.back().setpoint.mask |= uav::kJoints;
      out.back().setpoint.joints_rad = {number(), 0.5};
    }
    return out;
  }

  Message request() {
    Request out{1 + word() / 2, time<ExecTime>(), time<ExecTime>().time_since_epoch(), {}};
    const std::uint32_t kind = random_.bits() % 8;
    if (kind == 0)
      out.body =
          ReadSensor{random_.bits() % 1000, coin(), coin(), 1 + random_.bits() % 4096, coin()};
    if (kind == 1) out.body = SetVelocity{{vec3(), number()}};
    if (kind == 2) out.body = Sleep{time<ExecTime>(), coin()};
    if (kind == 3) out.body = Finish{coin(), text(), coin() ? json() : ""};
    if (kind == 4) out.body = SendMessage{text(), bytes()};
    if (kind == 5)
      out.body = ReceiveMessage{time<ExecTime>().time_since_epoch(), sensors(),
                                1 + random_.bits() % kMaxReceived};
    if (kind == 6) out.body = ReadBattery{};
    if (kind == 7) out.body = SetTrajectory{trajectory()};
    out.stages = stages();
    return out;
  }

  uav::CameraSample image() {
    const int width = 1 + static_cast<int>(random_.bits() % 40);
    const int height = 1 + static_cast<int>(random_.bits() % 40);
    std::vector<std::uint8_t> rgb(static_cast<std::size_t>(3 * width * height));
    for (auto& byte : rgb) byte = static_cast<std::uint8_t>(random_.bits());
    uav::CameraSample out{time<SimTime>(), word(), width, height, std::move(rgb)};
    const std::size_t pixels = out.rgb.size() / 3;
    if (coin()) out.depth_m.assign(pixels, static_cast<float>(number()));
    if (coin()) out.labels.assign(pixels, static_cast<std::uint16_t>(random_.bits()));
    if (!out.depth_m.empty() && coin()) out.rgb.clear();
    return out;
  }

  uav::NavSatSample navsat() {
    uav::NavSatSample out;
    out.sampled_at = time<SimTime>();
    out.index = word();
    out.has_fix = true;
    out.latitude_deg = 45.0 * random_.uniform();
    out.longitude_deg = number();
    out.altitude_m = number();
    out.velocity_ENU_m_s = vec3();
    out.horizontal_accuracy_m = out.vertical_accuracy_m = out.speed_accuracy_m_s = number();
    return out;
  }

  Message reply() {
    Reply out{1 + word() / 2, time<ExecTime>(), {}};
    constexpr double kInf = std::numeric_limits<double>::infinity();
    const std::uint32_t kind = random_.bits() % 11;
    if (kind == 10) out.sample = uav::JointStateSample{time<SimTime>(), word(), {number(), -0.5}};
    if (kind == 5) out.sample = navsat();
    if (kind == 6) out.sample = uav::MagnetometerSample{time<SimTime>(), word(), vec3()};
    if (kind == 7) out.sample = uav::BarometerSample{time<SimTime>(), word(), number(), number()};
    if (kind == 8)
      out.sample = uav::OdometrySample{time<SimTime>(), word(), vec3(), quat(), vec3(),
                                       vec3(),          vec3(), vec3(), vec3()};
    if (kind == 9)
      out.sample = uav::ScanSample{
          time<SimTime>(), word(), {1.5F, static_cast<float>(kInf), static_cast<float>(-kInf)}};
    if (kind == 0) out.sample = image();
    if (kind == 1) out.sample = uav::ImuSample{time<SimTime>(), word(), vec3(), vec3(), quat()};
    if (kind == 2) out.sample = uav::RangeSample{time<SimTime>(), word(), number()};
    if (kind == 3) out.sample = uav::RangeSample{time<SimTime>(), word(), coin() ? kInf : -kInf};
    out.computing = stages();
    const auto arrived = time<SimTime>();
    if (coin())
      out.message = RadioMessage{text(), SimTime{arrived.time_since_epoch() / 2}, arrived, bytes()};
    if (coin()) out.battery = uav::BatterySample{time<SimTime>(), number(), number(), 0.25};
    return out;
  }

  KeyedRandom random_;
};

}  // namespace tether::link
