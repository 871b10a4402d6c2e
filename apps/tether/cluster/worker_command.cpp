#include "commands/commands.h"
#include "terminal/say.h"

#include <algorithm>
#include <cstdlib>
#include <string>

#include <fmt/format.h>
#include <unistd.h>

#include <tether/base/error.h>
#include <tether/campaign/result.h>
#include <tether/os/captured_run.h>
#include <tether/os/program.h>
#include <tether/os/temporary_folder.h>
#include <tether/os/text_file.h>
#include <tether/runner/trial_request.h>
#include <tether/runner/trial_server.h>
#include <tether/stats/sample_statistics.h>
#include <tether/toml/table.h>
#include <tether/workers/cluster.h>
#include <tether/workers/files_check.h>
#include <tether/workers/worker.h>

/// `tether worker`: flies the trials of a shared folder on this machine.
namespace tether::app {

namespace {

namespace fs = std::filesystem;

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

workers::WorkerName own_name() {
  std::string node = variable("SLURMD_NODENAME");
  if (node.empty()) {
    char host[256] = "unknown";
    (void)::gethostname(host, sizeof host - 1);
    node = host;
  }
  node = os::file_name_of(node);
  const std::string job = variable("SLURM_ARRAY_JOB_ID"), task = variable("SLURM_ARRAY_TASK_ID");
  return {.id = node + "." + workers::unique_name(),
          .node = node,
          .task = task.empty() ? "" : job + "_" + task};
}

/// CPU time of the paper's image processing on this machine, by `tether-sut calibrate` [ms]. Of the
/// rounds, a quick one counts: other load makes rounds slower, nothing makes them quicker.
double measure_step_ms(const fs::path& scratch, const std::stop_token& stop) {
  const fs::path file = scratch / "calibration.toml";
  const os::Captured captured =
      os::run_captured({os::find_program("tether-sut").string(), "calibrate", "--rounds", "10",
                        "--out", file.string()},
                       "", std::chrono::minutes(10), stop);
  if (captured.code != 0)
    throw Error(ErrorCode::kSetup, "this node cannot be measured: " + os::last_line(captured.err))
        .about("tether-sut");
  const toml::Document document = toml::Document::load(file);
  for (const toml::Table& block : document.root().tables("block")) {
    if (block.text("name") != "perception") continue;
    std::vector<double> ms = block.numbers("cpu_ms", {.min = 0.0, .above_min = true});
    std::ranges::sort(ms);
    return stats::quantile(ms, 0.25);
  }
  throw Error(ErrorCode::kSetup, {file.string()}, "has no times of \"perception\".");
}

workers::Flight fly(runner::TrialServers& servers, const workers::Item& item, const fs::path& local,
                    double cpu_time_scale, const std::string& node, const std::stop_token& stop) {
  using End = workers::Flight::End;
  try {
    runner::TrialRequest request = runner::parse_trial_request(item.request);
    request.folder = local;
    if (cpu_time_scale != 1.0) request.cpu_time_scale = cpu_time_scale;
    auto result = servers.run(request, stop);
    if (!result)
      return {End::kStopped, "the worker was ended (cancelled, preempted, or over its time limit)"};
    if (result->end == campaign::kEndSetupFailed) return {End::kLost, result->reason};
    result->this_run.node = node;
    result->this_run.attempts = static_cast<int>(item.losses.size()) + 1;
    if (!item.losses.empty()) result->this_run.first_failure = item.losses.front();
    campaign::write_result(local, *result);
    say("{}: {}\n", item.folder, campaign::name(result->outcome));
    return {};
  } catch (const Error& error) {
    if (error.code() == ErrorCode::kUsage || error.code() == ErrorCode::kBadFile) throw;
    return {End::kLost, error.what()};
  }
}

}  // namespace

int work(const WorkerOptions& options, const std::stop_token& stop) {
  const workers::SharedFolder folder(fs::absolute(options.folder));
  const auto round = workers::newest_round(folder);
  if (!round)
    throw Error(ErrorCode::kSetup, {folder.root().string()},
                "contains no trials for workers. Use a folder that this machine shares with the "
                "one on which tether campaign was started (with --slurm or --detach).")
        .about(folder.root().string());
  std::error_code ignored;
  fs::current_path(workers::start_of(*round).working_folder, ignored);
  const auto& files = round->settings().files;
  workers::require_same_files(files);
  const os::TemporaryFolder scratch("tether-worker-");
  runner::TrialServers servers;
  const workers::WorkerName self = own_name();
  const workers::WorkerEnd end = workers::work(
      *round, {.self = self,
               .scratch = scratch.path(),
               .fly =
                   [&](const workers::Item& item, const fs::path& local, double cpu_time_scale) {
                     return fly(servers, item, local, cpu_time_scale, self.node, stop);
                   },
               .check = [&] { workers::require_same_files(files); },
               .measure_ms = [&] { return measure_step_ms(scratch.path(), stop); },
               .stop = stop});
  fmt::print("{} flown, {} lost\n", end.flown, end.lost);
  if (end.why_early.empty()) return 0;
  say("tether: {}\n", end.why_early);
  return exit_code(ErrorCode::kSetup);
}

}  // namespace tether::app
