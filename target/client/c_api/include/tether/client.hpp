#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <optional>
#include <type_traits>
#include <utility>

#include <tether/client.h>
#include <tether/client_values.hpp>

/// The client library of Tether in C++17: what a UAV's own program, the software under test (SUT),
/// links to. Header only, over the C API of <tether/client.h>, where each call's meaning, units,
/// frames, errors and threads are described. Throws nothing and compiles with -fno-exceptions.
/// What is owned is freed by destructors.
namespace tether::api {

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
