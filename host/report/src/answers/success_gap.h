#pragma once

#include <optional>

#include <tether/campaign/campaign_results.h>
#include <tether/report/size_report.h>

namespace tether::report {

/// Neighbouring slowdowns, and how many of their flights reach the goal.
struct Band {
  double from = 0.0, to = 0.0;
  campaign::Count flights{};
};
/// Slowdowns that fail, and slower ones next to them that reach the goal again.
struct SuccessGap {
  Band fails{}, again{};
};
/// The first one that chance does not explain; none: there is no such gap.
std::optional<SuccessGap> success_gap(const SizeReport& report);

}  // namespace tether::report
