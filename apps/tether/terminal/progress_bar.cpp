#include "terminal/progress_bar.h"

#include "terminal/say.h"

#include <cstdio>
#include <string>

#include <fmt/format.h>
#include <unistd.h>

#include <tether/os/terminal.h>

namespace tether::app {

namespace {

std::string trial_name(const campaign::TrialPlan& plan) {
  return fmt::format("{}, {}, seed {}", plan.scenario->name, plan.condition->name, plan.seed);
}

std::string time_left(const campaign::CampaignProgress& progress) {
  if (!progress.time_left) return "";
  const auto seconds =
      std::chrono::duration_cast<std::chrono::seconds>(*progress.time_left).count();
  return fmt::format("{}:{:02} left", seconds / 60, seconds % 60);
}

}  // namespace

std::string to_line(const campaign::CampaignProgress& progress, int columns) {
  const std::size_t width = columns > 80 ? 30 : columns > 40 ? 10 : 0;
  const std::size_t filled = progress.total == 0 ? width : width * progress.done / progress.total;
  const std::string line = os::fields_in_columns(
      {fmt::format("{}{}/{}",
                   width ? fmt::format("[{:#>{}}{:.>{}}] ", "", filled, "", width - filled) : "",
                   progress.done, progress.total),
       progress.failed ? fmt::format("{} failed", progress.failed) : "", time_left(progress)},
      columns);
  return progress.latest ? os::cut_to_columns(line + "  " + trial_name(*progress.latest), columns)
                         : line;
}

void ProgressBar::show(const campaign::CampaignProgress& progress) {
  if (const int columns = os::terminal_columns(STDERR_FILENO)) {
    say("{}{}", os::kClearLine, to_line(progress, columns));
    std::fflush(stderr);
    shown_ = true;
  } else if (progress.result && progress.latest) {
    say("{}/{}  {}: {}{}{}\n", progress.done, progress.total, trial_name(*progress.latest),
        campaign::name(progress.result->outcome), progress.time_left ? "   " : "",
        time_left(progress));
  }
}

void ProgressBar::finish() {
  if (shown_) say("\n");
}

}  // namespace tether::app
