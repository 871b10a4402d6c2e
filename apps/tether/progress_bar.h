#pragma once

#include <tether/campaign/run_campaign.h>

namespace tether::app {

/// The progress of a campaign on stderr: a bar with the remaining time on a terminal, otherwise a
/// line per trial.
class ProgressBar {
 public:
  ProgressBar();
  void show(const campaign::CampaignProgress& progress);
  /// Ends the line of the bar.
  void finish();

 private:
  bool is_terminal_;
  bool shown_ = false;
};

}  // namespace tether::app
