#pragma once

#include "robustness.h"

#include <map>
#include <optional>
#include <string>
#include <utility>

#include <tether/mission/mission.h>
#include <tether/record/reader.h>

namespace tether::judge {

/// What a quantity is about: the track of an anchor, a fence, or where the UAV began.
class Reference : public record::AnchorTrack {
 public:
  /// None: the record has no such anchor. `record` must outlive the reference.
  static std::optional<Reference> of(const mission::Condition& condition,
                                     const record::GroundTruth& start,
                                     const record::Record& record);

  const std::vector<mission::Corner>& fence() const { return fence_; }

 private:
  using AnchorTrack::AnchorTrack;
  std::vector<mission::Corner> fence_;
};

/// In SI units; none if the ground truth does not have it. @pre quantity.is_of_truth()
std::optional<double> value_of(const mission::Quantity& quantity, const record::GroundTruth& truth,
                               const Reference& reference);

/// The quantities of a UAV as signals in SI units, at the instants of its ground truth. Each is
/// computed when it is first asked for.
class Signals {
 public:
  Signals(const std::string& uav, const record::Record& record);

  /// Index in the trace; none if the record does not have it at every instant.
  std::optional<std::size_t> find(const mission::Condition& condition);
  const Trace& trace() const { return trace_; }
  /// The first instant at which the signal has any evidence; the trace's size: none.
  std::size_t known_from(std::size_t signal) const {
    const auto found = known_from_.find(signal);
    return found == known_from_.end() ? 0 : found->second;
  }

 private:
  std::size_t of_radio(const mission::Quantity& quantity);
  std::optional<std::size_t> of_battery(const mission::Quantity& quantity);

  std::string uav_;
  const record::Record& record_;
  std::vector<const record::GroundTruth*> truths_;
  Trace trace_;
  std::map<std::size_t, std::size_t> known_from_;  ///< of radio
  std::map<std::pair<std::string_view, std::string>, std::optional<std::size_t>> known_;
};

}  // namespace tether::judge
