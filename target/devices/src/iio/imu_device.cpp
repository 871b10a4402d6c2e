#include "iio/imu_device.h"

#include <algorithm>
#include <cerrno>
#include <limits>
#include <sstream>
#include <utility>

// An IMU from six channels of the kernel's IIO interface: two triads, each rotated by the mounting
// matrix of its quantity or of the device.
namespace tether::devices {
namespace {

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
  return parts;
}

std::optional<uav::Vec3> parse_row(const std::string& text) {
  const std::vector<std::string> numbers = split(text, ',');
  if (numbers.size() != 3) return std::nullopt;
  const auto x = parse_number(numbers[0]);
  const auto y = parse_number(numbers[1]);
  const auto z = parse_number(numbers[2]);
  if (!x || !y || !z) return std::nullopt;
  return uav::Vec3{*x, *y, *z};
}

/// The first triad of this name in the folders; none in any: null.
std::optional<Triad> find_triad(System& system, Clock& clock,
                                const std::vector<std::string>& folders, const std::string& base) {
  for (const std::string& folder : folders) {
    std::optional<Triad> triad = Triad::open(system, clock, folder, base);
    if (triad) return triad;
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::array<uav::Vec3, 3>> parse_mount_matrix(const std::string& text) {
  const std::vector<std::string> lines = split(text, ';');
  if (lines.size() != 3) return std::nullopt;
  std::array<uav::Vec3, 3> rows;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto row = parse_row(lines[i]);
    if (!row) return std::nullopt;
    rows[i] = *row;
  }
  return rows;
}

// ---- three axes

std::optional<Triad> Triad::open(System& system, Clock& clock, const std::string& folder,
                                 const std::string& base) {
  Triad triad;
  for (const char* axis : {"_x", "_y", "_z"}) {
    std::optional<Channel> channel = Channel::open(system, clock, folder, base, axis);
    if (!channel) return std::nullopt;
    if (!channel->fault().empty()) triad.fault_ = channel->fault();
    triad.axes_.push_back(std::move(*channel));
  }
  // The quantity's own matrix goes before the device's.
  for (const std::string& name :
       {base + "_mount_matrix", std::string("in_mount_matrix"), std::string("mount_matrix")}) {
    const Attribute file(system, folder + "/" + name);
    if (file.error() == ENOENT) continue;
    int error = file.error();
    const auto text = error == 0 ? file.read_text(clock, error) : std::nullopt;
    const auto rows = text ? parse_mount_matrix(*text) : std::nullopt;
    if (rows) {
      triad.rows_ = *rows;
    } else {
      triad.fault_ = text ? file.path() + ": not a 3 × 3 matrix (\"" + *text + "\")"
                          : iio_fault(file.path(), error);
    }
    break;
  }
  return triad;
}

uav::Vec3 Triad::read(Clock& clock, std::string& fault) const {
  std::array<double, 3> raw{};
  for (std::size_t i = 0; i < 3; ++i) {
    const Reading reading = axes_[i].read(clock);
    if (!reading.ok()) {
      fault = reading.fault;
      return {};
    }
    raw[i] = reading.value;
  }
  const uav::Vec3 chip{raw[0], raw[1], raw[2]};
  return {dot(rows_[0], chip), dot(rows_[1], chip), dot(rows_[2], chip)};
}

// ---- the device

ImuDevice::ImuDevice(const Timeline& time, std::string label, Triad accelerometer, Triad gyroscope)
    : time_(time),
      label_(std::move(label)),
      accelerometer_(std::move(accelerometer)),
      gyroscope_(std::move(gyroscope)) {}

Result<std::unique_ptr<ImuDevice>> ImuDevice::open(System& system, const Timeline& time,
                                                   std::string label,
                                                   const std::vector<std::string>& folders) {
  std::optional<Triad> accelerometer = find_triad(system, time.clock(), folders, "in_accel");
  std::optional<Triad> gyroscope = find_triad(system, time.clock(), folders, "in_anglvel");
  if (!accelerometer || !gyroscope) {
    const std::string missing = accelerometer ? "gyroscope (in_anglvel_x, _y and _z"
                                              : "accelerometer (in_accel_x, _y and _z";
    return invalid(label + ": no " + missing +
                   ", each with _raw or _input). If the driver has two devices, give both as "
                   "ONE,OTHER");
  }
  for (const Triad* triad : {&*accelerometer, &*gyroscope}) {
    if (!triad->fault().empty()) return invalid(label + ": " + triad->fault());
  }
  // make_unique cannot reach the constructor.
  std::unique_ptr<ImuDevice> device(
      new ImuDevice(time, std::move(label), std::move(*accelerometer), std::move(*gyroscope)));
  uav::ImuSample unused;
  const std::string fault = device->measure(unused);
  if (!fault.empty()) return invalid(device->label_ + ": " + fault);
  return device;
}

std::string ImuDevice::measure(uav::ImuSample& sample) const {
  std::string fault;
  sample.specific_force_m_s2 = accelerometer_.read(time_.clock(), fault);
  if (fault.empty()) sample.angular_velocity_rad_s = gyroscope_.read(time_.clock(), fault);
  return fault;
}

Result<uav::ImuSample> ImuDevice::read() {
  if (stopped_) return *stopped_;
  uav::ImuSample sample;
  const std::string fault = measure(sample);
  if (!fault.empty()) {
    stopped_ = Failure{
        Failure::Kind::kDisconnected,
        label_ + " stopped after " + std::to_string(measured_) + " measurements (" + fault + ")"};
    return *stopped_;
  }
  sample.sampled_at = time_.at(time_.clock().now());
  sample.index = measured_++;
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  sample.q_WS = {kNaN, kNaN, kNaN, kNaN};
  return sample;
}

}  // namespace tether::devices
