#pragma once

#include "commands/size_trials.h"

#include <filesystem>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include <tether/report/size_report.h>
#include <tether/sizing/sizing.h>

namespace tether::app {

/// The flights of `tether size` over slowdowns: a campaign whose conditions are the slowed ones.
class SizeFlights {
 public:
  struct Setup {
    scenario::Scenario scenario;
    /// The one to size; then, if it is wanted, the one without synchronisation.
    std::vector<scenario::Condition> conditions;
  };

  /// @throws as SizeTrials and scenario::slow_down. @pre the arguments outlive the object.
  SizeFlights(const SizeOptions& options, const Setup& setup, const sizing::CurveGrid& grid,
              const std::filesystem::path& out, const std::stop_token& stop);

  /// Flies until there is an answer. Fills in what of the report depends on flights.
  SizeTrials::End fly(report::SizeReport& report);
  int say_why(SizeTrials::End end) const { return trials_.say_why(end); }

 private:
  scenario::Campaign make_campaign(std::size_t most) const;
  SizeTrials::Wanted slowed(std::size_t condition, double slowdown) const;
  SizeTrials::Questions questions(sizing::Sizing& sizing, report::SizedCondition& into) const;
  bool fly_unsynchronised(report::SizeReport& report);

  const Setup& setup_;
  const sizing::CurveGrid& grid_;
  std::vector<std::string> names_;  // of the slowed conditions
  SizeTrials trials_;
  bool has_margins_ = false;
};

/// What flights have shown so far, for the progress: "so far about 3.2 times slower".
std::string known_text(const sizing::Threshold& threshold);

}  // namespace tether::app
