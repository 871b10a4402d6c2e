#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

#include <tether/client/sut_clock.h>

namespace tether::client {

/// Calls `report` every `period` from a thread of its own until it returns false or the reporter is
/// destroyed. The thread is not charged to the SUT where the source can tell, sleeps in between,
/// and takes none of the SUT's signals.
class ProgressReporter {
 public:
  /// @pre period > 0. `source` must outlive it.
  ProgressReporter(Duration period, TimeSource& source, std::function<bool()> report);
  ~ProgressReporter();

 private:
  void run();

  Duration period_;
  TimeSource& source_;
  std::function<bool()> report_;
  std::mutex mutex_;
  std::condition_variable stop_;
  bool stopping_ = false;  // guarded by mutex_
  std::thread thread_;
};

}  // namespace tether::client
