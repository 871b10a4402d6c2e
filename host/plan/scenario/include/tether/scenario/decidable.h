#pragma once

#include <tether/scenario/scenario.h>

namespace tether::scenario {

/// For questions that flights with a goal reached or missed answer: requires a limit of a metric
/// that flights can miss, or a mission with a deadline or a clause. The SUT's own goal alone is not
/// enough: it says that the program ended as planned, not when or how well.
/// @throws Error(kBadFile) about the limit or "metric", with the line if there is a metric.
void require_decidable(const Scenario& scenario);

}  // namespace tether::scenario
