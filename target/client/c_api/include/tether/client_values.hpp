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

// ---- Results ------------------------------------------------------------------------------------

/// Why a call failed, as TETHER_... of <tether/client.h>.
enum class Code : std::int32_t {
  kInvalid = TETHER_INVALID,
  kNothingYet = TETHER_NOTHING_YET,
  kRefused = TETHER_REFUSED,
  kDisconnected = TETHER_DISCONNECTED,
  kProtocol = TETHER_PROTOCOL,
  kTimeout = TETHER_TIMEOUT,
  kRunEnded = TETHER_RUN_ENDED,
  kNoMemory = TETHER_NO_MEMORY,
  kInternal = TETHER_INTERNAL,
};

/// A code and one line for a person. Copying it cannot fail.
class Failure {
 public:
  Failure(Code code, const char* message) noexcept : code_(code) {
    std::strncpy(message_, message, sizeof message_ - 1);
  }
  /// What the calling thread's last call failed with.
  static Failure last(tether_status status) noexcept {
    return {static_cast<Code>(status), tether_last_error()};
  }

  Code code() const noexcept { return code_; }
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
  Result(T value) noexcept : value_(std::move(value)) {}   // NOLINT
  Result(Failure failure) noexcept : failure_(failure) {}  // NOLINT

  bool ok() const noexcept { return value_.has_value(); }
  explicit operator bool() const noexcept { return ok(); }
  /// @pre ok()
  T& operator*() & noexcept { return *value_; }
  const T& operator*() const& noexcept { return *value_; }
  T&& operator*() && noexcept { return std::move(*value_); }
  T* operator->() noexcept { return &*value_; }
  const T* operator->() const noexcept { return &*value_; }
  /// @pre !ok()
  const Failure& failure() const noexcept { return *failure_; }

 private:
  static_assert(std::is_nothrow_move_constructible_v<T>);
  std::optional<T> value_;
  std::optional<Failure> failure_;
};

/// Success without a value, or a failure.
class [[nodiscard]] Status {
 public:
  Status() noexcept = default;
  Status(Failure failure) noexcept : failure_(failure) {}  // NOLINT(google-explicit-constructor)
  /// What a call of the C API returned; to be made in the thread that called.
  static Status of(tether_status status) noexcept {
    return status == TETHER_OK ? Status() : Status(Failure::last(status));
  }

  bool ok() const noexcept { return !failure_.has_value(); }
  explicit operator bool() const noexcept { return ok(); }
  /// @pre !ok()
  const Failure& failure() const noexcept { return *failure_; }

 private:
  std::optional<Failure> failure_;
};

// ---- Time ---------------------------------------------------------------------------------------

using Duration = std::chrono::duration<std::int64_t, std::nano>;

/// ET: how long this program was free to execute. Read it with Vehicle::now().
struct ExecClock {
  using rep = Duration::rep;
  using period = Duration::period;
  using duration = Duration;
  using time_point = std::chrono::time_point<ExecClock>;
  static constexpr bool is_steady = true;
};
/// ST: the simulator's clock, in which measurements are dated.
struct SimClock {
  using rep = Duration::rep;
  using period = Duration::period;
  using duration = Duration;
  using time_point = std::chrono::time_point<SimClock>;
  static constexpr bool is_steady = true;
};
using ExecTime = ExecClock::time_point;
using SimTime = SimClock::time_point;

// ---- What the SUT knows beforehand --------------------------------------------------------------

using Vec3 = tether_vec3;
using Quat = tether_quat;
using Pose = tether_pose;
using CameraModel = tether_camera_model;

enum class SensorKind : std::int32_t {
  kCamera = TETHER_CAMERA,
  kImu = TETHER_IMU,
  kRange = TETHER_RANGE,
};
enum class AnchorShape : std::int32_t {
  kBox = TETHER_BOX,
  kCylinder = TETHER_CYLINDER,
  kSphere = TETHER_SPHERE,
};

/// A sensor of the vehicle's catalogue; lives as long as the vehicle.
class Sensor {
 public:
  explicit Sensor(const tether_sensor* sensor) noexcept : sensor_(sensor) {}
  const char* name() const noexcept { return tether_sensor_name(sensor_); }
  SensorKind kind() const noexcept {
    return static_cast<SensorKind>(tether_sensor_get_kind(sensor_));
  }
  double rate_hz() const noexcept { return tether_sensor_rate_hz(sensor_); }
  /// X_BS.
  Pose mounting() const noexcept {
    Pose X_BS{};
    (void)tether_sensor_mounting(sensor_, &X_BS);  // fails for NULL only
    return X_BS;
  }
  Result<CameraModel> camera_model() const noexcept {
    CameraModel model{};
    const tether_status got = tether_sensor_camera_model(sensor_, &model, sizeof model);
    if (got != TETHER_OK) return Failure::last(got);
    return model;
  }
  struct RangeLimits {
    double min_m;
    double max_m;
  };
  Result<RangeLimits> range_limits() const noexcept {
    RangeLimits limits{};
    const tether_status got = tether_sensor_range_limits(sensor_, &limits.min_m, &limits.max_m);
    if (got != TETHER_OK) return Failure::last(got);
    return limits;
  }

 private:
  const tether_sensor* sensor_;
};

/// An anchor of the vehicle's catalogue; lives as long as the vehicle.
class Anchor {
 public:
  explicit Anchor(const tether_anchor* anchor) noexcept : anchor_(anchor) {}
  const char* name() const noexcept { return tether_anchor_name(anchor_); }
  AnchorShape shape() const noexcept {
    return static_cast<AnchorShape>(tether_anchor_get_shape(anchor_));
  }
  Vec3 size_m() const noexcept {
    Vec3 size_m{};
    (void)tether_anchor_size(anchor_, &size_m);  // fails for NULL only
    return size_m;
  }
  /// Red, green, blue as x, y, z, each 0 to 1.
  Vec3 color() const noexcept {
    Vec3 color{};
    (void)tether_anchor_color(anchor_, &color);
    return color;
  }

 private:
  const tether_anchor* anchor_;
};

// ---- Measurements -------------------------------------------------------------------------------

enum class Read : std::int32_t {
  kNext = TETHER_READ_NEXT,
  kLatest = TETHER_READ_LATEST,
  kIfAvailable = TETHER_READ_IF_AVAILABLE,
};

class Image;

/// An image to look at; valid for as long as what shows it.
class ImageView {
 public:
  /// @pre not NULL
  explicit ImageView(const tether_image* image) noexcept : image_(image) {
    (void)tether_image_get_info(image, &info_, sizeof info_);  // fails for NULL only
  }
  int width_px() const noexcept { return info_.width_px; }
  int height_px() const noexcept { return info_.height_px; }
  std::uint64_t index() const noexcept { return info_.index; }
  SimTime sampled_at() const noexcept { return SimTime(Duration(info_.sampled_at_ns)); }
  /// height x width x 3 bytes R, G, B, row by row from the top left.
  const std::uint8_t* rgb() const noexcept { return tether_image_rgb(image_); }
  std::size_t size_bytes() const noexcept { return static_cast<std::size_t>(info_.size_bytes); }
  /// The three bytes of one pixel. @pre it is within the image
  const std::uint8_t* pixel(int u_px, int v_px) const noexcept {
    return rgb() + 3 * (static_cast<std::ptrdiff_t>(v_px) * width_px() + u_px);
  }
  /// The same image with pixels of its own.
  inline Result<Image> copy() const noexcept;

 private:
  const tether_image* image_;
  tether_image_info info_{};
};

/// An image that owns its pixels; of no vehicle.
class Image : public ImageView {
 public:
  /// Takes ownership. @pre not NULL
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

using ImageInfo = tether_image_info;
using ImuSample = tether_imu_sample;
using RangeSample = tether_range_sample;

inline SimTime sampled_at(const ImuSample& sample) noexcept {
  return SimTime(Duration(sample.sampled_at_ns));
}
inline SimTime sampled_at(const RangeSample& sample) noexcept {
  return SimTime(Duration(sample.sampled_at_ns));
}

}  // namespace tether::api
