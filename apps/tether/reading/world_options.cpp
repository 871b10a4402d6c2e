#include "reading/world_options.h"

#include <fmt/format.h>

namespace tether::app {

namespace {

/// More than these are counted.
constexpr std::size_t kFew = 3;

}  // namespace

sim::WorldOptions world_options(const ReadingOptions& reading,
                                const scenario::ShippedFiles& shipped) {
  return {.model_folders = {shipped.models()},
          .is_strict = reading.strict,
          .is_tolerant = reading.tolerant};
}

std::string summary_of(std::span<const Warning> warnings, const std::string& list) {
  std::string text;
  if (warnings.size() <= kFew) {
    for (const Warning& warning : warnings)
      text += fmt::format("{}warning: {}", text.empty() ? "" : "\n", to_line(warning));
    return text;
  }
  text = fmt::format("warning: {} parts are not simulated as written. All of them: {}\n{}",
                     warnings.size(), list, grouped(warnings, kFew));
  text.pop_back();
  return text;
}

}  // namespace tether::app
