#include "shared/within.h"

#include "shared/option.h"

#include <cmath>
#include <sstream>

#include <tether/base/text.h>

namespace tether::app {

std::string shown(double value) {
  if (value == std::trunc(value)) return fixed(value, 0);
  std::ostringstream text;
  text.precision(15);
  text << std::round(value * 1e9) / 1e9;
  return text.str();
}

CLI::Validator within(double least, double most) {
  const std::string range = shown(least) + " to " + (most == kLargestWhole ? "2^53" : shown(most));
  return CLI::Validator(
      [=](const std::string& text) -> std::string {
        double value = 0.0;
        if (CLI::detail::lexical_cast(text, value) && value >= least && value <= most) return {};
        return "must be a number from " + range + ", but is '" + text + "'";
      },
      range);
}

}  // namespace tether::app
