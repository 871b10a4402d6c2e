#include "cluster/fly_by_workers.h"

#include "terminal/say.h"

#include <iostream>
#include <string>

#include <fmt/format.h>
#include <unistd.h>

#include <tether/base/error.h>
#include <tether/os/terminal.h>

namespace tether::app {

namespace {

bool is_campaign(const workers::Start& start) {
  return !start.command.empty();
}

std::string how_to_continue(const workers::Start& start, const std::string& out) {
  return is_campaign(start) ? fmt::format("To continue, type: tether campaign --collect {}", out)
                            : "To continue, repeat tether size with --resume.";
}

bool is_asked_to_cancel() {
  if (::isatty(STDIN_FILENO) == 0 || os::terminal_columns(STDERR_FILENO) == 0) return false;
  say("\nCancel the jobs? Otherwise they continue. [y/N] ");
  std::string answer;
  std::getline(std::cin, answer);
  return answer == "y" || answer == "Y" || answer == "yes";
}

void end_or_leave(const workers::Cluster& cluster, workers::CollectEnd end,
                  const std::stop_token& stop) {
  const std::string out = cluster.folder().string();
  if (!cluster.start().options.slurm) {
    say("tether: trials are ready for workers. On machines that share this folder, start: {}\n"
        "Then type: tether campaign --collect {}\n",
        workers::worker_command(cluster.folder()), out);
  } else if (stop.stop_requested() && is_asked_to_cancel()) {
    cancel_jobs(cluster.folder());
  } else {
    const std::string next = how_to_continue(cluster.start(), out);
    if (end == workers::CollectEnd::kCancelled)
      say("tether: the jobs were cancelled. {}\n", next);
    else
      say("tether: the jobs continue. {}\nTo cancel them: tether campaign --cancel {}\n", next,
          out);
  }
}

}  // namespace

workers::Collected fly_by_workers(workers::Cluster& cluster,
                                  std::span<const campaign::TrialPlan* const> plans,
                                  const std::vector<std::filesystem::path>& files,
                                  std::size_t done_before, const std::stop_token& stop,
                                  const campaign::ProgressCallback& progress) {
  const auto tell = [](const std::string& line) { say("{}\n", line); };
  workers::Collected collected = cluster.fly(plans, files, done_before, stop, tell, progress);
  if (collected.end != workers::CollectEnd::kComplete) end_or_leave(cluster, collected.end, stop);
  return collected;
}

int cancel_jobs(const std::filesystem::path& out) {
  const workers::Start start = workers::cancel_jobs(out);
  say("tether: the jobs are cancelled; results are kept. {}\n",
      how_to_continue(start, out.string()));
  return 0;
}

workers::Start campaign_in(const std::filesystem::path& out) {
  workers::Start start = workers::last_start(out);
  if (is_campaign(start)) return start;
  throw Error(ErrorCode::kUsage, {out.string()},
              "contains the flights of tether size. Continue it with tether size --resume.")
      .about(out.string());
}

}  // namespace tether::app
