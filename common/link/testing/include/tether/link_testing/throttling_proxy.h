#pragma once

#include <cstddef>
#include <memory>

#include <tether/base/time.h>
#include <tether/link/channel.h>

namespace tether::link_testing {

/// A wire: bytes leave at a limited rate, one after another, and arrive a delay after they left.
struct WireModel {
  Duration delay{0};
  double bytes_per_s = 0.0;  ///< 0: unlimited
};

/// When bytes that are put on a wire arrive. Pure: times in, times out.
class WireSchedule {
 public:
  explicit WireSchedule(const WireModel& model) : model_(model) {}
  /// The instant at which the last of `bytes` arrives that are handed over at `now` (never
  /// decreasing; any origin).
  Duration arrival(Duration now, std::size_t bytes);

 private:
  WireModel model_;
  Duration free_at_ = Duration::min();  // when the wire has sent all that it was given
};

/// A TCP proxy that makes the wire between SUT and coordinator slow: every connection to it is
/// continued to `target`, with the model applied each way. Runs in a thread of its own.
class ThrottlingProxy {
 public:
  /// Listens on `listen` (port 0: any free one). @throws Error(kSetup) if that is impossible.
  ThrottlingProxy(const link::Address& listen, const link::Address& target, const WireModel& wire);
  /// Ends all connections.
  ~ThrottlingProxy();

  /// Where to connect instead of `target`.
  link::Address address() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tether::link_testing
