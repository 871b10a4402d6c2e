#include "checks.h"

#include <algorithm>
#include <map>
#include <optional>
#include <string>

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
    for (const record::SutInfo& sut : record.header.suts) {
      suts_[sut.uav].info = &sut;
    }
    for (const record::SensorInfo& sensor : record.header.sensors) {
      suts_[sensor.uav].sensors[sensor.name] = &sensor;
    }
  }

  void run() {
    std::uint64_t unstamped = 0;
    for (const Entry& entry : record_.interactions) {
      unstamped += entry.message.stamped ? 0U : 1U;
      const auto sut = suts_.find(entry.message.uav);
      if (sut != suts_.end() && sut->second.info != nullptr) {  // others: check_consistency
        check(entry, sut->second);
      }
    }
    if (unstamped > 0) {
      report_.note("rule 6: " + std::to_string(unstamped) +
                   " interactions were stamped by the coordinator, not by the SUT: their ET "
                   "includes time on the wire");
    }
  }

 private:
  void check(const Entry& entry, const Sut& sut) {
    check_times(entry);
    check_arrival(entry);
    check_release(entry);
    check_stamp(entry, sut);
    if (entry.message.kind == record::kSensor) {
      check_sensor(entry, sut);
    } else if (entry.message.kind == record::kCommand) {
      check_command(entry, sut);
    } else if (entry.message.kind == record::kSleep) {
      check_sleep(entry);
    } else {
      check_immediate(entry);
    }
    check_grid_error(entry, sut);
    if (entry.message.violation) {
      report_.add(5, entry, "recorded as a causality violation: " + *entry.message.violation);
    }
  }

  // Rule 5: no reply before its request.
  void check_times(const Entry& entry) {
    const Wide request = wide(entry.message.request_at);
    if (wide(entry.message.reply_at) < request) {
      report_.add(5, entry,
                  "replied at ET " + ns(wide(entry.message.reply_at)) + ", before its request at " +
                      ns(request));
    }
    const Wide lag = request - wide(entry.message.st_at_arrival);
    if (wide(entry.message.lag) != lag) {
      report_.add(5, entry,
                  "lag of " + ns(wide(entry.message.lag)) + " recorded, it was " + ns(lag));
    }
  }

  // Rule 4: ST on arrival is not beyond the request.
  void check_arrival(const Entry& entry) {
    const Wide arrival = wide(entry.message.st_at_arrival);
    const Wide bound = grid_.at_or_before(wide(entry.message.request_at));
    if (arrival > bound) {
      report_.add(4, entry,
                  "ST had reached " + ns(arrival) + " when a request stamped " +
                      ns(wide(entry.message.request_at)) + " arrived");
    }
    if (!grid_.contain(arrival)) {
      report_.add(0, entry, "ST on arrival, " + ns(arrival) + ", is no step boundary");
    }
  }

  // Rule 3: a reply leaves exactly at the boundary at or before its stamp.
  void check_release(const Entry& entry) {
    const Wide due = grid_.at_or_before(wide(entry.message.reply_at));
    const Wide release = wide(entry.message.st_at_release);
    if (release != due) {
      report_.add(3, entry,
                  "reply stamped " + ns(wide(entry.message.reply_at)) + " left at ST " +
                      ns(release) + ", not at " + ns(due));
    }
  }

  // Rule 6: a SUT that claims to stamp does.
  void check_stamp(const Entry& entry, const Sut& sut) {
    const bool claims_to_stamp = sut.info->clock != "unstamped";
    if (entry.message.stamped != claims_to_stamp) {
      report_.add(6, entry,
                  std::string(entry.message.stamped ? "stamped" : "not stamped") +
                      " by a SUT whose clock is \"" + sut.info->clock + "\"");
    }
  }

  void check_sensor(const Entry& entry, const Sut& sut) {
    const Interaction& read = entry.message;
    const auto found = sut.sensors.find(read.sensor);
    if (found == sut.sensors.end()) {
      return report_.add(0, entry, "no sensor \"" + read.sensor + "\" in the record's header");
    }
    if (read.only_if_available) {
      check_immediate(entry);
      if (!read.sampled_at && !read.sample_state_at && !read.available_at) {
        return check_in_vain(entry, *found->second);
      }
    }
    if (!read.sampled_at || !read.sample_state_at || !read.available_at) {
      return report_.add(0, entry, "a sensor reading without its times");
    }
    check_sample(entry);
    check_delay(entry, *found->second);
    check_timing(entry, *found->second);
  }

  // What it missed: check_newness.
  void check_in_vain(const Entry& entry, const record::SensorInfo& sensor) {
    if (!sensor.periodic) {
      report_.add(0, entry, "found nothing on a sensor that measures on demand");
    }
  }

  // Rule 1: nothing in a reply is from its future.
  void check_sample(const Entry& entry) {
    const Wide request = wide(entry.message.request_at);
    const Wide reply = wide(entry.message.reply_at);
    const Wide sampled = wide(*entry.message.sampled_at);
    const Wide state = wide(*entry.message.sample_state_at);
    const Wide available = wide(*entry.message.available_at);
    if (sampled > reply) {
      report_.add(1, entry, "sampled at " + ns(sampled) + ", after its reply at " + ns(reply));
    }
    if (state != grid_.at_or_before(sampled)) {
      report_.add(1, entry,
                  "sampled at " + ns(sampled) + " from the state of ST " + ns(state) + ", not of " +
                      ns(grid_.at_or_before(sampled)));
    }
    if (available < sampled) {
      report_.add(1, entry,
                  "available at " + ns(available) + ", before it was sampled at " + ns(sampled));
    }
    if (reply != std::max(request, available)) {
      report_.add(1, entry,
                  "requested at " + ns(request) + ", available at " + ns(available) +
                      ", but replied at " + ns(reply));
    }
  }

  // Rule 1: the data was there when the sensor's delay says. (Negative ones: check_sample.)
  void check_delay(const Entry& entry, const record::SensorInfo& sensor) {
    const Wide delay = wide(*entry.message.available_at) - wide(*entry.message.sampled_at);
    if (delay >= 0 && (delay < wide(sensor.delay_min) || delay > wide(sensor.delay_max))) {
      report_.add(1, entry,
                  "available " + ns(delay) + " after it was sampled, the sensor's delay is " +
                      ns(wide(sensor.delay_min)) + " to " + ns(wide(sensor.delay_max)));
    }
  }

  // Rule 1: sampled when the sensor measures.
  void check_timing(const Entry& entry, const record::SensorInfo& sensor) {
    const Wide index = entry.message.sample_index;
    const Wide instant = sensor.periodic ? wide(sensor.phase) + index * wide(sensor.period)
                                         : wide(entry.message.request_at);
    if (wide(*entry.message.sampled_at) != instant) {
      report_.add(1, entry,
                  "measurement " + std::to_string(entry.message.sample_index) + " sampled at " +
                      ns(wide(*entry.message.sampled_at)) + ", the sensor measures at " +
                      ns(instant));
    }
  }

  // Rule 2: a command acts from the first boundary that is not before its time.
  void check_command(const Entry& entry, const Sut& sut) {
    check_immediate(entry);
    if (!entry.message.effect_at) {
      return report_.add(0, entry, "a command without the time of its effect");
    }
    const Wide acts = wide(entry.message.request_at) + wide(sut.info->command_latency);
    if (wide(*entry.message.effect_at) != grid_.at_or_after(acts)) {
      report_.add(2, entry,
                  "command due at " + ns(acts) + " set to act at ST " +
                      ns(wide(*entry.message.effect_at)) + ", not at " +
                      ns(grid_.at_or_after(acts)));
    }
  }

  // Rule 5: what needs no simulated time is charged none.
  void check_immediate(const Entry& entry) {
    if (entry.message.reply_at > entry.message.request_at) {
      report_.add(5, entry,
                  "a " + entry.message.kind + " cost the SUT " +
                      ns(wide(entry.message.reply_at) - wide(entry.message.request_at)));
    }
  }

  // Rule 7: waiting counts in full, and no more.
  void check_sleep(const Entry& entry) {
    if (!entry.message.sleep_until) {
      return report_.add(0, entry, "a sleep without its end");
    }
    const Wide wake = std::max(wide(entry.message.request_at), wide(*entry.message.sleep_until));
    if (wide(entry.message.reply_at) != wake) {
      report_.add(7, entry,
                  "woken at " + ns(wide(entry.message.reply_at)) + " instead of " + ns(wake));
    }
  }

  // What the grid moved, worked out anew: always less than a step.
  void check_grid_error(const Entry& entry, const Sut& sut) {
    const Interaction& message = entry.message;
    Wide error = wide(message.reply_at) - wide(message.st_at_release);
    if (message.sampled_at && message.sample_state_at) {
      error = std::max(error, wide(*message.sampled_at) - wide(*message.sample_state_at));
    }
    if (message.effect_at) {
      const Wide acts = wide(message.request_at) + wide(sut.info->command_latency);
      error = std::max(error, wide(*message.effect_at) - acts);
    }
    if (error != wide(message.grid_error)) {
      report_.add(
          0, entry,
          "grid error of " + ns(wide(message.grid_error)) + " recorded, it was " + ns(error));
    }
    // One of a step or more has been found by the rule that it breaks.
    if (error >= 0 && error < grid_.step()) {
      Duration& largest = report_.verdict().largest_grid_error;
      largest = std::max(largest, Duration(static_cast<std::int64_t>(error)));
    }
  }

  const record::Record& record_;
  const Boundaries& grid_;
  Report& report_;
  std::map<std::string, Sut> suts_;
};

}  // namespace

void check_interactions(const record::Record& record, const Boundaries& grid, Report& report) {
  InteractionCheck(record, grid, report).run();
}

}  // namespace tether::audit
