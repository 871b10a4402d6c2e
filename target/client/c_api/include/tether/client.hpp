#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <new>
#include <optional>
#include <type_traits>
#include <utility>

#include <tether/client.h>

/// The client library of Tether in C++17: what a UAV's own program, the software under test (SUT),
/// links to. Header only, over the C API of <tether/client.h>, where each call's meaning, units,
/// frames, errors and threads are described. Throws nothing and compiles with -fno-exceptions.
/// What is owned is freed by destructors.
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

// ---- Connecting and flying ----------------------------------------------------------------------

/// How to reach the coordinator, where it is not the environment that says so.
class Options {
 public:
  static Result<Options> make() noexcept { return make_by(tether_options_new); }
  static Result<Options> from_environment() noexcept {
    return make_by(tether_options_from_environment);
  }

  Status set_address(const char* host_and_port) noexcept {
    return Status::of(tether_options_set_address(get(), host_and_port));
  }
  Status set_token(const char* token) noexcept {
    return Status::of(tether_options_set_token(get(), token));
  }
  Status set_uav(const char* uav) noexcept {
    return Status::of(tether_options_set_uav(get(), uav));
  }
  Status set_sut_name(const char* name) noexcept {
    return Status::of(tether_options_set_sut_name(get(), name));
  }
  Status set_clock(const char* clock) noexcept {
    return Status::of(tether_options_set_clock(get(), clock));
  }
  Status set_timeouts(Duration connect, Duration welcome) noexcept {
    return Status::of(tether_options_set_timeouts(get(), connect.count(), welcome.count()));
  }
  tether_options* get() const noexcept { return options_.get(); }

 private:
  struct Free {
    void operator()(tether_options* options) const noexcept { tether_options_free(options); }
  };
  explicit Options(tether_options* options) noexcept : options_(options) {}
  static Result<Options> make_by(tether_status (*make)(tether_options**)) noexcept {
    tether_options* options = nullptr;
    const tether_status made = make(&options);
    if (made != TETHER_OK) return Failure::last(made);
    return Options(options);
  }
  std::unique_ptr<tether_options, Free> options_;
};

/// Data that comes by itself, until destruction. Not to be destroyed from within its own callback,
/// nor after its vehicle.
class Subscription {
 public:
  /// OK as long as measurements come; else why none will any more.
  Status status() const noexcept { return Status::of(tether_subscription_status(c_.get())); }

 private:
  friend class Vehicle;
  /// The program's own callback, behind a type that all have in common.
  struct Callback {
    Callback() noexcept = default;
    Callback(const Callback&) = delete;
    Callback& operator=(const Callback&) = delete;
    virtual ~Callback() = default;
  };
  struct Unsubscribe {
    void operator()(tether_subscription* c) const noexcept { tether_unsubscribe(c); }
  };
  Subscription(std::unique_ptr<Callback> callback, tether_subscription* c) noexcept
      : callback_(std::move(callback)), c_(c) {}

  std::unique_ptr<Callback> callback_;
  std::unique_ptr<tether_subscription, Unsubscribe> c_;  // last: ends before the callback goes
};

/// The UAV as its own program sees it. Several threads may call at once.
class Vehicle {
 public:
  /// Takes ownership of what the C API connected. @pre not NULL
  explicit Vehicle(tether_vehicle* vehicle) noexcept : vehicle_(vehicle) {}
  /// For calls of the C API beside these.
  tether_vehicle* get() const noexcept { return vehicle_.get(); }

  bool is_concurrent() const noexcept { return tether_is_concurrent(get()) != 0; }
  ExecTime now() const noexcept { return ExecTime(Duration(tether_now(get()))); }

  const char* uav_name() const noexcept { return tether_uav_name(get()); }
  std::size_t sensor_count() const noexcept { return tether_sensor_count(get()); }
  std::optional<Sensor> sensor_at(std::size_t index) const noexcept {
    return optional_of<Sensor>(tether_sensor_at(get(), index));
  }
  std::optional<Sensor> find_sensor(const char* name) const noexcept {
    return optional_of<Sensor>(tether_find_sensor(get(), name));
  }
  std::size_t anchor_count() const noexcept { return tether_anchor_count(get()); }
  std::optional<Anchor> anchor_at(std::size_t index) const noexcept {
    return optional_of<Anchor>(tether_anchor_at(get(), index));
  }
  std::optional<Anchor> find_anchor(const char* name) const noexcept {
    return optional_of<Anchor>(tether_find_anchor(get(), name));
  }

  Result<Image> read_camera(const char* sensor, Read read = Read::kNext) noexcept {
    tether_image* image = nullptr;
    const tether_status got = tether_read_camera(get(), sensor, to_c(read), &image);
    if (got != TETHER_OK) return Failure::last(got);
    return Image(image);
  }
  /// Into the caller's memory, with one copy.
  Result<ImageInfo> read_camera_into(const char* sensor, std::uint8_t* rgb, std::size_t capacity,
                                     Read read = Read::kNext) noexcept {
    ImageInfo info{};
    const tether_status got =
        tether_read_camera_into(get(), sensor, to_c(read), rgb, capacity, &info, sizeof info);
    if (got != TETHER_OK) return Failure::last(got);
    return info;
  }
  Result<ImuSample> read_imu(const char* sensor, Read read = Read::kNext) noexcept {
    return read_struct<ImuSample>(tether_read_imu, sensor, read);
  }
  Result<RangeSample> read_range(const char* sensor, Read read = Read::kNext) noexcept {
    return read_struct<RangeSample>(tether_read_range, sensor, read);
  }

  /// Calls `on_image(ImageView)` with each image, in a thread of the library's. Under tether-exec
  /// only.
  template <class OnImage>
  Result<Subscription> subscribe_camera(const char* sensor, OnImage on_image) noexcept {
    return subscribe_by<ImageView, tether_image>(tether_subscribe_camera, sensor,
                                                 std::move(on_image));
  }
  /// Likewise `on_sample(const ImuSample&)`.
  template <class OnSample>
  Result<Subscription> subscribe_imu(const char* sensor, OnSample on_sample) noexcept {
    return subscribe_by<const ImuSample&, ImuSample>(tether_subscribe_imu, sensor,
                                                     std::move(on_sample));
  }
  /// Likewise `on_sample(const RangeSample&)`.
  template <class OnSample>
  Result<Subscription> subscribe_range(const char* sensor, OnSample on_sample) noexcept {
    return subscribe_by<const RangeSample&, RangeSample>(tether_subscribe_range, sensor,
                                                         std::move(on_sample));
  }

  /// In the heading frame: ahead, left, up; yaw counter-clockwise.
  Status command_velocity(const Vec3& velocity_H_m_s, double yaw_rate_rad_s) noexcept {
    return Status::of(tether_command_velocity(get(), velocity_H_m_s.x, velocity_H_m_s.y,
                                              velocity_H_m_s.z, yaw_rate_rad_s));
  }
  Status sleep_for(Duration duration) noexcept {
    return Status::of(tether_sleep_for(get(), duration.count()));
  }
  Status sleep_until(ExecTime until) noexcept {
    return Status::of(tether_sleep_until(get(), until.time_since_epoch().count()));
  }
  Status annotate(const char* topic, const char* json) noexcept {
    return Status::of(tether_annotate(get(), topic, json));
  }
  Status finish(bool reached_goal, const char* outcome, const char* details_json = "") noexcept {
    return Status::of(tether_finish(get(), reached_goal ? 1 : 0, outcome, details_json));
  }

 private:
  struct Disconnect {
    void operator()(tether_vehicle* vehicle) const noexcept { tether_disconnect(vehicle); }
  };
  static tether_read_mode to_c(Read read) noexcept { return static_cast<tether_read_mode>(read); }

  template <class Wrapper, class Pointer>
  static std::optional<Wrapper> optional_of(Pointer pointer) noexcept {
    return pointer == nullptr ? std::nullopt : std::optional<Wrapper>(pointer);
  }
  template <class Sample, class Function>
  Result<Sample> read_struct(Function function, const char* sensor, Read read) noexcept {
    Sample sample{};
    const tether_status got = function(get(), sensor, to_c(read), &sample, sizeof sample);
    if (got != TETHER_OK) return Failure::last(got);
    return sample;
  }

  template <class Function>
  struct Held final : Subscription::Callback {
    explicit Held(Function&& given) noexcept : function(std::move(given)) {}
    Function function;
  };
  static ImageView shown(const tether_image* image) noexcept { return ImageView(image); }
  template <class Sample>
  static const Sample& shown(const Sample* sample) noexcept {
    return *sample;
  }

  template <class Shown, class C, class Subscribe, class Function>
  Result<Subscription> subscribe_by(Subscribe subscribe, const char* sensor,
                                    Function&& function) noexcept {
    using HeldFunction = Held<std::decay_t<Function>>;
    static_assert(std::is_invocable_v<std::decay_t<Function>&, Shown>);
    std::unique_ptr<HeldFunction> held(new (std::nothrow) HeldFunction(std::move(function)));
    if (held == nullptr) return Failure(Code::kNoMemory, "memory ran out");
    const auto call = [](const C* measurement, void* user) {
      static_cast<HeldFunction*>(user)->function(shown(measurement));
    };
    tether_subscription* subscription = nullptr;
    const tether_status subscribed = subscribe(get(), sensor, call, held.get(), &subscription);
    if (subscribed != TETHER_OK) return Failure::last(subscribed);
    return Subscription(std::move(held), subscription);
  }

  std::unique_ptr<tether_vehicle, Disconnect> vehicle_;
};

/// Connects as the environment says: what a program that `tether run` starts calls.
inline Result<Vehicle> connect() noexcept {
  tether_vehicle* vehicle = nullptr;
  const tether_status connected = tether_connect(nullptr, &vehicle);
  if (connected != TETHER_OK) return Failure::last(connected);
  return Vehicle(vehicle);
}
inline Result<Vehicle> connect(const Options& options) noexcept {
  tether_vehicle* vehicle = nullptr;
  const tether_status connected = tether_connect(options.get(), &vehicle);
  if (connected != TETHER_OK) return Failure::last(connected);
  return Vehicle(vehicle);
}

/// Version of the library that is loaded.
inline const char* version() noexcept {
  return tether_client_version();
}

}  // namespace tether::api
