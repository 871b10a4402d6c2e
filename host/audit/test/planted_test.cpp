#include "record_generator.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include <tether/audit/audit.h>

namespace tether::audit {
namespace {

using record::CommandEffect;
using record::Interaction;
using record::Logged;
using record::Record;
using Entry = Logged<Interaction>;
using Rules = std::set<int>;

constexpr Duration kStep{1'000'000};

Rules rules_of(const Verdict& verdict) {
  Rules rules;
  for (const Finding& finding : verdict.findings) {
    rules.insert(finding.rule);
  }
  return rules;
}

// ---- Planted violations
// ----------------------------------------------------------------------------

// The place of the `skip`-th interaction that `wanted` accepts.
Entry& find(Record& record, const std::function<bool(const Interaction&)>& wanted, int skip = 5) {
  for (Entry& entry : record.interactions) {
    if (wanted(entry.message) && skip-- == 0) {
      return entry;
    }
  }
  throw std::logic_error("the generated record has no such interaction");
}

bool is_command(const Interaction& m) {
  return m.kind == record::kCommand;
}
bool is_sleep(const Interaction& m) {
  return m.kind == record::kSleep;
}
bool is_range(const Interaction& m) {
  return m.sensor == "range";
}
bool is_new_image(const Interaction& m) {
  return m.sensor == "camera" && !m.latest;
}
bool waits(const Interaction& m) {
  return m.reply_at - m.request_at > 3 * kStep;
}
bool is_ahead(const Interaction& m) {
  return m.lag > 3 * kStep;
}
bool is_off_grid_reading(const Interaction& m) {
  return m.kind == record::kSensor && m.sample_state_at < m.sampled_at &&
         m.grid_error > Duration(0);
}

Logged<CommandEffect>& effect_of(Record& record, const Interaction& command) {
  return *std::ranges::find_if(record.commands, [&](const Logged<CommandEffect>& effect) {
    return effect.message.uav == command.uav && effect.message.sequence == command.sequence;
  });
}

record::SensorInfo& info_of(Record& record, const Interaction& reading) {
  return *std::ranges::find_if(record.header.sensors, [&](const record::SensorInfo& sensor) {
    return sensor.uav == reading.uav && sensor.name == reading.sensor;
  });
}

// A command that takes effect a step or more before some later reply leaves.
Entry& early_command(Record& record) {
  return find(record, [&](const Interaction& m) {
    return is_command(m) && *m.effect_at + 20 * kStep < record.footer->st_at_end;
  });
}

void keep_lag(Interaction& message) {
  message.lag = lag(message.request_at, message.st_at_arrival);
}

struct Planted {
  const char* what;
  Rules rules;  ///< exactly these
  std::function<void(Record&)> plant;
};

void PrintTo(const Planted& planted, std::ostream* out) {
  *out << planted.what;
}

const Planted kPlanted[] = {
    // Rule 1.
    {"sample_from_the_future",
     {1},
     [](Record& r) {
       Interaction& m = find(r, is_range).message;
       const Duration later = m.reply_at - m.request_at + kStep;
       *m.sampled_at += later;
       *m.available_at += later;
       m.sample_state_at = *m.sampled_at - m.sampled_at->time_since_epoch() % kStep;
       m.grid_error = std::max(Duration(m.reply_at.time_since_epoch() % kStep),
                               *m.sampled_at - *m.sample_state_at);
       r.footer->largest_grid_error = std::max(r.footer->largest_grid_error, m.grid_error);
     }},
    {"state_of_the_next_step",
     {0, 1},
     [](Record& r) { *find(r, is_off_grid_reading).message.sample_state_at += kStep; }},
    {"state_of_an_earlier_step",
     {0, 1},
     [](Record& r) { *find(r, is_off_grid_reading).message.sample_state_at -= kStep; }},
    {"replied_before_the_data_was_there",
     {1},
     [](Record& r) { *find(r, is_range).message.available_at += Duration(1); }},
    {"replied_later_than_the_data_was_there",
     {1},
     [](Record& r) {
       *find(r, [](const Interaction& m) {
          return is_range(m) && waits(m);
        }).message.available_at -= Duration(1);
     }},
    {"periodic_sensor_at_a_wrong_instant",
     {1},
     [](Record& r) {
       Interaction& m =
           find(r, [](const Interaction& i) {
             return is_new_image(i) && i.sampled_at->time_since_epoch() % kStep > Duration(10);
           }).message;
       *m.sampled_at -= Duration(1);
       m.grid_error = std::max(Duration(m.reply_at.time_since_epoch() % kStep),
                               *m.sampled_at - *m.sample_state_at);
     }},
    {"wrong_index", {0, 1}, [](Record& r) { find(r, is_new_image, 30).message.sample_index -= 1; }},
    {"on_demand_sensor_before_the_request",
     {1},
     [](Record& r) {
       Interaction& m =
           find(r, [](const Interaction& i) {
             return is_range(i) && i.request_at.time_since_epoch() % kStep > Duration(10);
           }).message;
       *m.sampled_at -= Duration(1);
       m.grid_error = std::max(Duration(m.reply_at.time_since_epoch() % kStep),
                               *m.sampled_at - *m.sample_state_at);
     }},
    {"measurement_read_twice",
     {0, 1},
     [](Record& r) { find(r, is_range, 30).message.sample_index -= 1; }},
    {"available_before_sampled",
     {1},
     [](Record& r) {
       Interaction& m = find(
                            r, [](const Interaction& i) { return is_range(i) && !waits(i); }, 0)
                            .message;
       m.available_at = *m.sampled_at - Duration(1);
     }},
    {"delay_shorter_than_the_sensors",
     {1},
     [](Record& r) {
       const Interaction& m = find(r, is_range).message;
       info_of(r, m).delay_min = Duration(1) + (*m.available_at - *m.sampled_at);
     }},
    {"delay_longer_than_the_sensors",
     {1},
     [](Record& r) {
       const Interaction& m = find(r, is_new_image).message;
       info_of(r, m).delay_max = *m.available_at - *m.sampled_at - Duration(1);
     }},
    {"reading_without_its_times",
     {0},
     [](Record& r) { find(r, is_range).message.available_at.reset(); }},
    // Rule 2.
    {"command_in_the_past",
     {2, 3},
     [](Record& r) {
       Interaction& m = find(r, is_command).message;
       *m.effect_at -= kStep;
       Logged<CommandEffect>& effect = effect_of(r, m);
       effect.message.applied_at -= kStep;
       effect.at -= kStep;
     }},
    {"command_a_step_late",
     {0, 2},
     [](Record& r) { *find(r, is_command).message.effect_at += kStep; }},
    {"effect_a_nanosecond_late",
     {0, 2},
     [](Record& r) {
       effect_of(r, find(r, is_command).message).message.applied_at += Duration(1);
     }},
    {"effect_missing",
     {2, 3},
     [](Record& r) {
       const Interaction& m = early_command(r).message;
       r.commands.erase(r.commands.begin() + (&effect_of(r, m) - r.commands.data()));
     }},
    {"effect_without_a_command",
     {2},
     [](Record& r) {
       const Interaction& m = find(r, is_sleep).message;
       Logged<CommandEffect> effect = r.commands.back();
       effect.message.uav = m.uav;
       effect.message.sequence = m.sequence;
       r.commands.push_back(effect);
     }},
    {"effects_in_the_wrong_order",
     {2},
     [](Record& r) {
       for (std::size_t i = 0; i + 1 < r.commands.size(); ++i) {
         if (r.commands[i].message.uav == r.commands[i + 1].message.uav &&
             r.commands[i].at == r.commands[i + 1].at) {
           return std::swap(r.commands[i].message, r.commands[i + 1].message);
         }
       }
       throw std::logic_error("no two effects at one boundary");
     }},
    {"effect_twice",
     {2},
     [](Record& r) { r.commands.insert(r.commands.begin() + 5, r.commands[5]); }},
    {"command_without_its_effects_time",
     {0},
     [](Record& r) {
       Interaction& m = find(r, is_command).message;
       m.effect_at.reset();
       m.grid_error = Duration(m.reply_at.time_since_epoch() % kStep);
     }},
    // Rule 3.
    {"reply_before_its_time",
     {0, 3},
     [](Record& r) {
       find(r, [](const Interaction& m) { return waits(m); }).message.st_at_release -= kStep;
     }},
    {"reply_when_st_was_past_it",
     {0, 3},
     [](Record& r) { find(r, is_sleep).message.st_at_release += kStep; }},
    {"reply_before_an_earlier_command_was_applied",
     {3},
     [](Record& r) {
       // The first release after an effect at the same ST, with the effect put behind it.
       for (Logged<CommandEffect>& effect : r.commands) {
         for (Entry& entry : r.interactions) {
           if (entry.at == effect.at && entry.order == effect.order + 1 &&
               !(entry.message.uav == effect.message.uav &&
                 entry.message.sequence == effect.message.sequence)) {
             std::swap(entry.order, effect.order);
             return;
           }
         }
       }
       throw std::logic_error("no effect just before a release");
     }},
    // Rule 4.
    {"st_ahead_of_a_request",
     {4},
     [](Record& r) {
       Interaction& m = find(r, [](const Interaction& i) { return waits(i); }).message;
       m.st_at_arrival = m.st_at_release;
       keep_lag(m);
     }},
    {"arrival_before_the_last_release",
     {4},
     [](Record& r) {
       Interaction& m = find(r, is_ahead, 20).message;
       m.st_at_arrival = SimTime(kStep);
       keep_lag(m);
       r.footer->largest_lag = std::max(r.footer->largest_lag, m.lag);
     }},
    {"a_reply_left_before_an_earlier_stamped_request_arrived",
     {4},
     [](Record& r) {
       // By wall time the request came only at the end of the run.
       find(r, is_command).message.wall_at_arrival =
           r.interactions.back().message.wall_at_release + Duration(1);
     }},
    {"st_on_arrival_belied_by_wall_time",
     {4},
     [](Record& r) {
       // Claims the ST of its last release, although another reply left in between.
       for (Entry& entry : r.interactions) {
         Interaction& m = entry.message;
         for (const Entry& other : r.interactions) {
           if (other.message.uav != m.uav && other.message.wall_at_release < m.wall_at_arrival &&
               other.message.st_at_release == m.st_at_arrival && is_ahead(m) == false &&
               std::ranges::none_of(r.interactions, [&](const Entry& own) {
                 return own.message.uav == m.uav && own.message.sequence + 1 == m.sequence &&
                        own.message.st_at_release >= m.st_at_arrival - kStep;
               })) {
             m.st_at_arrival -= kStep;
             keep_lag(m);
             r.footer->largest_lag = std::max(r.footer->largest_lag, m.lag);
             return;
           }
         }
       }
       throw std::logic_error("no such pair");
     }},
    {"command_of_the_past_in_file_order",
     {4},
     [](Record& r) {
       // A command's line put behind the ground truth of a later ST.
       for (Entry& entry : r.interactions) {
         for (auto& truth : r.ground_truth) {
           if (is_command(entry.message) && truth.order == entry.order + 1) {
             return std::swap(entry.order, truth.order);
           }
         }
       }
       throw std::logic_error("no command just before ground truth");
     }},
    {"st_ahead_of_a_running_sut_at_the_end",
     {4},
     [](Record& r) {
       r.footer->et_at_end.back() = same_instant(r.footer->st_at_end) - Duration(1);
       for (Entry& entry : r.interactions) {
         if (entry.message.uav == r.header.suts.back().uav &&
             entry.message.kind == record::kFinish) {
           entry.message.kind = record::kSleep;
           entry.message.sleep_until = entry.message.reply_at;
         }
       }
     }},
    // Rule 5.
    {"requested_before_its_last_reply",
     {5},
     [](Record& r) {
       // ET jumps back within a step: nothing else can notice.
       for (std::size_t i = 0; i < r.interactions.size(); ++i) {
         for (std::size_t j = 0; j < i; ++j) {
           Interaction& before = r.interactions[j].message;
           Interaction& m = r.interactions[i].message;
           if (before.uav == m.uav && before.sequence + 1 == m.sequence && is_sleep(before) &&
               before.reply_at > before.request_at && is_sleep(m) &&
               m.reply_at > m.request_at + kStep &&
               before.reply_at.time_since_epoch() % kStep > Duration(1) &&
               before.st_at_release == m.st_at_arrival) {
             m.request_at = before.reply_at - Duration(1);
             keep_lag(m);
             return;
           }
         }
       }
       throw std::logic_error("no two sleeps one after another");
     }},
    {"sequence_with_a_gap",
     {0, 5},
     [](Record& r) { r.interactions.erase(r.interactions.begin() + 5); }},
    {"sequence_repeated", {5}, [](Record& r) { find(r, is_sleep, 10).message.sequence -= 1; }},
    {"lag_misreported", {5}, [](Record& r) { find(r, is_sleep).message.lag -= Duration(1); }},
    {"command_charged_for_waiting",
     {5},
     [](Record& r) {
       Interaction& m =
           find(r, [](const Interaction& i) {
             return is_command(i) && i.reply_at.time_since_epoch() % kStep < kStep - Duration(10);
           }).message;
       m.reply_at += Duration(1);
       m.grid_error = std::max(m.grid_error, Duration(m.reply_at.time_since_epoch() % kStep));
     }},
    {"replied_before_the_request",
     {0, 1, 3, 5},
     [](Record& r) {
       Interaction& m =
           find(r, [](const Interaction& i) {
             return is_range(i) && i.request_at.time_since_epoch() % kStep > Duration(10);
           }).message;
       m.reply_at = m.request_at - Duration(1);
     }},
    {"recorded_violation",
     {5},
     [](Record& r) {
       find(r, is_sleep).message.violation = "request in the past by 5 ns";
       r.footer->causality_violations = 1;
     }},
    {"request_after_the_finish",
     {5},
     [](Record& r) {
       Entry& entry = find(r, is_sleep);
       entry.message.kind = record::kFinish;
     }},
    {"et_at_the_end_before_the_last_reply",
     {5},
     [](Record& r) { r.footer->et_at_end[1] -= Duration(1); }},
    // Rule 6.
    {"not_stamped_although_its_clock_stamps",
     {6},
     [](Record& r) { find(r, is_sleep).message.stamped = false; }},
    {"stamped_although_its_clock_does_not",
     {6},
     [](Record& r) { r.header.suts[0].clock = "unstamped"; }},
    // Rule 7.
    {"slept_too_short",
     {0, 7},
     [](Record& r) {
       find(r, [](const Interaction& m) { return is_sleep(m) && waits(m); }).message.reply_at -=
           Duration(1);
     }},
    {"slept_too_long",
     {7},
     [](Record& r) {
       *find(r, [](const Interaction& m) { return is_sleep(m) && waits(m); }).message.sleep_until -=
           Duration(1);
     }},
    {"sleep_without_its_end",
     {0},
     [](Record& r) { find(r, is_sleep).message.sleep_until.reset(); }},
    // The record itself.
    {"unknown_uav", {0, 5}, [](Record& r) { find(r, is_sleep).message.uav = "nobody"; }},
    {"unknown_sensor", {0}, [](Record& r) { find(r, is_range).message.sensor = "sonar"; }},
    {"unknown_kind",
     {0},
     [](Record& r) {
       find(
           r, [](const Interaction& m) { return is_sleep(m) && m.reply_at == m.request_at; }, 0)
           .message.kind = "telepathy";
     }},
    {"log_time_is_not_the_release", {0}, [](Record& r) { find(r, is_sleep).at -= Duration(1); }},
    {"grid_error_misreported",
     {0},
     [](Record& r) { find(r, is_range).message.grid_error -= Duration(1); }},
    {"ground_truth_missing",
     {0},
     [](Record& r) { r.ground_truth.erase(r.ground_truth.begin() + 7); }},
    {"ground_truth_stops_early", {0}, [](Record& r) { r.ground_truth.pop_back(); }},
    {"ground_truth_off_the_grid",
     {0},
     [](Record& r) {
       r.ground_truth[9].message.at -= Duration(1);
       r.ground_truth[9].at -= Duration(1);
     }},
    {"ground_truth_logged_early", {0}, [](Record& r) { r.ground_truth[9].at -= Duration(1); }},
    {"ground_truth_not_finite",
     {0},
     [](Record& r) {
       r.ground_truth[9].message.p_WB_m[1] = std::numeric_limits<double>::quiet_NaN();
     }},
    {"ground_truth_no_rotation", {0}, [](Record& r) { r.ground_truth[9].message.q_WB[0] = 1.001; }},
    {"command_not_finite",
     {0},
     [](Record& r) {
       r.commands[3].message.yaw_rate_rad_s = std::numeric_limits<double>::infinity();
     }},
    {"annotation_out_of_order",
     {0},
     [](Record& r) {
       r.annotations.push_back({from_ns<SimTime>(5), r.interactions.back().order + 1, {}});
     }},
    {"interactions_miscounted", {0}, [](Record& r) { ++r.footer->interactions; }},
    {"violations_miscounted", {0}, [](Record& r) { ++r.footer->causality_violations; }},
    {"largest_lag_wrong", {0}, [](Record& r) { r.footer->largest_lag += Duration(1); }},
    {"largest_grid_error_wrong",
     {0},
     [](Record& r) { r.footer->largest_grid_error += Duration(1); }},
    {"end_before_the_last_message", {0}, [](Record& r) { r.footer->st_at_end -= kStep; }},
    {"too_few_ets_at_the_end", {0}, [](Record& r) { r.footer->et_at_end.pop_back(); }},
    {"two_suts_on_one_uav", {0, 2, 5}, [](Record& r) { r.header.suts[1].uav = "uav0"; }},
    {"unknown_policy", {0}, [](Record& r) { r.header.policy = "best_effort"; }},
    {"no_step", {0}, [](Record& r) { r.header.step = Duration(0); }},
    {"damaged_although_it_has_its_end", {0}, [](Record& r) { r.damage = "damaged at byte 5"; }},
};

class PlantedViolation : public ::testing::TestWithParam<Planted> {};

TEST_P(PlantedViolation, IsFoundAsABreachOfItsRule) {
  Record record = generate({.seed = 7});
  ASSERT_TRUE(audit(record).passed());
  GetParam().plant(record);
  const Verdict verdict = audit(record);
  EXPECT_FALSE(verdict.passed());
  EXPECT_EQ(rules_of(verdict), GetParam().rules) << to_text(verdict);
}

INSTANTIATE_TEST_SUITE_P(Planted, PlantedViolation, ::testing::ValuesIn(kPlanted),
                         [](const auto& planted) { return std::string(planted.param.what); });

TEST(PlantedViolations, CoverEveryRule) {
  Rules covered;
  for (const Planted& planted : kPlanted) {
    covered.insert(planted.rules.begin(), planted.rules.end());
  }
  EXPECT_EQ(covered, (Rules{0, 1, 2, 3, 4, 5, 6, 7}));
}

}  // namespace
}  // namespace tether::audit
