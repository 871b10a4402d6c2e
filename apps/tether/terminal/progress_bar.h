#pragma once

#include <string>

#include <tether/campaign/run_campaign.h>

namespace tether::app {

/// The progress as one line of a terminal with that many columns: a bar, the number of trials, of
/// failed ones, the remaining time, and what fits of the latest trial's name.
std::string to_line(const campaign::CampaignProgress& progress, int columns);

/// The progress of a campaign on stderr: a bar with the remaining time that fits the terminal's
/// present width, or if stderr is not a terminal, a line per trial.
class ProgressBar {
 public:
  void show(const campaign::CampaignProgress& progress);
  /// Ends the line of the bar.
  void finish();

 private:
  bool shown_ = false;
};

}  // namespace tether::app
