#pragma once

#include <tether/campaign/run_campaign.h>

namespace tether::app {

/// A campaign's progress on stderr: a bar with the time left on a terminal, a line per trial
/// elsewhere.
class ProgressBar {
 public:
  ProgressBar();
  void show(const campaign::CampaignProgress& progress);
  /// Leaves the bar as it is and begins a new line.
  void finish();

 private:
  bool is_terminal_;
  bool shown_ = false;
};

}  // namespace tether::app
