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

/// @defgroup cpp_api C++17: <tether/client.hpp>
/// The client library of Tether in C++17: what a UAV's own program, the software under test (SUT),
/// links to. Header only, over the C API of <tether/client.h>. Units, frames, errors and threads
/// are those of the @ref c_api "C API". Throws nothing and compiles with -fno-exceptions.
/// Destructors free what an object owns.

/// The client library of Tether in C++17.
namespace tether::api {

/// @defgroup cpp_connecting Connecting and flying
/// @ingroup cpp_api
/// If a description names a C function, units, errors and threads are those of that function. A
/// failure has the status of that function as Code, and its message.
/// @{

/// How to reach the coordinator, if not as the environment says. One thread at a time can change
/// it.
class Options {
 public:
  /// Makes options without address and token.
  /// @return the options; fails as tether_options_new()
  static Result<Options> make() noexcept { return make_by(tether_options_new); }
  /// Makes options from the environment.
  /// @return the options; fails as tether_options_from_environment()
  static Result<Options> from_environment() noexcept {
    return make_by(tether_options_from_environment);
  }

  /// Sets the coordinator's address.
  /// @param host_and_port  "HOST:PORT" or "[IPV6]:PORT"
  /// @return as tether_options_set_address()
  Status set_address(const char* host_and_port) noexcept {
    return Status::of(tether_options_set_address(get(), host_and_port));
  }
  /// Sets the token that admits this program to the run.
  /// @param token  as the coordinator prints it
  /// @return as tether_options_set_token()
  Status set_token(const char* token) noexcept {
    return Status::of(tether_options_set_token(get(), token));
  }
  /// Sets which UAV of the scenario to fly.
  /// @param uav  its name; "" for the only UAV
  /// @return as tether_options_set_uav()
  Status set_uav(const char* uav) noexcept {
    return Status::of(tether_options_set_uav(get(), uav));
  }
  /// Sets the program's name and version, for the record.
  /// @param name  any text
  /// @return as tether_options_set_sut_name()
  Status set_sut_name(const char* name) noexcept {
    return Status::of(tether_options_set_sut_name(get(), name));
  }
  /// Sets how ET is measured.
  /// @param clock  as in TETHER_CLOCK: "wall", "cpu", "cpu*FACTOR", ...
  /// @return as tether_options_set_clock()
  Status set_clock(const char* clock) noexcept {
    return Status::of(tether_options_set_clock(get(), clock));
  }
  /// Sets the limits of connect(), in wall time.
  /// @param connect  for the connection  @param welcome  then for the Welcome; both above 0
  /// @return as tether_options_set_timeouts()
  Status set_timeouts(Duration connect, Duration welcome) noexcept {
    return Status::of(tether_options_set_timeouts(get(), connect.count(), welcome.count()));
  }
  /// @return the same for the C API; owned by this
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

/// Measurements that are delivered to a callback, until destruction. It must not be destroyed by
/// its own callback, nor after its vehicle.
class Subscription {
 public:
  /// Whether measurements still arrive.
  /// @return success while measurements arrive; else why none will. Never blocks.
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

/// A message that was received. It may outlive the vehicle.
class Message {
 public:
  /// Takes ownership. @param message  of the C API; not NULL
  explicit Message(tether_message* message) noexcept : message_(message) {}
  /// @return the name of the UAV that sent it; owned by this
  const char* from() const noexcept { return tether_message_from(message_.get()); }
  /// @return its contents; owned by this
  const std::uint8_t* bytes() const noexcept {
    std::size_t size = 0;
    return tether_message_bytes(message_.get(), &size);
  }
  /// @return number of its bytes
  std::size_t size() const noexcept {
    std::size_t size = 0;
    tether_message_bytes(message_.get(), &size);
    return size;
  }
  /// @return ET of the sender
  ExecTime sent_at() const noexcept {
    return ExecTime(Duration(tether_message_sent_at(message_.get())));
  }
  /// @return ST, not before sent_at()
  SimTime arrived_at() const noexcept {
    return SimTime(Duration(tether_message_arrived_at(message_.get())));
  }

 private:
  struct Free {
    void operator()(tether_message* message) const noexcept { tether_message_free(message); }
  };
  std::unique_ptr<tether_message, Free> message_;
};

/// The UAV as its own program sees it. Several threads can call it at the same time.
class Vehicle {
 public:
  /// Takes ownership. @param vehicle  of the C API; not NULL
  explicit Vehicle(tether_vehicle* vehicle) noexcept : vehicle_(vehicle) {}
  /// @return the same for the C API; owned by this
  tether_vehicle* get() const noexcept { return vehicle_.get(); }

  /// Whether the SUT runs under tether-exec. @return as tether_is_concurrent()
  bool is_concurrent() const noexcept { return tether_is_concurrent(get()) != 0; }
  /// Reads the SUT's clock. @return ET, as tether_now()
  ExecTime now() const noexcept { return ExecTime(Duration(tether_now(get()))); }

  /// @return the name of the UAV; owned by this
  const char* uav_name() const noexcept { return tether_uav_name(get()); }
  /// @return the number of sensors
  std::size_t sensor_count() const noexcept { return tether_sensor_count(get()); }
  /// A sensor by its index.
  /// @param index  from 0  @return the sensor; none if `index` is too large
  std::optional<Sensor> sensor_at(std::size_t index) const noexcept {
    return optional_of<Sensor>(tether_sensor_at(get(), index));
  }
  /// A sensor by its name.
  /// @param name  as in the scenario  @return the sensor; none if the UAV has no such sensor
  std::optional<Sensor> find_sensor(const char* name) const noexcept {
    return optional_of<Sensor>(tether_find_sensor(get(), name));
  }
  /// @return the number of anchors
  std::size_t anchor_count() const noexcept { return tether_anchor_count(get()); }
  /// An anchor by its index.
  /// @param index  from 0  @return the anchor; none if `index` is too large
  std::optional<Anchor> anchor_at(std::size_t index) const noexcept {
    return optional_of<Anchor>(tether_anchor_at(get(), index));
  }
  /// An anchor by its name.
  /// @param name  as in the scenario  @return the anchor; none if there is no such anchor
  std::optional<Anchor> find_anchor(const char* name) const noexcept {
    return optional_of<Anchor>(tether_find_anchor(get(), name));
  }

  /// Reads a camera, without copying pixels.
  /// @param sensor  its name  @param read  which image  @return as tether_read_camera()
  Result<Image> read_camera(const char* sensor, Read read = Read::kNext) noexcept {
    tether_image* image = nullptr;
    const tether_status got = tether_read_camera(get(), sensor, to_c(read), &image);
    if (got != TETHER_OK) return Failure::last(got);
    return Image(image);
  }
  /// Reads a camera into the caller's memory, with one copy.
  /// @param sensor  its name  @param[out] rgb  the pixels, as ImageView::rgb() has them
  /// @param capacity  bytes that `rgb` has  @param read  which image
  /// @return as tether_read_camera_into()
  Result<ImageInfo> read_camera_into(const char* sensor, std::uint8_t* rgb, std::size_t capacity,
                                     Read read = Read::kNext) noexcept {
    ImageInfo info{};
    const tether_status got =
        tether_read_camera_into(get(), sensor, to_c(read), rgb, capacity, &info, sizeof info);
    return got == TETHER_OK ? Result<ImageInfo>(info) : Result<ImageInfo>(Failure::last(got));
  }
  /// Lets measurements of a periodic sensor wait: reads get the oldest.
  /// @param sensor  its name  @param depth  how many wait  @return as tether_set_queue()
  Status set_queue(const char* sensor, std::uint32_t depth) noexcept {
    return Status::of(tether_set_queue(get(), sensor, depth));
  }
  /// Reads an image of each of two cameras, of one instant.
  /// @param first,second  their names  @return both images, as tether_read_together()
  Result<std::pair<Image, Image>> read_together(const char* first, const char* second) noexcept {
    const char* const cameras[] = {first, second};
    tether_image* images[2] = {};
    const tether_status got = tether_read_together(get(), cameras, 2, images);
    if (got != TETHER_OK) return Failure::last(got);
    return std::pair<Image, Image>(Image(images[0]), Image(images[1]));
  }
  /// Reads an IMU.
  /// @param sensor  its name  @param read  which measurement  @return as tether_read_imu()
  Result<ImuSample> read_imu(const char* sensor, Read read = Read::kNext) noexcept {
    return read_struct<ImuSample>(tether_read_imu, sensor, read);
  }
  /// Reads a rangefinder. @copydetails read_imu
  Result<RangeSample> read_range(const char* sensor, Read read = Read::kNext) noexcept {
    return read_struct<RangeSample>(tether_read_range, sensor, read);
  }
  /// Reads a receiver of satellite navigation. @copydetails read_imu
  Result<NavSatSample> read_navsat(const char* sensor, Read read = Read::kNext) noexcept {
    return read_struct<NavSatSample>(tether_read_navsat, sensor, read);
  }
  /// Reads a magnetometer. @copydetails read_imu
  Result<MagnetometerSample> read_magnetometer(const char* sensor,
                                               Read read = Read::kNext) noexcept {
    return read_struct<MagnetometerSample>(tether_read_magnetometer, sensor, read);
  }
  /// Reads a barometer. @copydetails read_imu
  Result<BarometerSample> read_barometer(const char* sensor, Read read = Read::kNext) noexcept {
    return read_struct<BarometerSample>(tether_read_barometer, sensor, read);
  }
  /// Reads an estimate of pose and velocity. @copydetails read_imu
  Result<OdometrySample> read_odometry(const char* sensor, Read read = Read::kNext) noexcept {
    return read_struct<OdometrySample>(tether_read_odometry, sensor, read);
  }
  /// Reads the angles of all joints. @copydetails read_imu
  Result<JointStateSample> read_joint_state(const char* sensor, Read read = Read::kNext) noexcept {
    return read_struct<JointStateSample>(tether_read_joint_state, sensor, read);
  }
  /// Reads a lidar into the caller's memory.
  /// @param sensor  its name  @param[out] ranges_m  the distances  @param capacity  of them
  /// @param read  which  @param[out] intensities  of each, or nullptr  @return tether_read_scan()'s
  Result<ScanInfo> read_scan(const char* sensor, float* ranges_m, std::size_t capacity,
                             Read read = Read::kNext, float* intensities = nullptr) noexcept {
    ScanInfo info{};
    const tether_status got =
        intensities == nullptr
            ? tether_read_scan(get(), sensor, to_c(read), ranges_m, capacity, &info, sizeof info)
            : tether_read_scan_intensities(get(), sensor, to_c(read), ranges_m, intensities,
                                           capacity, &info, sizeof info);
    return got == TETHER_OK ? Result<ScanInfo>(info) : Result<ScanInfo>(Failure::last(got));
  }
  /// Reads the battery. @return as tether_read_battery()
  Result<BatterySample> read_battery() noexcept {
    BatterySample sample{};
    const tether_status got = tether_read_battery(get(), &sample, sizeof sample);
    return got == TETHER_OK ? Result<BatterySample>(sample)
                            : Result<BatterySample>(Failure::last(got));
  }

  /// Delivers the images of a camera, in a thread of the library. Needs tether-exec.
  /// @param sensor  its name  @param on_image  is called as `on_image(ImageView)`; must not throw
  /// @return as tether_subscribe_camera()
  template <class OnImage>
  Result<Subscription> subscribe_camera(const char* sensor, OnImage on_image) noexcept {
    return subscribe_by<tether_image, ImageView>(tether_subscribe_camera, sensor,
                                                 std::move(on_image));
  }
  /// Delivers the measurements of an IMU.
  ///
  /// Calls from a thread of the library. Needs tether-exec.
  /// @param sensor  its name
  /// @param on_sample  is called as `on_sample(sample)`, with what a read gives; must not throw
  /// @return as tether_subscribe_imu()
  template <class OnSample>
  Result<Subscription> subscribe_imu(const char* sensor, OnSample on_sample) noexcept {
    return subscribe_by<ImuSample>(tether_subscribe_imu, sensor, std::move(on_sample));
  }
  /// Delivers the measurements of a rangefinder. @copydetails subscribe_imu
  template <class OnSample>
  Result<Subscription> subscribe_range(const char* sensor, OnSample on_sample) noexcept {
    return subscribe_by<RangeSample>(tether_subscribe_range, sensor, std::move(on_sample));
  }
  /// Delivers the measurements of a receiver of satellite navigation. @copydetails subscribe_imu
  template <class OnSample>
  Result<Subscription> subscribe_navsat(const char* sensor, OnSample on_sample) noexcept {
    return subscribe_by<NavSatSample>(tether_subscribe_navsat, sensor, std::move(on_sample));
  }
  /// Delivers the measurements of a magnetometer. @copydetails subscribe_imu
  template <class OnSample>
  Result<Subscription> subscribe_magnetometer(const char* sensor, OnSample on_sample) noexcept {
    return subscribe_by<MagnetometerSample>(tether_subscribe_magnetometer, sensor,
                                            std::move(on_sample));
  }
  /// Delivers the measurements of a barometer. @copydetails subscribe_imu
  template <class OnSample>
  Result<Subscription> subscribe_barometer(const char* sensor, OnSample on_sample) noexcept {
    return subscribe_by<BarometerSample>(tether_subscribe_barometer, sensor, std::move(on_sample));
  }
  /// Delivers the measurements of a source of odometry. @copydetails subscribe_imu
  template <class OnSample>
  Result<Subscription> subscribe_odometry(const char* sensor, OnSample on_sample) noexcept {
    return subscribe_by<OdometrySample>(tether_subscribe_odometry, sensor, std::move(on_sample));
  }
  /// Delivers the angles of all joints. @copydetails subscribe_imu
  template <class OnSample>
  Result<Subscription> subscribe_joint_state(const char* sensor, OnSample on_sample) noexcept {
    return subscribe_by<JointStateSample>(tether_subscribe_joint_state, sensor,
                                          std::move(on_sample));
  }
  /// Delivers the scans of a lidar, in a thread of the library. Needs tether-exec.
  /// @param sensor  its name  @param on_scan  is called as `on_scan(const Scan&)`; must not throw
  /// @return as tether_subscribe_scan()
  template <class OnScan>
  Result<Subscription> subscribe_scan(const char* sensor, OnScan on_scan) noexcept {
    return subscribe_by<Scan>(tether_subscribe_scan, sensor, std::move(on_scan));
  }

  /// Flies with this velocity until the next command.
  /// @param velocity_H_m_s  in the heading frame: ahead, left, up [m/s]
  /// @param yaw_rate_rad_s  counter-clockwise seen from above [rad/s]
  /// @return as tether_command_velocity()
  Status command_velocity(const Vec3& velocity_H_m_s, double yaw_rate_rad_s) noexcept {
    return Status::of(tether_command_velocity(get(), velocity_H_m_s.x, velocity_H_m_s.y,
                                              velocity_H_m_s.z, yaw_rate_rad_s));
  }
  /// Follows a set-point until the next command.
  /// @param setpoint  any level  @return as tether_follow()
  Status command(const Setpoint& setpoint) noexcept { return follow(&setpoint, 1); }
  /// Follows a trajectory.
  /// @param setpoints  at times that increase  @param count  how many  @return as tether_follow()
  Status follow(const Setpoint* setpoints, std::size_t count) noexcept {
    return Status::of(tether_follow(get(), setpoints, count, sizeof *setpoints));
  }
  /// @return what the UAV can be commanded
  FlightLimits flight_limits() const noexcept {
    FlightLimits limits{};
    tether_get_flight_limits(get(), &limits, sizeof limits);
    return limits;
  }
  /// @return as tether_joint_count()
  std::size_t joint_count() const noexcept { return tether_joint_count(get()); }
  /// @param index  of a joint, from 0  @return the joint; Code::kInvalid if there is none
  Result<Joint> joint_at(std::size_t index) const noexcept {
    Joint joint{};
    const tether_status got = tether_get_joint(get(), index, &joint, sizeof joint);
    return got == TETHER_OK ? Result<Joint>(joint) : Result<Joint>(Failure::last(got));
  }
  /// @return the number of other UAVs
  std::size_t peer_count() const noexcept { return tether_peer_count(get()); }
  /// Another UAV by its index.
  /// @param index  from 0  @return its name; nullptr if `index` is too large
  const char* peer_at(std::size_t index) const noexcept { return tether_peer_at(get(), index); }
  /// Sends a message by radio.
  /// @param to  another UAV, or nullptr: all others  @param bytes  the message  @param size  of it
  /// @return as tether_send()
  Status send(const char* to, const void* bytes, std::size_t size) noexcept {
    return Status::of(tether_send(get(), to, bytes, size));
  }
  /// Receives the next message, or waits for one.
  /// @param timeout  not above 0: does not wait  @return as tether_receive()
  Result<Message> receive(Duration timeout) noexcept {
    tether_message* message = nullptr;
    const tether_status got = tether_receive(get(), timeout.count(), &message);
    if (got != TETHER_OK) return Failure::last(got);
    return Message(message);
  }
  /// Waits in simulation.
  /// @param duration  not above 0: returns at once  @return as tether_sleep_for()
  Status sleep_for(Duration duration) noexcept {
    return Status::of(tether_sleep_for(get(), duration.count()));
  }
  /// Waits in simulation.
  /// @param until  if it has passed, returns at once  @return as tether_sleep_until()
  Status sleep_until(ExecTime until) noexcept {
    return Status::of(tether_sleep_until(get(), until.time_since_epoch().count()));
  }
  /// Writes a message into the record.
  /// @param topic  its name  @param json  one JSON object  @return as tether_annotate()
  Status annotate(const char* topic, const char* json) noexcept {
    return Status::of(tether_annotate(get(), topic, json));
  }
  /// Ends the mission. Every later interaction fails.
  /// @param reached_goal  whether the mission succeeded  @param outcome  one line for a person
  /// @param details_json  a JSON object, or ""  @return as tether_finish()
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

  template <class C, class Shown = const C&, class Subscribe, class Function>
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

/// Marks what the program computes during the object's life as a stage. Must not outlive the
/// vehicle.
class Stage {
 public:
  /// Begins the stage.
  /// @param vehicle  the UAV  @param name  as tether_stage_begin(); if it fails, nothing is marked
  Stage(Vehicle& vehicle, const char* name) noexcept
      : vehicle_(tether_stage_begin(vehicle.get(), name) == TETHER_OK ? vehicle.get() : nullptr) {}
  /// Ends it, as tether_stage_end().
  ~Stage() {
    if (vehicle_ != nullptr) tether_stage_end(vehicle_);
  }
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

 private:
  tether_vehicle* vehicle_;
};

/// Connects as the environment says: for programs that `tether run` starts.
/// @return the UAV; fails as tether_connect()
inline Result<Vehicle> connect() noexcept {
  tether_vehicle* vehicle = nullptr;
  const tether_status connected = tether_connect(nullptr, &vehicle);
  if (connected != TETHER_OK) return Failure::last(connected);
  return Vehicle(vehicle);
}
/// Connects with options.
/// @param options  can be used again  @return the UAV; fails as tether_connect()
inline Result<Vehicle> connect(const Options& options) noexcept {
  tether_vehicle* vehicle = nullptr;
  const tether_status connected = tether_connect(options.get(), &vehicle);
  if (connected != TETHER_OK) return Failure::last(connected);
  return Vehicle(vehicle);
}

/// Version of the loaded library. @return as tether_client_version()
inline const char* version() noexcept {
  return tether_client_version();
}

/// @}

}  // namespace tether::api
