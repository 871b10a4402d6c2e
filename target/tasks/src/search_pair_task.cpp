#include "motion.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <string_view>
#include <utility>

#include <tether/tasks/mission_tasks.h>
#include <tether/tasks/task.h>

namespace tether::tasks {
namespace {

constexpr std::string_view kWords[] = {"found", "here"};
/// How often the one that has come says so: its messages may be lost.
constexpr int kGreetings = 5;
/// Until the UAV turns no more: what it measures before its way must not be the end of a turn.
constexpr Duration kSettling = std::chrono::seconds(1);

}  // namespace

SearchPairTask::SearchPairTask(std::string anchor, const SearchPairOptions& options)
    : anchor_(std::move(anchor)),
      options_(options),
      limit_(options.search.time_limit, options.search.max_images) {}

Progress SearchPairTask::initialise(TaskContext& context) {
  limit_.start(context.vehicle().now());
  images_ = seen_in_a_row_ = sent_ = 0;
  found_ = false;
  const Result<double> yaw_rad = get_yaw(context, options_.imu);
  if (!yaw_rad) return TaskOutcome::failed(yaw_rad.failure());
  start_yaw_rad_ = *yaw_rad;
  const double sign = options_.search.clockwise ? -1.0 : 1.0;
  const Status turning = turn(context, sign * options_.search.yaw_rate_rad_s);
  return turning ? std::nullopt : Progress(TaskOutcome::failed(turning.failure()));
}

Progress SearchPairTask::step(TaskContext& context) {
  if (Progress end = limit_.next_round(context.vehicle().now())) return end;
  return found_ ? call(context) : search(context);
}

Result<std::optional<SearchPairTask::Word>> SearchPairTask::listen(TaskContext& context,
                                                                   Duration timeout) {
  std::optional<Word> last;
  while (true) {
    const auto message = context.vehicle().receive(last ? Duration(0) : timeout);
    if (!message && message.failure().kind == Failure::Kind::kNothingYet) return last;
    if (!message) return message.failure();
    const std::string_view text(reinterpret_cast<const char*>(message->bytes.data()),
                                message->bytes.size());
    const auto* const word = std::find(std::begin(kWords), std::end(kWords), text);
    if (word != std::end(kWords)) last = static_cast<Word>(word - std::begin(kWords));
  }
}

Status SearchPairTask::say(TaskContext& context, Word word) {
  const std::string_view text = kWords[static_cast<std::size_t>(word)];
  ++sent_;
  context.note_event(name(), "radio", text);
  return context.vehicle().send("",
                                {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

Progress SearchPairTask::search(TaskContext& context) {
  const Result<std::optional<Sight>> sight = look(context, anchor_);
  if (!sight) return TaskOutcome::failed(sight.failure());
  ++images_;
  seen_in_a_row_ = *sight ? seen_in_a_row_ + 1 : 0;
  if (seen_in_a_row_ >= options_.search.frames) {
    found_ = true;
    const Status stopped = stop(context);
    return stopped ? std::nullopt : Progress(TaskOutcome::failed(stopped.failure()));
  }
  const auto word = listen(context, Duration(0));
  if (!word) return TaskOutcome::failed(word.failure());
  return *word == Word::kFound ? come(context) : std::nullopt;
}

// If both have found it, each hears that from the other, and none has to come.
Progress SearchPairTask::call(TaskContext& context) {
  if (const Status sent = say(context, Word::kFound); !sent)
    return TaskOutcome::failed(sent.failure());
  const auto word = listen(context, options_.repeat);
  if (!word) return TaskOutcome::failed(word.failure());
  return *word ? Progress(TaskOutcome::goal_reached()) : std::nullopt;
}

Progress SearchPairTask::come(TaskContext& context) {
  if (const Status stopped = stop(context); !stopped) return TaskOutcome::failed(stopped.failure());
  const Status still = pause(context, options_.imu, kSettling);
  if (!still) return TaskOutcome::failed(still.failure());
  const Result<double> yaw_rad = get_yaw(context, options_.imu);
  if (!yaw_rad) return TaskOutcome::failed(yaw_rad.failure());
  const double way_m = std::hypot(options_.partner_ahead_m, options_.partner_left_m);
  const double direction_rad =
      std::atan2(options_.partner_left_m, options_.partner_ahead_m) + start_yaw_rad_ - *yaw_rad;
  GoToOptions go;
  go.ahead_m = std::max(way_m - options_.gap_m, 0.0) * std::cos(direction_rad);
  go.left_m = std::max(way_m - options_.gap_m, 0.0) * std::sin(direction_rad);
  go.speed_m_s = options_.speed_m_s;
  go.imu = options_.imu;
  go.settle_time = Duration(0);  // it has settled
  go.time_limit =
      std::max(options_.search.time_limit - limit_.elapsed(context.vehicle().now()), Duration(1));
  GoToTask going(go);
  const TaskOutcome came = run(going, context);
  if (!came.reached()) return came;
  for (int greeting = 0; greeting < kGreetings; ++greeting) {
    if (const Status sent = say(context, Word::kHere); !sent)
      return TaskOutcome::failed(sent.failure());
    if (const Status slept = context.vehicle().sleep_for(options_.repeat / kGreetings); !slept)
      return TaskOutcome::failed(slept.failure());
  }
  return TaskOutcome::goal_reached();
}

void SearchPairTask::finalise(TaskContext& context, TaskOutcome& outcome) {
  fail_on(stop(context), outcome);
  outcome.results["duration_s"] = to_seconds(limit_.elapsed(context.vehicle().now()));
  outcome.results["images"] = images_;
  outcome.results["found"] = found_ ? 1.0 : 0.0;
  outcome.results["sent"] = sent_;
}

}  // namespace tether::tasks
