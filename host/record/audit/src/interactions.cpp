#include "checks.h"

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <tuple>

// Rules 1 to 7 for each interaction alone. `check` calls one function for each aspect: times,
// arrival, release, timestamp, what depends on the kind, and the grid error.
namespace tether::audit {
namespace {

using record::Interaction;
using Entry = record::Logged<Interaction>;

struct Sut {
  const record::SutInfo* info = nullptr;
  std::map<std::string, const record::SensorInfo*> sensors;
};

class InteractionCheck {
 public:
  InteractionCheck(const record::Record& record, const Boundaries& grid, Report& report)
      : record_(record), grid_(grid), report_(report) {
    for (const record::SutInfo& sut : record.header.suts) suts_[sut.uav].info = &sut;
    for (const record::SensorInfo& sensor : record.header.sensors)
      suts_[sensor.uav].sensors[sensor.name] = &sensor;
  }

  void run() {
    std::uint64_t unstamped = 0;
    for (const Entry& entry : record_.interactions) {
      unstamped += entry.message.stamped ? 0U : 1U;
      const auto sut = suts_.find(entry.message.uav);
      if (sut != suts_.end() && sut->second.info != nullptr)  // others: check_consistency
        check(entry, sut->second);
    }
    for (const record::SutInfo& sut : record_.header.suts)
      if (sut.replay)
        report_.note(
            fmt::format("the time of UAV \"{}\" was {}", sut.uav, record::describe(*sut.replay)));
    if (unstamped > 0)
      report_.note(
          fmt::format("rule 6: {} interactions have timestamps of the coordinator, not of "
                      "the SUT. Their ET includes link time",
                      unstamped));
  }

 private:
  void check(const Entry& entry, const Sut& sut) {
    check_times(entry);
    check_arrival(entry);
    check_release(entry);
    check_stamp(entry, sut);
    check_stages(entry, sut);
    if (entry.message.kind == record::kSensor) {
      check_sensor(entry, sut);
    } else if (entry.message.kind == record::kCommand) {
      check_command(entry, sut);
    } else if (entry.message.kind == record::kSleep) {
      check_sleep(entry);
    } else if (entry.message.kind != record::kReceive) {  // those: check_radio
      check_immediate(entry);
    }
    check_grid_error(entry, sut);
    if (entry.message.violation)
      report_.add(5, entry, "causality violation in the record: {}", *entry.message.violation);
  }

  // Rule 5: no reply before its request.
  void check_times(const Entry& entry) {
    const Interaction& m = entry.message;
    if (m.reply_at < m.request_at)
      report_.add(5, entry, "reply at ET {} is before its request at ET {}", ns(m.reply_at),
                  ns(m.request_at));
    const Wide lag = wide(m.request_at) - wide(m.st_at_arrival);
    if (wide(m.lag) != lag)
      report_.add(5, entry, "recorded lag is {}, actual lag is {}", ns(m.lag), ns(lag));
  }

  // Rule 4: ST on arrival is not after the request.
  void check_arrival(const Entry& entry) {
    const Interaction& m = entry.message;
    if (wide(m.st_at_arrival) > grid_.at_or_before(wide(m.request_at)))
      report_.add(4, entry, "ST was {} when a request with timestamp ET {} arrived",
                  ns(m.st_at_arrival), ns(m.request_at));
    if (!grid_.contain(wide(m.st_at_arrival)))
      report_.add(0, entry, "ST on arrival, {}, is not a step boundary", ns(m.st_at_arrival));
  }

  // Rule 3: a reply is sent exactly at the boundary at or before its timestamp.
  void check_release(const Entry& entry) {
    const Interaction& m = entry.message;
    const Wide due = grid_.at_or_before(wide(m.reply_at));
    if (wide(m.st_at_release) != due)
      report_.add(3, entry, "reply with timestamp ET {} was sent at ST {} instead of ST {}",
                  ns(m.reply_at), ns(m.st_at_release), ns(due));
  }

  // Rule 6: the SUT stamps its requests, unless its clock is "unstamped".
  void check_stamp(const Entry& entry, const Sut& sut) {
    const bool should_stamp = sut.info->clock.kind != computer::ClockKind::kUnstamped;
    if (entry.message.stamped != should_stamp)
      report_.add(6, entry, "{} by a SUT whose clock is \"{}\"",
                  entry.message.stamped ? "stamped" : "not stamped",
                  computer::name(sut.info->clock.kind));
  }

  // Rule 5: what was computed under stages is what ET grew by, since the reply before.
  void check_stages(const Entry& entry, const Sut& sut) {
    const Interaction& m = entry.message;
    Wide& resumed = resumed_[m.uav];
    Wide sum = 0;
    for (const record::StageTime& time : m.stages) sum += wide(time.computing);
    // On a shared board, check_boards compares the computed time with the growth of ET.
    const Wide computed = m.computed ? wide(*m.computed) : wide(m.request_at) - resumed;
    if (!m.stages.empty() && !sut.info->concurrent && sum != computed)
      report_.add(5, entry, "stages computed {}, but ET grew by {}", ns(sum), ns(computed));
    resumed = wide(m.reply_at);
  }

  void check_sensor(const Entry& entry, const Sut& sut) {
    const Interaction& read = entry.message;
    const auto found = sut.sensors.find(read.sensor);
    if (found == sut.sensors.end())
      return report_.add(0, entry, "no sensor \"{}\" in the record's header", read.sensor);
    if (read.only_if_available) {
      check_immediate(entry);
      if (!read.sampled_at && !read.sample_state_at && !read.available_at) {
        // check_newness finds out whether a measurement was available.
        if (!found->second->periodic)
          report_.add(0, entry, "no measurement from a sensor that measures on demand");
        return;
      }
    }
    if (!read.sampled_at || !read.sample_state_at || !read.available_at)
      return report_.add(0, entry, "sensor reading without its times");
    check_sample(entry);
    check_delay(entry, *found->second);
    check_timing(entry, *found->second);
  }

  // Rule 1: no data in a reply is from its future.
  void check_sample(const Entry& entry) {
    const Interaction& m = entry.message;
    const Wide state = grid_.at_or_before(wide(*m.sampled_at));
    if (wide(*m.sampled_at) > wide(m.reply_at))
      report_.add(1, entry, "sampled at {}, after the reply at {}", ns(*m.sampled_at),
                  ns(m.reply_at));
    if (wide(*m.sample_state_at) != state)
      report_.add(1, entry, "sampled at {} from the state at ST {} instead of ST {}",
                  ns(*m.sampled_at), ns(*m.sample_state_at), ns(state));
    if (*m.available_at < *m.sampled_at)
      report_.add(1, entry, "available at {}, before the sample at {}", ns(*m.available_at),
                  ns(*m.sampled_at));
    if (wide(m.reply_at) != std::max(wide(m.request_at), wide(*m.available_at)))
      report_.add(1, entry, "requested at {}, available at {}, but replied at {}", ns(m.request_at),
                  ns(*m.available_at), ns(m.reply_at));
  }

  // Rule 1: the delay is within the sensor's bounds. (Negative ones: check_sample.) A repeated
  // measurement is delayed from its own instant on.
  void check_delay(const Entry& entry, const record::SensorInfo& sensor) {
    const Interaction& m = entry.message;
    constexpr Wide kMostRepeated = Wide{1} << 32;
    const Wide later = Wide{m.sample_index} - Wide{m.repeated_index.value_or(m.sample_index)};
    if (later < 0 || later > kMostRepeated)
      return report_.add(1, entry, "measurement {} cannot repeat measurement {}", m.sample_index,
                         *m.repeated_index);
    const Wide delay = wide(*m.available_at) - wide(*m.sampled_at) - later * wide(sensor.period);
    if (delay >= 0 && (delay < wide(sensor.delay_min) || delay > wide(sensor.delay_max)))
      report_.add(1, entry, "available {} after the sample, but the sensor's delay is {} to {}",
                  ns(delay), ns(sensor.delay_min), ns(sensor.delay_max));
  }

  // Rule 1: sampled at the time of that measurement.
  void check_timing(const Entry& entry, const record::SensorInfo& sensor) {
    const Interaction& m = entry.message;
    const std::uint64_t index = m.repeated_index.value_or(m.sample_index);
    const Wide instant = sensor.periodic ? wide(sensor.phase) + Wide{index} * wide(sensor.period)
                                         : wide(m.request_at);
    if (wide(*m.sampled_at) != instant)
      report_.add(1, entry, "measurement {} sampled at {}, but the sensor measures at {}", index,
                  ns(*m.sampled_at), ns(instant));
  }

  // Rule 2: a command takes effect at the first boundary that is not before its time.
  void check_command(const Entry& entry, const Sut& sut) {
    check_immediate(entry);
    const Interaction& m = entry.message;
    if (!m.effect_at) return report_.add(0, entry, "command without the time of its effect");
    const Wide acts = arrival_of(m, *sut.info);
    check_latency(entry, sut, acts);
    if (wide(*m.effect_at) != grid_.at_or_after(acts))
      report_.add(2, entry, "command due at {} is set to take effect at ST {} instead of ST {}",
                  ns(acts), ns(*m.effect_at), ns(grid_.at_or_after(acts)));
  }

  // Rule 2: a latency that is drawn is one that the model can draw. A command that would overtake
  // the one before arrives with it.
  void check_latency(const Entry& entry, const Sut& sut, Wide arrival) {
    const Interaction& m = entry.message;
    const auto& [least, most] = std::tie(sut.info->command_latency, sut.info->max_command_latency);
    if (m.command_latency.has_value() != most.has_value())
      return report_.add(0, entry, "command {} a latency of its own",
                         m.command_latency ? "with" : "without");
    Wide& last = last_arrival_.try_emplace(m.uav, arrival).first->second;
    if (arrival < last)
      report_.add(2, entry, "command arrives at {}, before the one before", ns(arrival));
    const bool is_drawn = most && *m.command_latency >= least && *m.command_latency <= *most;
    if (most && !is_drawn && (*m.command_latency < least || arrival != last))
      report_.add(2, entry, "latency of {} cannot be drawn", ns(*m.command_latency));
    last = arrival;
  }

  // Rule 5: only sleeps and sensor readings take simulated time.
  void check_immediate(const Entry& entry) {
    const Interaction& m = entry.message;
    if (m.reply_at > m.request_at)
      report_.add(5, entry, "a {} cost the SUT {}", m.kind,
                  ns(wide(m.reply_at) - wide(m.request_at)));
  }

  // Rule 7: a sleep takes exactly its time.
  void check_sleep(const Entry& entry) {
    const Interaction& m = entry.message;
    if (!m.sleep_until) return report_.add(0, entry, "sleep without its end");
    const auto wake = std::max(m.request_at, *m.sleep_until);
    if (m.reply_at != wake)
      report_.add(7, entry, "woken at ET {} instead of ET {}", ns(m.reply_at), ns(wake));
  }

  // The grid error, computed again: always less than a step.
  void check_grid_error(const Entry& entry, const Sut& sut) {
    const Interaction& m = entry.message;
    Wide error = wide(m.reply_at) - wide(m.st_at_release);
    if (m.sampled_at && m.sample_state_at)
      error = std::max(error, wide(*m.sampled_at) - wide(*m.sample_state_at));
    if (m.effect_at) {
      const Wide acts = arrival_of(m, *sut.info);
      error = std::max(error, wide(*m.effect_at) - acts);
    }
    if (error != wide(m.grid_error))
      report_.add(0, entry, "recorded grid error is {}, actual grid error is {}", ns(m.grid_error),
                  ns(error));
    // A larger one is a breach of another rule, which has a finding.
    if (error >= 0 && error < grid_.step()) {
      Duration& largest = report_.verdict().largest_grid_error;
      largest = std::max(largest, Duration(static_cast<std::int64_t>(error)));
    }
  }

  std::map<std::string, Wide> last_arrival_;  // of commands, by UAV
  const record::Record& record_;
  const Boundaries& grid_;
  Report& report_;
  std::map<std::string, Sut> suts_;
  std::map<std::string, Wide> resumed_;  // by UAV: ET of the last reply; 0 before the first
};

}  // namespace

void check_interactions(const record::Record& record, const Boundaries& grid, Report& report) {
  InteractionCheck(record, grid, report).run();
}

}  // namespace tether::audit
