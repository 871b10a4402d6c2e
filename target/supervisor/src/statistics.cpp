#include "statistics.h"

#include <algorithm>
#include <cstdio>

namespace tether::supervisor {
namespace {

std::string line(const char* what, std::vector<Duration> durations) {
  if (durations.empty()) return {};
  std::sort(durations.begin(), durations.end());
  const auto at = [&](double part) {
    const auto last = static_cast<double>(durations.size() - 1);
    return to_seconds(durations[static_cast<std::size_t>(part * last)]) * 1e6;
  };
  char text[160];
  std::snprintf(text, sizeof text,
                "  %-9s %6zu times; µs: median %.0f, 95 %% within %.0f, longest %.0f\n", what,
                durations.size(), at(0.5), at(0.95), at(1.0));
  return text;
}

}  // namespace

std::string Statistics::report(Duration execution_time) const {
  char head[160];
  const double seconds = to_seconds(execution_time);
  const double rate = seconds > 0.0 ? static_cast<double>(freezes_.size()) / seconds : 0.0;
  std::snprintf(head, sizeof head, "%.3f s of execution time, %.0f stops per second of it\n",
                seconds, rate);
  return head + line("freeze", freezes_) + line("thaw", thaws_) + line("overshoot", overshoots_);
}

}  // namespace tether::supervisor
