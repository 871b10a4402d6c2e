#include "time_left.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include <tether/campaign/run_campaign.h>
#include <tether/os/text_file.h>

// `Run` executes the batches one after the other, each with as many threads as it has jobs. A
// thread takes the next trial, attempts it up to twice in an empty folder, and writes its result.
namespace tether::campaign {
namespace {

Duration machine_wall() {
  return std::chrono::steady_clock::now().time_since_epoch();
}

void require_made(const std::filesystem::path& folder, const std::error_code& failed) {
  if (!failed) return;
  throw Error(ErrorCode::kSetup, {folder.string()},
              "the trial's folder cannot be made or emptied: " + failed.message() + ".")
      .about(folder.string());
}

// A new folder: a trial that is just being killed with an earlier campaign may have locked the old.
void empty_folder(const std::filesystem::path& folder) {
  std::error_code failed;
  std::filesystem::remove_all(folder, failed);
  if (!failed) std::filesystem::create_directories(folder, failed);
  require_made(folder, failed);
}

// For a second attempt: the log shows why the first one failed.
void empty_but_for_log(const std::filesystem::path& folder) {
  std::error_code failed;
  std::vector<std::filesystem::path> others;
  for (const auto& entry : std::filesystem::directory_iterator(folder, failed)) {
    if (entry.path().filename() != kTrialLog) others.push_back(entry.path());
  }
  for (const std::filesystem::path& other : others) {
    if (!failed) std::filesystem::remove_all(other, failed);
  }
  require_made(folder, failed);
}

bool is_users_fault(const Error& error) {
  return error.code() == ErrorCode::kUsage || error.code() == ErrorCode::kBadFile;
}

TrialResult attempt(const TrialPlan& plan, const TrialExecutor& execute) {
  try {
    return execute(plan);
  } catch (const Error& error) {
    if (is_users_fault(error)) throw;
    return make_setup_failure(*plan.scenario, *plan.condition, plan.seed, error.what());
  }
}

TrialResult attempt_twice(const TrialPlan& plan, const TrialExecutor& execute,
                          const std::stop_token& stop) {
  empty_folder(plan.folder);
  TrialResult first = attempt(plan, execute);
  if (first.end != kEndSetupFailed || stop.stop_requested()) return first;
  empty_but_for_log(plan.folder);
  TrialResult second = attempt(plan, execute);
  second.this_run.attempts = 2;
  second.this_run.first_failure = first.reason;
  // Without a program's end, the machine, the link or the simulator failed.
  if (!first.suts.empty() && second.outcome != Outcome::kFailed)
    second.warnings.push_back({Consequence::kDoubtful,
                               {},
                               "a program",
                               "failed in a first attempt, and the flight was begun again"});
  return second;
}

// The trials of one run: hands them to threads, keeps their results, reports progress.
class Run {
 public:
  Run(std::span<const TrialPlan* const> missing, std::size_t done_before,
      const TrialExecutor& execute, const CampaignOptions& options,
      const ProgressCallback& progress)
      : execute_(execute),
        options_(options),
        progress_(progress),
        wall_(options.wall ? options.wall : machine_wall),
        batches_(make_batches(in_order_of_flight({missing.begin(), missing.end()}), options.jobs)),
        done_before_(done_before),
        total_(done_before + missing.size()) {}

  CampaignOutcome run() {
    for (const Batch& batch : batches_) run_all(batch.plans, batch.jobs);
    if (error_) std::rethrow_exception(error_);
    outcome_.interrupted = outcome_.interrupted || options_.stop.stop_requested();
    return outcome_;
  }

 private:
  using Queue = std::vector<const TrialPlan*>;

  void run_all(const Queue& queue, int jobs) {
    const std::size_t most = std::min(queue.size(), static_cast<std::size_t>(jobs));
    std::size_t next = 0;
    std::vector<std::jthread> threads;
    for (std::size_t i = 1; i < most; ++i) threads.emplace_back([&] { work(queue, next); });
    work(queue, next);
    threads.clear();  // joins
  }

  void work(const Queue& queue, std::size_t& next) {
    while (const TrialPlan* plan = take(queue, next)) run_one(*plan);
  }

  const TrialPlan* take(const Queue& queue, std::size_t& next) {
    const std::lock_guard lock(mutex_);
    const bool over = error_ || outcome_.interrupted || options_.stop.stop_requested();
    if (over || next == queue.size()) return nullptr;
    ++running_;
    report(*queue[next], nullptr);
    return queue[next++];
  }

  // An exception in a thread ends the run, and is thrown to the caller at its end.
  void run_one(const TrialPlan& plan) {
    const Duration start = wall_();
    try {
      const TrialResult result = attempt_twice(plan, execute_, options_.stop);
      const bool is_result = result.end != kEndInterrupted;
      if (is_result) keep(plan, result);
      finish(plan, is_result ? &result : nullptr, wall_() - start);
    } catch (...) {
      const std::lock_guard lock(mutex_);
      --running_;
      if (!error_) error_ = std::current_exception();
    }
  }

  // If the check fails, a result that the executor wrote must not count as kept.
  void keep(const TrialPlan& plan, const TrialResult& result) const {
    try {
      if (options_.check) options_.check();
    } catch (...) {
      std::error_code ignored;
      std::filesystem::remove(plan.folder / kResultFile, ignored);
      throw;
    }
    write_result(plan.folder, result);
  }

  void finish(const TrialPlan& plan, const TrialResult* result, Duration took) {
    const std::lock_guard lock(mutex_);
    --running_;
    if (result == nullptr) {
      outcome_.interrupted = true;
      return;
    }
    ++outcome_.ran;
    if (result->outcome == Outcome::kFailed) ++outcome_.failed;
    finished_.push_back({&plan, took});
    report(plan, result);
  }

  // @pre mutex_ held.
  void report(const TrialPlan& plan, const TrialResult* result) const {
    if (!progress_) return;
    CampaignProgress now;
    now.done = done_before_ + outcome_.ran;
    now.total = total_;
    now.running = running_;
    now.failed = outcome_.failed;
    now.time_left = estimate_time_left(finished_, batches_);
    now.latest = &plan;
    now.result = result;
    progress_(now);
  }

  const TrialExecutor& execute_;
  const CampaignOptions& options_;
  const ProgressCallback& progress_;
  std::function<Duration()> wall_;
  std::vector<Batch> batches_;
  std::size_t done_before_, total_;

  std::mutex mutex_;  // of everything below, and of the position in a queue
  std::size_t running_ = 0;
  std::vector<FinishedTrial> finished_;
  CampaignOutcome outcome_;
  std::exception_ptr error_;
};

}  // namespace

CampaignOutcome run_campaign(const CampaignFolder& folder, const scenario::Campaign& campaign,
                             const TrialExecutor& execute, const CampaignOptions& options,
                             const ProgressCallback& progress) {
  require_jobs_allowed(campaign, options.jobs);
  std::vector<const TrialPlan*> missing;
  for (const TrialPlan& plan : folder.missing()) missing.push_back(&plan);
  return Run(missing, folder.finished().size(), execute, options, progress).run();
}

CampaignOutcome run_trials(std::span<const TrialPlan* const> missing, const TrialExecutor& execute,
                           const CampaignOptions& options, const ProgressCallback& progress) {
  return Run(missing, 0, execute, options, progress).run();
}

}  // namespace tether::campaign
