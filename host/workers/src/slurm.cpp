#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <sstream>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <tether/base/error.h>
#include <tether/os/text_file.h>
#include <tether/workers/engine.h>

// The job's name is unique and stands in the round, so that the job is found again when its
// submission was interrupted before its number was known.
namespace tether::workers {
namespace {

/// Options of sbatch that would break the array, or how it is found again.
constexpr std::array<std::string_view, 12> kOwnOptions = {
    "--array", "-a", "--job-name", "-J", "--wrap",   "--requeue",
    "--wait",  "-W", "--parsable", "-o", "--output", "--test-only"};

std::string reason_in(const Answer& answer) {
  const std::size_t end = answer.err.find_last_not_of(" \n");
  const std::string text = answer.err.substr(0, end == std::string::npos ? 0 : end + 1);
  const std::size_t line = text.rfind('\n');
  const std::string last = line == std::string::npos ? text : text.substr(line + 1);
  return last.empty() ? fmt::format("it exited with code {}", answer.code) : last;
}

std::vector<std::string> split(const std::string& line, char at) {
  std::vector<std::string> parts;
  std::istringstream stream(line);
  for (std::string part; std::getline(stream, part, at);) parts.push_back(part);
  return parts;
}

class Slurm final : public Engine {
 public:
  explicit Slurm(SlurmSettings settings) : settings_(std::move(settings)) {
    for (const std::string& option : settings_.options) {
      const std::string name = option.substr(0, option.find('='));
      if (std::ranges::find(kOwnOptions, name) == kOwnOptions.end()) continue;
      throw Error(ErrorCode::kUsage,
                  fmt::format("--slurm-options: {} is set by tether. Remove it.", name))
          .about(name);
    }
    const Answer answer = settings_.run({"sinfo", "--noheader", "--format=%D"});
    if (answer.code == 0) return;
    throw Error(ErrorCode::kSetup,
                fmt::format("--slurm: Slurm does not answer here: {}. Run this on a machine from "
                            "which sbatch works, or use --jobs.",
                            reason_in(answer)))
        .about("--slurm");
  }

  bool start(const Round& round, const Order& order) override {
    Answer answer = submit(round, order);
    if (answer.code != 0 && !order.avoid.empty()) {  // there may be no others
      Order anywhere = order;
      anywhere.avoid.clear();
      answer = submit(round, anywhere);
    }
    if (answer.code == 0) return true;
    throw Error(ErrorCode::kSetup,
                fmt::format("Slurm rejected the job: {}. Check --slurm-options, and continue with "
                            "--resume.",
                            reason_in(answer)))
        .about("--slurm");
  }

  std::optional<std::vector<Task>> tasks(const Round& round) override {
    const Answer answer =
        settings_.run({"squeue", "--noheader", "--array", "--states=all",
                       "--name=" + round.settings().job, "--format=%F_%K|%T|%N|%r"});
    if (answer.code != 0) return std::nullopt;
    std::vector<Task> tasks;
    for (const std::string& line : split(answer.out, '\n')) {
      const auto parts = split(line, '|');
      if (parts.size() < 3) continue;
      const std::string& state = parts[1];
      const bool is_waiting = state == "PENDING" || state == "REQUEUED";
      const bool runs = state == "RUNNING" || state == "CONFIGURING" || state == "COMPLETING" ||
                        state == "SUSPENDED" || state == "STOPPED" || state == "RESIZING" ||
                        state == "SIGNALING" || state == "STAGE_OUT" || state == "RESV_DEL_HOLD";
      tasks.push_back({.name = parts[0],
                       .is_alive = is_waiting || runs,
                       .is_waiting = is_waiting,
                       .state = is_waiting && parts.size() > 3 ? parts[3] : state,
                       .node = parts[2]});
    }
    return tasks;
  }

  void cancel(const Round& round) override {
    const Answer answer = settings_.run({"scancel", "--name=" + round.settings().job});
    if (answer.code == 0) return;
    throw Error(ErrorCode::kSetup, fmt::format("Slurm did not cancel job {}: {}. Try again.",
                                               round.settings().job, reason_in(answer)))
        .about("--cancel");
  }

 private:
  Answer submit(const Round& round, const Order& order) const {
    std::vector<std::string> words = {
        "sbatch", "--parsable", fmt::format("--array=1-{}", order.tasks),
        "--job-name=" + round.settings().job, "--no-requeue", "--ntasks=1",
        order.cores > 0 ? fmt::format("--cpus-per-task={}", order.cores) : "--exclusive",
        "--output=" + (round.whole_path("logs") / "%a.log").string(),
        // sbatch reads the folder of the user's shell, which nodes need not have.
        "--chdir=/"};
    if (!order.avoid.empty())
      words.push_back(fmt::format("--exclude={}", fmt::join(order.avoid, ",")));
    words.insert(words.end(), settings_.options.begin(), settings_.options.end());
    words.push_back("--wrap=exec " + settings_.worker);
    return settings_.run(words);
  }

  SlurmSettings settings_;
};

}  // namespace

std::unique_ptr<Engine> make_slurm(SlurmSettings settings) {
  return std::make_unique<Slurm>(std::move(settings));
}

std::optional<std::size_t> slurm_cores(const RunProgram& run) {
  const Answer answer = run({"sinfo", "--noheader", "--format=%C"});  // allocated/idle/other/total
  const auto parts = split(answer.out, '/');
  if (answer.code != 0 || parts.size() != 4) return std::nullopt;
  std::size_t cores = 0;
  for (const std::size_t i : {std::size_t{0}, std::size_t{1}}) {
    std::size_t number = 0;
    std::from_chars(parts[i].data(), parts[i].data() + parts[i].size(), number);
    cores += number;
  }
  return cores;
}

}  // namespace tether::workers
