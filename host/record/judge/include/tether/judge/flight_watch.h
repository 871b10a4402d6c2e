#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <tether/base/time.h>
#include <tether/mission/mission.h>
#include <tether/record/reader.h>

namespace tether::judge {

/// Finds during a flight whether a clause that ends it (`ends_flight`) is missed, from the ground
/// truth of its UAV up to the `finish` of its SUT. Depends on the messages only, so that a flight
/// ends at the same instant whenever this looks. Not thread-safe.
class FlightWatch {
 public:
  struct Miss {
    SimTime at;
    std::string reason;  ///< one line
  };

  /// `record` grows during the flight. All must outlive this.
  FlightWatch(const mission::Mission& mission, std::string uav, const record::Record& record)
      : mission_(mission), uav_(std::move(uav)), record_(record) {}

  /// The first miss in what was added since the last look.
  std::optional<Miss> look();

 private:
  std::optional<Miss> first_miss(const mission::Clause& clause,
                                 const std::vector<const record::GroundTruth*>& truths) const;

  const mission::Mission& mission_;
  std::string uav_;
  const record::Record& record_;
  std::size_t next_truth_ = 0, next_interaction_ = 0;
  SimTime finished_at_ = SimTime::max();
  std::optional<record::GroundTruth> start_;
};

}  // namespace tether::judge
