#include <utility>

#include <tether/base/printable.h>
#include <tether/sim/world.h>

namespace tether::sim {

WarningSink with_printable_lines(WarningSink warn) {
  if (!warn) return warn;
  return [warn = std::move(warn)](const std::string& line) { warn(printable(line)); };
}

}  // namespace tether::sim
