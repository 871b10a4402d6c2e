#include "events.h"

#include "times.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <set>
#include <utility>

namespace tether::judge {
namespace {

using record::Interaction;

/// A measurement that the SUT had.
struct Sample {
  SimTime had_at;
  std::uint64_t sequence = 0;  ///< of its read
  SimTime sampled_at;
};

/// What the SUT told its UAV to fly, by the library or as a set-point by MAVLink.
struct Command {
  SimTime sent;
  std::uint64_t sequence = 0;  ///< of its call
  std::optional<SimTime> effect_at{};
};

/// The interactions of a SUT in a span, and what the quantities need of them.
class Calls {
 public:
  Calls(const std::string& uav, const Span& span, const record::Record& record) : times_(record) {
    for (const record::SensorInfo& sensor : record.header.sensors)
      if (sensor.uav == uav && sensor.kind == "camera") cameras_.insert(sensor.name);
    for (const auto& logged : record.interactions) {
      const Interaction& i = logged.message;
      if (i.uav == uav && times_.sent(i) >= span.from && times_.answered(i) <= span.to)
        own_.push_back(&i);
      if (i.uav == uav && i.kind == record::kCommand && times_.sent(i) >= span.from &&
          times_.answered(i) <= span.to)
        commands_.push_back({times_.sent(i), i.sequence, i.effect_at});
    }
    std::ranges::stable_sort(own_, {}, [&](const Interaction* i) { return times_.sent(*i); });
    for (const auto& logged : record.autopilot) {
      const record::AutopilotMessage& m = logged.message;
      if (m.uav == uav && m.is_setpoint() && m.sent_at >= span.from && m.sent_at <= span.to)
        commands_.push_back({m.sent_at, m.sequence, m.acted_at});
    }
    std::ranges::stable_sort(commands_, {}, [](const Command& command) {
      return std::pair(command.sent, command.sequence);
    });
  }

  const std::vector<Command>& commands() const { return commands_; }

  std::vector<const Interaction*> of_kind(std::string_view kind) const {
    std::vector<const Interaction*> found;
    for (const Interaction* i : own_)
      if (i->kind == kind) found.push_back(i);
    return found;
  }
  /// Of one sensor; if `sensor` is empty, of all, or of all cameras.
  std::vector<Sample> samples(const std::string& sensor, bool of_cameras) const {
    std::vector<Sample> samples;
    for (const Interaction* i : of_kind(record::kSensor)) {
      const bool is_wanted =
          sensor.empty() ? !of_cameras || cameras_.contains(i->sensor) : i->sensor == sensor;
      if (is_wanted && i->sampled_at)
        samples.push_back({times_.answered(*i), i->sequence, *i->sampled_at});
    }
    std::ranges::stable_sort(samples, {}, [](const Sample& sample) {
      return std::pair(sample.had_at, sample.sequence);
    });
    return samples;
  }
  /// How long calls took that were sent in [from, to). Of calls at the same time, each counts.
  Duration waiting(SimTime from, SimTime to) const {
    Duration sum{0};
    const auto sent = [&](const Interaction* i) { return times_.sent(*i); };
    for (auto i = std::ranges::lower_bound(own_, from, {}, sent); i != own_.end(); ++i) {
      if (sent(*i) >= to) break;
      sum += times_.answered(**i) - sent(*i);
    }
    return sum;
  }
  const Times& times() const { return times_; }

 private:
  Times times_;
  std::set<std::string> cameras_;
  std::vector<const Interaction*> own_;
  std::vector<Command> commands_;
};

/// Calls `take` with each command and the newest of `samples` that the SUT had when it sent it.
/// Commands without one are left out.
template <class Take>
void with_newest(const Calls& calls, const std::vector<Sample>& samples, const Take& take) {
  std::size_t had = 0;
  const Sample* newest = nullptr;
  for (const Command& command : calls.commands()) {
    // In free running, the next read can be answered in the step of ST in which this command came.
    const auto had_before = [&](const Sample& sample) {
      return std::pair(sample.had_at, sample.sequence) < std::pair(command.sent, command.sequence);
    };
    for (; had < samples.size() && had_before(samples[had]); ++had)
      if (!newest || samples[had].sampled_at > newest->sampled_at) newest = &samples[had];
    if (newest) take(command, *newest);
  }
}

Reaction reaction_of(const Calls& calls, const Command& command, const Sample& newest,
                     Duration until_effect) {
  const Duration until_command = command.sent - newest.had_at;
  return {newest.had_at - newest.sampled_at, until_command, until_effect,
          until_command - calls.waiting(newest.had_at, command.sent)};
}

std::vector<Event> reaction_times(const Calls& calls, const std::string& sensor) {
  std::vector<Event> events;
  with_newest(calls, calls.samples(sensor, true), [&](const Command& command, const Sample& image) {
    if (!command.effect_at) return;
    events.push_back({*command.effect_at, to_seconds(*command.effect_at - image.sampled_at),
                      reaction_of(calls, command, image, *command.effect_at - command.sent)});
  });
  return events;
}

std::vector<Event> data_ages(const Calls& calls, const std::string& sensor) {
  std::vector<Event> events;
  with_newest(calls, calls.samples(sensor, false),
              [&](const Command& command, const Sample& sample) {
                events.push_back({command.sent, to_seconds(command.sent - sample.sampled_at),
                                  reaction_of(calls, command, sample, Duration(0))});
              });
  return events;
}

std::vector<Event> loop_periods(const Calls& calls, const std::string& sensor) {
  std::vector<SimTime> rounds;
  if (sensor.empty())
    for (const Command& command : calls.commands()) rounds.push_back(command.sent);
  for (const Interaction* i : calls.of_kind(record::kSensor))
    if (i->sensor == sensor) rounds.push_back(calls.times().sent(*i));
  std::vector<Event> events;
  for (std::size_t i = 1; i < rounds.size(); ++i)
    events.push_back({rounds[i], to_seconds(rounds[i] - rounds[i - 1]), {}});
  return events;
}

std::vector<Event> loop_jitters(const Calls& calls, const std::string& sensor) {
  std::vector<Event> events = loop_periods(calls, sensor);
  double mean = 0.0;
  for (const Event& event : events) mean += event.value / static_cast<double>(events.size());
  for (Event& event : events) event.value = std::abs(event.value - mean);
  return events;
}

}  // namespace

std::vector<Event> events_of(const mission::Condition& condition, const std::string& uav,
                             const Span& span, const record::Record& record) {
  const Calls calls(uav, span, record);
  const std::string_view name = condition.quantity->name;
  if (name == "reaction_time") return reaction_times(calls, condition.of);
  if (name == "data_age") return data_ages(calls, condition.of);
  if (name == "loop_period") return loop_periods(calls, condition.of);
  return loop_jitters(calls, condition.of);
}

}  // namespace tether::judge
