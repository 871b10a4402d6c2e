#pragma once

#include <string>

#include <tether/timing/timing.h>

namespace tether::report {

/// A page with the table of stages and a histogram of each.
std::string timing_page(const timing::Timing& timing);

}  // namespace tether::report
