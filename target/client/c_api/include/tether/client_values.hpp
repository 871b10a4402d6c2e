#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>

#include <tether/client.h>

namespace tether::api {

/// @defgroup cpp_results Results
/// @ingroup cpp_api
/// Several threads can read a value at the same time; nothing else may happen while one changes it.
/// @{

/// Why a call failed: the statuses of <tether/client.h>.
enum class Code : std::int32_t {
  kInvalid = TETHER_INVALID,            ///< an argument cannot be used; the next call may succeed
  kNothingYet = TETHER_NOTHING_YET,     ///< a read that does not wait found no measurement
  kRefused = TETHER_REFUSED,            ///< the coordinator refused: wrong name, token or version
  kDisconnected = TETHER_DISCONNECTED,  ///< the connection ended, or no coordinator is there
  kProtocol = TETHER_PROTOCOL,          ///< the coordinator sent what the protocol does not allow
  kTimeout = TETHER_TIMEOUT,            ///< no answer within the limit
  kRunEnded = TETHER_RUN_ENDED,         ///< the run ended
  kNoMemory = TETHER_NO_MEMORY,         ///< out of memory
  kInternal = TETHER_INTERNAL,          ///< an error in the library
};

/// A code and one line for a person. Copying it cannot fail.
class Failure {
 public:
  /// Makes a failure.
  /// @param code  why  @param message  one line for a person, cut after 511 bytes
  Failure(Code code, const char* message) noexcept : code_(code) {
    std::strncpy(message_, message, sizeof message_ - 1);
  }
  /// The failure of the calling thread's last call.
  /// @param status  what the call returned  @return the status with tether_last_error()
  static Failure last(tether_status status) noexcept {
    return {static_cast<Code>(status), tether_last_error()};
  }

  Code code() const noexcept { return code_; }  ///< @return why the call failed
  /// @return one line for a person; valid as long as this
  const char* message() const noexcept { return message_; }

 private:
  Code code_;
  char message_[512] = {};
};

/// A value, or the failure for which there is none.
template <class T>
class [[nodiscard]] Result {
 public:
  // Implicit by design: `return value;` and `return Failure{...};` read as what they mean.
  /// Success. @param value  what the call returns
  Result(T value) noexcept : value_(std::move(value)) {}  // NOLINT
  /// Failure. @param failure  why there is no value
  Result(Failure failure) noexcept : failure_(failure) {}  // NOLINT

  bool ok() const noexcept { return value_.has_value(); }   ///< @return whether there is a value
  explicit operator bool() const noexcept { return ok(); }  ///< @return ok()
  /// The value. @pre ok()  @return it
  T& operator*() & noexcept { return *value_; }
  /// The value. @pre ok()  @return it
  const T& operator*() const& noexcept { return *value_; }
  /// The value. @pre ok()  @return it
  T&& operator*() && noexcept { return std::move(*value_); }
  /// The value. @pre ok()  @return it
  T* operator->() noexcept { return &*value_; }
  /// The value. @pre ok()  @return it
  const T* operator->() const noexcept { return &*value_; }
  /// @pre !ok()  @return why there is no value
  const Failure& failure() const noexcept { return *failure_; }

 private:
  static_assert(std::is_nothrow_move_constructible_v<T>);
  std::optional<T> value_;
  std::optional<Failure> failure_;
};

/// Success without a value, or a failure.
class [[nodiscard]] Status {
 public:
  Status() noexcept = default;  ///< success
  /// Failure. @param failure  why the call failed
  Status(Failure failure) noexcept : failure_(failure) {}  // NOLINT(google-explicit-constructor)
  /// Status of a call of the C API. Must be called by the thread that made the call.
  /// @param status  what the call returned  @return the same, with the message if it is a failure
  static Status of(tether_status status) noexcept {
    return status == TETHER_OK ? Status() : Status(Failure::last(status));
  }

  /// @return whether the call succeeded
  bool ok() const noexcept { return !failure_.has_value(); }
  explicit operator bool() const noexcept { return ok(); }  ///< @return ok()
  /// @pre !ok()  @return why the call failed
  const Failure& failure() const noexcept { return *failure_; }

 private:
  std::optional<Failure> failure_;
};

/// @}
/// @defgroup cpp_time Time
/// @ingroup cpp_api
/// @{

/// Nanoseconds.
using Duration = std::chrono::duration<std::int64_t, std::nano>;

/// ET, the execution time of this program, from its connection on. Vehicle::now() reads it.
struct ExecClock {
  using rep = Duration::rep;                              ///< 64-bit integer
  using period = Duration::period;                        ///< nanosecond
  using duration = Duration;                              ///< nanoseconds
  using time_point = std::chrono::time_point<ExecClock>;  ///< a point in ET
  static constexpr bool is_steady = true;                 ///< never goes back
};
/// ST, the simulator's clock: the time of measurements.
struct SimClock {
  using rep = Duration::rep;                             ///< 64-bit integer
  using period = Duration::period;                       ///< nanosecond
  using duration = Duration;                             ///< nanoseconds
  using time_point = std::chrono::time_point<SimClock>;  ///< a point in ST
  static constexpr bool is_steady = true;                ///< never goes back
};
using ExecTime = ExecClock::time_point;  ///< a point in ET
using SimTime = SimClock::time_point;    ///< a point in ST

/// @}
/// @defgroup cpp_catalogue Sensors and anchors
/// @ingroup cpp_api
/// What the SUT knows beforehand. These functions never block, and several threads can call them.
/// @{

using Vec3 = tether_vec3;                 ///< a vector
using Quat = tether_quat;                 ///< unit quaternion, Hamilton convention
using Pose = tether_pose;                 ///< pose of a frame in its parent
using CameraModel = tether_camera_model;  ///< pinhole camera with distortion
using ScanModel = tether_scan_model;      ///< rays of a lidar
using ScanInfo = tether_scan_info;        ///< description of a scan
using Scan = tether_scan;                 ///< a scan that a subscription shows

/// Kind of a sensor. A later library may have more.
enum class SensorKind : std::int32_t {
  kCamera = TETHER_CAMERA,                           ///< colour camera
  kImu = TETHER_IMU,                                 ///< inertial measurement unit
  kRange = TETHER_RANGE,                             ///< rangefinder
  kDepthCamera = TETHER_DEPTH_CAMERA,                ///< measures a depth in each pixel
  kRgbdCamera = TETHER_RGBD_CAMERA,                  ///< measures colour and depth in each pixel
  kSegmentationCamera = TETHER_SEGMENTATION_CAMERA,  ///< finds which model each pixel shows
  kNavSat = TETHER_NAVSAT,                           ///< receiver of satellite navigation
  kMagnetometer = TETHER_MAGNETOMETER,               ///< magnetometer
  kBarometer = TETHER_BAROMETER,                     ///< barometer
  kOdometry = TETHER_ODOMETRY,                       ///< estimate of pose and velocity
  kScan = TETHER_SCAN,                               ///< lidar
  kJointState = TETHER_JOINT_STATE,                  ///< angles of the UAV's joints
};
/// Shape of an anchor.
enum class AnchorShape : std::int32_t {
  kBox = TETHER_BOX,            ///< box
  kCylinder = TETHER_CYLINDER,  ///< cylinder along its own z
  kSphere = TETHER_SPHERE,      ///< sphere
};

/// A sensor of the UAV. Valid as long as the vehicle.
class Sensor {
 public:
  /// Wraps a sensor. @param sensor  of the C API; not NULL
  explicit Sensor(const tether_sensor* sensor) noexcept : sensor_(sensor) {}
  /// @return the name, unique within the UAV; owned by the vehicle
  const char* name() const noexcept { return tether_sensor_name(sensor_); }
  /// @return what the sensor measures
  SensorKind kind() const noexcept {
    return static_cast<SensorKind>(tether_sensor_get_kind(sensor_));
  }
  /// @return the rate of a periodic sensor [Hz]; 0 if it measures on demand
  double rate_hz() const noexcept { return tether_sensor_rate_hz(sensor_); }
  /// @return X_BS, the pose of the sensor in the body frame; see tether_sensor_mounting()
  Pose mounting() const noexcept {
    Pose X_BS{};
    (void)tether_sensor_mounting(sensor_, &X_BS);  // fails for NULL only
    return X_BS;
  }
  /// @return how many of the UAV's joints turn it: the first ones
  std::size_t joints() const noexcept { return tether_sensor_joints(sensor_); }
  /// @return the optics; Code::kInvalid if this is not a camera
  Result<CameraModel> camera_model() const noexcept {
    CameraModel model{};
    const tether_status got = tether_sensor_camera_model(sensor_, &model, sizeof model);
    if (got != TETHER_OK) return Failure::last(got);
    return model;
  }
  /// The distances that a rangefinder, a depth or an RGBD camera can measure.
  struct RangeLimits {
    double min_m;  ///< least distance [m]
    double max_m;  ///< largest distance [m]
  };
  /// @return the limits; Code::kInvalid if this sensor measures no distances
  Result<RangeLimits> range_limits() const noexcept {
    RangeLimits limits{};
    const tether_status got = tether_sensor_range_limits(sensor_, &limits.min_m, &limits.max_m);
    if (got != TETHER_OK) return Failure::last(got);
    return limits;
  }
  /// @return the rays; Code::kInvalid if this is not a lidar
  Result<ScanModel> scan_model() const noexcept {
    ScanModel model{};
    const tether_status got = tether_sensor_scan_model(sensor_, &model, sizeof model);
    if (got != TETHER_OK) return Failure::last(got);
    return model;
  }
  /// The model that a label of a segmentation camera's images means.
  /// @param label  from 1  @return the model's name, owned by the vehicle; nullptr if there is none
  const char* label_model(std::uint16_t label) const noexcept {
    return tether_sensor_label_model(sensor_, label);
  }

 private:
  const tether_sensor* sensor_;
};

/// An anchor: an object of the world that the SUT knows beforehand. Valid as long as the vehicle.
class Anchor {
 public:
  /// Wraps an anchor. @param anchor  of the C API; not NULL
  explicit Anchor(const tether_anchor* anchor) noexcept : anchor_(anchor) {}
  /// @return the name; owned by the vehicle
  const char* name() const noexcept { return tether_anchor_name(anchor_); }
  /// @return box, cylinder or sphere
  AnchorShape shape() const noexcept {
    return static_cast<AnchorShape>(tether_anchor_get_shape(anchor_));
  }
  /// @return the size [m]; see tether_anchor_size()
  Vec3 size_m() const noexcept {
    Vec3 size_m{};
    (void)tether_anchor_size(anchor_, &size_m);  // fails for NULL only
    return size_m;
  }
  /// @return red, green, blue as x, y, z, each 0 to 1, sRGB
  Vec3 color() const noexcept {
    Vec3 color{};
    (void)tether_anchor_color(anchor_, &color);
    return color;
  }

 private:
  const tether_anchor* anchor_;
};

/// @}
/// @defgroup cpp_measurements Measurements
/// @ingroup cpp_api
/// @{

/// Which measurement to read: see tether_read_mode.
enum class Read : std::int32_t {
  kNext = TETHER_READ_NEXT,      ///< the newest that was not read; waits if there is none
  kLatest = TETHER_READ_LATEST,  ///< the newest, also if it was read before
  kIfAvailable = TETHER_READ_IF_AVAILABLE,  ///< as kNext, but Code::kNothingYet instead of waiting
};

class Image;

/// An image that something else owns, and valid as long as that. Several threads can read it.
class ImageView {
 public:
  /// Shows an image. @param image  of the C API; not NULL
  explicit ImageView(const tether_image* image) noexcept : image_(image) {
    (void)tether_image_get_info(image, &info_, sizeof info_);  // fails for NULL only
  }
  int width_px() const noexcept { return info_.width_px; }    ///< @return width [px]
  int height_px() const noexcept { return info_.height_px; }  ///< @return height [px]
  /// @return number of the measurement of this camera
  std::uint64_t index() const noexcept { return info_.index; }
  /// @return ST of the exposure
  SimTime sampled_at() const noexcept { return SimTime(Duration(info_.sampled_at_ns)); }
  /// @return height x width x 3 sRGB bytes R, G, B, row by row from the top left; nullptr if the
  ///   camera measures no colours
  const std::uint8_t* rgb() const noexcept { return tether_image_rgb(image_); }
  /// @return height x width depths [m], as tether_image_depth_m(); nullptr if the camera measures
  ///   none
  const float* depth_m() const noexcept { return tether_image_depth_m(image_); }
  /// @return height x width labels, as tether_image_labels(); nullptr if the camera finds none
  const std::uint16_t* labels() const noexcept { return tether_image_labels(image_); }
  /// @return height x width x 3; 0 if the camera measures no colours
  std::size_t size_bytes() const noexcept { return static_cast<std::size_t>(info_.size_bytes); }
  /// The three bytes of one pixel. @pre It is within the image, which has colours.
  /// @param u_px  column from 0  @param v_px  row from 0  @return R, G, B
  const std::uint8_t* pixel(int u_px, int v_px) const noexcept {
    return rgb() + 3 * (static_cast<std::ptrdiff_t>(v_px) * width_px() + u_px);
  }
  /// Copies the pixels. @return an image of its own, or Code::kNoMemory
  inline Result<Image> copy() const noexcept;

 private:
  const tether_image* image_;
  tether_image_info info_{};
};

/// An image that owns its pixels. It may outlive the vehicle.
class Image : public ImageView {
 public:
  /// Takes ownership. @param image  of the C API; not NULL
  explicit Image(tether_image* image) noexcept : ImageView(image), owned_(image) {}

 private:
  struct Free {
    void operator()(tether_image* image) const noexcept { tether_image_free(image); }
  };
  std::unique_ptr<tether_image, Free> owned_;
};

inline Result<Image> ImageView::copy() const noexcept {
  tether_image* image = nullptr;
  const tether_status copied = tether_image_copy(image_, &image);
  if (copied != TETHER_OK) return Failure::last(copied);
  return Image(image);
}

using ImageInfo = tether_image_info;                    ///< description of an image
using ImuSample = tether_imu_sample;                    ///< measurement of an IMU
using RangeSample = tether_range_sample;                ///< measurement of a rangefinder
using BatterySample = tether_battery_sample;            ///< the battery at one instant
using NavSatSample = tether_navsat_sample;              ///< measurement of a receiver
using MagnetometerSample = tether_magnetometer_sample;  ///< measurement of a magnetometer
using BarometerSample = tether_barometer_sample;        ///< measurement of a barometer
using OdometrySample = tether_odometry_sample;          ///< estimate of pose and velocity
using JointStateSample = tether_joint_state_sample;     ///< angles of all joints
using Setpoint = tether_setpoint;                       ///< any command
using Joint = tether_joint;                             ///< what turns a part of the UAV
using FlightLimits = tether_flight_limits;              ///< what a UAV can be commanded

/// When a measurement was taken, or the battery was read.
/// @param sample  the measurement  @return ST
template <class Sample>
inline auto sampled_at(const Sample& sample) noexcept
    -> decltype(SimTime(Duration(sample.sampled_at_ns))) {
  return SimTime(Duration(sample.sampled_at_ns));
}

/// @}
}  // namespace tether::api
