#pragma once

#include <memory>
#include <string>
#include <string_view>

#include <tether/base/result.h>
#include <tether/base/time.h>
#include <tether/uav/catalogue.h>
#include <tether/uav/samples.h>

namespace tether::client {

/// How to read a periodic sensor.
enum class Read {
  kNext,    ///< the newest measurement that was not yet read; waits for the next if there is none
  kLatest,  ///< the newest one, again if need be
  /// The newest measurement that was not yet read, at once; Failure::Kind::kNothingYet if there is
  /// none. Of a sensor that measures on demand: kInvalid.
  kIfAvailable,
};

/// The UAV as its own program sees it, simulated or real. Every call that talks to the UAV is an
/// interaction and may block; `now`, `catalogue` and `annotate` are not. Throws nothing.
///
/// Several threads may call at once. Calls of a serial vehicle wait for one another; of a
/// concurrent one (`is_concurrent`) each waits for its own reply only, while the other threads
/// compute on. A vehicle belongs to the process that made it: after fork() the child makes one of
/// its own.
class Vehicle {
 public:
  virtual ~Vehicle() = default;

  /// The SUT's own clock: ET. Differences of it are what computing and waiting took.
  virtual ExecTime now() const = 0;
  virtual const uav::Catalogue& catalogue() const = 0;
  /// Whether threads that call at once wait each for its own reply only. Such a vehicle comes from
  /// `connect` in a program that tether-exec has started.
  virtual bool is_concurrent() const { return false; }

  virtual Result<uav::CameraSample> read_camera(std::string_view sensor,
                                                Read read = Read::kNext) = 0;
  virtual Result<uav::ImuSample> read_imu(std::string_view sensor, Read read = Read::kNext) = 0;
  virtual Result<uav::RangeSample> read_range(std::string_view sensor, Read read = Read::kNext) = 0;

  /// Flies with this velocity until told otherwise.
  virtual Status command_velocity(const uav::VelocityCommand& command) = 0;

  /// Waits; of a concurrent vehicle the calling thread only. A duration or instant in the past
  /// returns at once (and is still an interaction).
  virtual Status sleep_for(Duration duration) = 0;
  virtual Status sleep_until(ExecTime until) = 0;

  /// Something for the record; never blocks on the coordinator. Free of ET in a serial vehicle,
  /// where it may wait for another thread's call. `json` is one JSON object.
  virtual Status annotate(std::string_view topic, std::string_view json) = 0;

  /// The mission is over. No call is allowed after it; calls that other threads have open in a
  /// concurrent vehicle fail with kRunEnded.
  virtual Status finish(bool reached_goal, std::string_view outcome,
                        std::string_view details_json) = 0;
};

}  // namespace tether::client
