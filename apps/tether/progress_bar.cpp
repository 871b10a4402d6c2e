#include "progress_bar.h"

#include "say.h"

#include <cstdio>
#include <string>

#include <fmt/format.h>
#include <unistd.h>

namespace tether::app {

namespace {

constexpr std::size_t kWidth = 30;

std::string trial_name(const campaign::TrialPlan& plan) {
  return fmt::format("{}, {}, seed {}", plan.scenario->name, plan.condition->name, plan.seed);
}

std::string time_left(const campaign::CampaignProgress& progress) {
  if (!progress.time_left) return "";
  const auto seconds =
      std::chrono::duration_cast<std::chrono::seconds>(*progress.time_left).count();
  return fmt::format("   {}:{:02} left", seconds / 60, seconds % 60);
}

}  // namespace

ProgressBar::ProgressBar() : is_terminal_(isatty(STDERR_FILENO) == 1) {}

void ProgressBar::show(const campaign::CampaignProgress& progress) {
  if (is_terminal_) {
    const std::size_t filled =
        progress.total == 0 ? kWidth : kWidth * progress.done / progress.total;
    say("\r\x1b[K[{:#>{}}{:.>{}}] {}/{}{}{}   {}", "", filled, "", kWidth - filled, progress.done,
        progress.total, progress.failed ? fmt::format("   {} failed", progress.failed) : "",
        time_left(progress), progress.latest ? trial_name(*progress.latest) : "");
    std::fflush(stderr);
    shown_ = true;
  } else if (progress.result && progress.latest) {
    say("{}/{}  {}: {}{}\n", progress.done, progress.total, trial_name(*progress.latest),
        campaign::name(progress.result->outcome), time_left(progress));
  }
}

void ProgressBar::finish() {
  if (shown_) say("\n");
}

}  // namespace tether::app
