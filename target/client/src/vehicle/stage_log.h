#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <tether/base/result.h>
#include <tether/base/time.h>
#include <tether/client/exec/computed.h>
#include <tether/link/messages.h>

namespace tether::client {

/// What a SUT computes between two calls, by stage. Of nested stages the innermost one counts. Not
/// thread-safe.
class StageLog {
 public:
  explicit StageLog(ExecTime start) : reached_(start) {}

  /// What was computed until `at` belongs to the innermost stage; if none is open, to what is
  /// outside of stages. Nothing if the clock went back: the request's timestamp shows that.
  void reach(ExecTime at);
  /// The same for a program of several parts, of which each has computed so much since it began:
  /// they are the stages, and those that have computed have their share. Without parts, as above.
  void reach(ExecTime at, const Computed& parts);
  /// Instead of reach(), if the time is replayed: each stage that was computed under since the last
  /// call takes its time from `given`, once. `outside` names what is outside of stages; empty: not
  /// known yet. Returns the sum of what was taken, by which ET grows.
  Duration take(std::vector<link::StageTime>& given, const std::string& outside);
  /// Fail with kInvalid: a name that is empty, too long or has control characters; too many stages;
  /// none is open.
  Status begin(std::string_view stage);
  Status end();

  /// Until when stages have their time.
  ExecTime reached() const { return reached_; }
  /// Each stage since the last call; what was outside of them under the name `outside`.
  std::vector<link::StageTime> times(const std::string& outside) const;
  /// A call has ended: what follows is before the next one.
  void resume(ExecTime at);

 private:
  link::StageTime& time_of_current();
  link::StageTime& time_of(const std::string& stage);

  ExecTime reached_;
  std::vector<std::string> open_;
  std::vector<link::StageTime> times_;  // an empty name: outside of stages
  Computed parts_;                      // when it was reached
};

}  // namespace tether::client
