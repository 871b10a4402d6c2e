#include "reading/world_options.h"

#include <limits>

#include <fmt/format.h>

#include <tether/base/text.h>

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

std::string as_written_text(std::span<const Warning> warnings) {
  if (warnings.empty()) return "everything is simulated as written\n";
  return fmt::format("not simulated as written: {}\n{}", counted(warnings.size(), "part"),
                     grouped(warnings, std::numeric_limits<std::size_t>::max()));
}

}  // namespace tether::app
