#pragma once

#include "commands/size_options.h"

#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <tether/campaign/campaign_folder.h>
#include <tether/report/size_report.h>
#include <tether/scenario/campaign.h>
#include <tether/sizing/sizing.h>

namespace tether::app {

/// What varies in `tether size`: the campaign of which only those trials are run that an answer
/// needs, and what its flights say.
class SizeAxis {
 public:
  /// Scenario and condition: a trial of the campaign, but for its seed.
  using Trial = std::pair<std::string, std::string>;
  virtual ~SizeAxis() = default;

  scenario::Campaign campaign;
  std::vector<Trial> levels{};  ///< of the search, then others to fly beside it
  std::size_t searched = 0;     ///< so many of them are of the search
  std::string folder{};         ///< of the flights, in out/size, if the user names none

  virtual sizing::Axis& search() = 0;
  /// What varies in a trial, such as "2 UAVs".
  virtual std::string name_of(const campaign::TrialPlan& plan) const = 0;
  /// A flight at a level that did not fail. @return whether it is a copy of an earlier one.
  virtual bool add(std::size_t level, const campaign::TrialResult& trial) = 0;
  /// What to fly beside the search, once that has an answer.
  virtual std::vector<sizing::Wanted> also() const { return {}; }
  /// Of an interrupted search: what is known from the flights so far.
  virtual report::SizeAnswer answer(const report::SearchOutcome& outcome) = 0;

 protected:
  /// Of this scenario, with a seed for each flight that may be flown.
  SizeAxis(const SizeOptions& options, const scenario::Scenario& scenario);
};

/// How slow the computer may be. Checks the question.
std::unique_ptr<SizeAxis> slowdown_axis(const SizeOptions& options);
/// How many UAVs it carries: the first ones of the scenario.
std::unique_ptr<SizeAxis> uavs_axis(const SizeOptions& options);

/// The scenario of the options, with these values replaced.
/// @throws as load_scenario; Error(kBadFile) if no limit decides; Error(kUsage) if an option cannot
///   be used.
scenario::Scenario load_sized_scenario(const SizeOptions& options,
                                       const std::vector<scenario::Setting>& settings = {});

/// @param miss how likely an interval that ends at 100 % is wrong
/// @throws Error(kUsage) if --max-trials cannot show the share even if all flights succeed.
void require_enough_trials(const SizeOptions& options, double miss);

}  // namespace tether::app
