#include "altered_record.h"
#include "record_generator.h"

#include <cmath>
#include <functional>
#include <string>

#include <gtest/gtest.h>

namespace tether::audit {
namespace {

using record::CommandEffect;
using record::Interaction;
using record::Logged;
using record::Record;

template <class Time>
Duration beyond_grid(Time time) {
  return time.time_since_epoch() % kStep;
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
bool is_long_sleep(const Interaction& m) {
  return is_sleep(m) && waits(m);
}
bool is_ahead(const Interaction& m) {
  return m.lag > 3 * kStep;
}
bool is_off_grid_range(const Interaction& m) {
  return is_range(m) && beyond_grid(m.request_at) > Duration(10);
}
bool is_off_grid(const Interaction& m) {
  return m.sampled_at && m.sample_state_at < m.sampled_at;
}

std::size_t effect_of(const Record& record, const Interaction& command) {
  const auto found =
      std::ranges::find_if(record.commands, [&](const Logged<CommandEffect>& effect) {
        return effect.message.uav == command.uav && effect.message.sequence == command.sequence;
      });
  return static_cast<std::size_t>(found - record.commands.begin());
}

// With the last interaction, of `offset` from the boundary before it.
void add_contact(Record& record, Duration offset, double speed_m_s) {
  const auto& last = record.interactions.back();
  const auto boundary = from_ns<SimTime>(floor_ns(to_ns(last.at), kStep.count()));
  record.header.reports_contacts = true;
  record.contacts.push_back(
      {last.at, last.order + 1, {last.message.uav, boundary + offset, "wall", speed_m_s}});
}

record::SensorInfo& info_of(Record& record, const Interaction& reading) {
  return *std::ranges::find_if(record.header.sensors, [&](const record::SensorInfo& sensor) {
    return sensor.uav == reading.uav && sensor.name == reading.sensor;
  });
}

// After a change of the sample's time.
void set_grid_error(Record& record, Interaction& m) {
  m.grid_error = std::max(beyond_grid(m.reply_at), *m.sampled_at - *m.sample_state_at);
  set_figures(record);
}

// After a change of the ST on arrival.
void set_arrival(Record& record, Interaction& m, SimTime at) {
  m.st_at_arrival = at;
  set_lag(m);
  set_figures(record);
}

// The first SUT is scripted.
void require_clock(Record& record, const computer::Clock& clock) {
  record.header.suts[0].required_clock = clock;
}

// The first pair of different interactions, the second of them later in the file.
Interaction& second_of_pair(Record& record,
                            const std::function<bool(Interaction&, Interaction&)>& wanted) {
  for (std::size_t i = 0; i < record.interactions.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      Interaction& m = record.interactions[i].message;
      if (wanted(record.interactions[j].message, m)) return m;
    }
  }
  throw std::logic_error("the generated record has no such pair");
}

// Puts the replies of two SUTs at one ST into the other order: as it was sent, wall times included,
// up to `alter`.
void swap_replies(Record& record, const std::function<void(Interaction&, Interaction&)>& alter) {
  for (std::size_t i = 1; i < record.interactions.size(); ++i) {
    Interaction& one = record.interactions[i - 1].message;
    Interaction& other = record.interactions[i].message;
    if (one.uav == other.uav || one.st_at_release != other.st_at_release ||
        other.wall_at_arrival > one.wall_at_release || one.effect_at || other.effect_at)
      continue;
    std::swap(one, other);
    std::swap(one.wall_at_release, other.wall_at_release);
    return alter(one, other);
  }
  throw std::logic_error("no two replies at one ST");
}

const Planted kPlanted[] = {
    // Rule 1.
    {"sample_from_the_future",
     {1},
     [](Record& r) {
       Interaction& m = where(r, is_range);
       const Duration later = m.reply_at - m.request_at + kStep;
       *m.sampled_at += later;
       *m.available_at += later;
       m.sample_state_at = *m.sampled_at - beyond_grid(*m.sampled_at);
       set_grid_error(r, m);
     }},
    {"state_of_next_step",
     {0, 1},
     [](auto& r) { *where(r, is_off_grid).sample_state_at += kStep; }},
    {"state_of_earlier_step",
     {0, 1},
     [](auto& r) { *where(r, is_off_grid).sample_state_at -= kStep; }},
    {"reply_before_data", {1}, [](Record& r) { *where(r, is_range).available_at += kNs; }},
    {"reply_after_data",
     {1},
     [](Record& r) {
       *where(r, [](const auto& m) { return is_range(m) && waits(m); }).available_at -= kNs;
     }},
    {"periodic_sensor_at_wrong_instant",
     {1},
     [](Record& r) {
       Interaction& m = where(r, [](const Interaction& i) {
         return is_new_image(i) && beyond_grid(*i.sampled_at) > Duration(10);
       });
       *m.sampled_at -= kNs;
       set_grid_error(r, m);
     }},
    {"wrong_index", {0, 1}, [](Record& r) { where(r, is_new_image, 30).sample_index -= 1; }},
    {"on_demand_sensor_before_request",
     {1},
     [](Record& r) {
       Interaction& m = where(r, is_off_grid_range);
       *m.sampled_at -= kNs;
       set_grid_error(r, m);
     }},
    {"measurement_twice", {0, 1}, [](Record& r) { where(r, is_range, 30).sample_index -= 1; }},
    {"available_before_sampled",
     {1},
     [](Record& r) {
       const auto is_immediate = [](const auto& m) { return is_range(m) && !waits(m); };
       Interaction& m = where(r, is_immediate, 0);
       m.available_at = *m.sampled_at - kNs;
     }},
    {"delay_below_bound",
     {1},
     [](Record& r) {
       const Interaction& m = where(r, is_range);
       info_of(r, m).delay_min = *m.available_at - *m.sampled_at + kNs;
     }},
    {"delay_above_bound",
     {1},
     [](Record& r) {
       const Interaction& m = where(r, is_new_image);
       info_of(r, m).delay_max = *m.available_at - *m.sampled_at - kNs;
     }},
    {"reading_without_times", {0}, [](Record& r) { where(r, is_range).available_at.reset(); }},
    // Rule 2.
    {"command_in_the_past",
     {2, 3},
     [](Record& r) {
       Interaction& m = where(r, is_command);
       *m.effect_at -= kStep;
       Logged<CommandEffect>& effect = r.commands[effect_of(r, m)];
       effect.at = effect.message.applied_at -= kStep;
     }},
    {"command_late", {0, 2}, [](Record& r) { *where(r, is_command).effect_at += kStep; }},
    {"effect_late",
     {0, 2},
     [](Record& r) { r.commands[effect_of(r, where(r, is_command))].message.applied_at += kNs; }},
    {"effect_missing",
     {2, 3},
     [](Record& r) {
       // Of a command after whose effect another reply is sent.
       const std::size_t effect =
           effect_of(r, where(r, [&](const Interaction& m) {
                       return is_command(m) && *m.effect_at + 20 * kStep < r.footer->st_at_end;
                     }));
       r.commands.erase(r.commands.begin() + static_cast<std::ptrdiff_t>(effect));
     }},
    {"effect_without_command",
     {2},
     [](Record& r) {
       const Interaction& m = where(r, is_sleep);
       Logged<CommandEffect> effect = r.commands.back();
       effect.message.uav = m.uav;
       effect.message.sequence = m.sequence;
       r.commands.push_back(effect);
     }},
    {"effects_in_wrong_order",
     {2},
     [](Record& r) {
       const auto first =
           std::ranges::adjacent_find(r.commands, [](const auto& one, const auto& next) {
             return one.message.uav == next.message.uav && one.at == next.at;
           });
       std::swap(first->message, std::next(first)->message);
     }},
    {"effect_twice", {2}, [](auto& r) { r.commands.insert(r.commands.begin(), r.commands[0]); }},
    {"command_without_effect_time",
     {0},
     [](Record& r) {
       Interaction& m = where(r, is_command);
       m.effect_at.reset();
       m.grid_error = beyond_grid(m.reply_at);
     }},
    // Rule 3.
    {"reply_too_early", {0, 3}, [](Record& r) { where(r, waits).st_at_release -= kStep; }},
    {"reply_too_late", {0, 3}, [](Record& r) { where(r, is_sleep).st_at_release += kStep; }},
    {"reply_before_earlier_command_was_applied",
     {3},
     [](Record& r) {
       // The first release after an effect at the same ST: the effect is moved after it.
       for (Logged<CommandEffect>& effect : r.commands) {
         for (Entry& entry : r.interactions) {
           if (entry.at == effect.at && entry.order == effect.order + 1 &&
               !(entry.message.uav == effect.message.uav &&
                 entry.message.sequence == effect.message.sequence))
             return std::swap(entry.order, effect.order);
         }
       }
       throw std::logic_error("no effect just before a release");
     }},
    {"replies_in_wrong_order",
     {3},
     [](Record& r) { swap_replies(r, [](Interaction&, Interaction&) {}); }},
    {"replies_in_wrong_order_of_wall_time",
     {0, 3},
     [](Record& r) {
       swap_replies(r, [](Interaction& one, Interaction& other) {
         std::swap(one.wall_at_release, other.wall_at_release);
       });
     }},
    {"replies_in_wrong_order_without_wall_times",
     {3},
     [](Record& r) {
       swap_replies(r, [](Interaction&, Interaction&) {});
       for (Entry& entry : r.interactions)
         entry.message.wall_at_arrival = entry.message.wall_at_release = WallTime{};
     }},
    // Rule 4.
    {"st_ahead_of_request",
     {4},
     [](Record& r) {
       Interaction& m = where(r, waits);
       set_arrival(r, m, m.st_at_release);
     }},
    {"arrival_before_last_release",
     {4},
     [](Record& r) { set_arrival(r, where(r, is_ahead, 20), SimTime(kStep)); }},
    {"reply_sent_before_earlier_request_arrived",
     {0, 4},
     [](Record& r) {
       // By wall time the request came only at the end of the run.
       where(r, is_command).wall_at_arrival = r.interactions.back().message.wall_at_release + kNs;
     }},
    {"arrival_contradicts_wall_time",
     {4},
     [](Record& r) {
       // An ST before that of a reply that was already sent, although after the SUT's last reply.
       Interaction& m = second_of_pair(r, [&](const Interaction& other, const Interaction& i) {
         return other.uav != i.uav && other.wall_at_release < i.wall_at_arrival &&
                other.st_at_release == i.st_at_arrival && !is_ahead(i) &&
                std::ranges::none_of(r.interactions, [&](const Entry& own) {
                  return own.message.uav == i.uav && own.message.sequence + 1 == i.sequence &&
                         own.message.st_at_release >= i.st_at_arrival - kStep;
                });
       });
       set_arrival(r, m, m.st_at_arrival - kStep);
     }},
    {"command_of_the_past_in_file_order",
     {4},
     [](Record& r) {
       // A command is moved after the ground truth of a later ST.
       for (Entry& entry : r.interactions) {
         for (auto& truth : r.ground_truth) {
           if (is_command(entry.message) && truth.order == entry.order + 1)
             return std::swap(entry.order, truth.order);
         }
       }
       throw std::logic_error("no command just before ground truth");
     }},
    {"st_ahead_of_running_sut_at_end",
     {4},
     [](Record& r) {
       r.footer->end = "time_limit";
       r.footer->et_at_end.back() = same_instant(r.footer->st_at_end) - kNs;
       for (Entry& entry : r.interactions) {
         Interaction& m = entry.message;
         if (m.uav != r.header.suts.back().uav || m.kind != record::kFinish) continue;
         m.kind = record::kSleep;
         m.sleep_until = m.reply_at;
       }
     }},
    // Rule 5.
    {"request_before_last_reply",
     {5},
     [](Record& r) {
       // ET decreases within a step, which no other check can detect.
       const Interaction* previous = nullptr;
       Interaction& m = second_of_pair(r, [&](const Interaction& before, const Interaction& i) {
         previous = &before;
         return before.uav == i.uav && before.sequence + 1 == i.sequence && is_sleep(before) &&
                before.reply_at > before.request_at && is_sleep(i) &&
                i.reply_at > i.request_at + kStep && beyond_grid(before.reply_at) > kNs &&
                before.st_at_release == i.st_at_arrival;
       });
       m.request_at = previous->reply_at - kNs;
       set_lag(m);
     }},
    {"sequence_with_gap",
     {0, 5},
     [](auto& r) { r.interactions.erase(r.interactions.begin() + 5); }},
    {"sequence_repeated", {5}, [](Record& r) { where(r, is_sleep, 10).sequence -= 1; }},
    {"wrong_lag", {5}, [](Record& r) { where(r, is_sleep).lag -= kNs; }},
    {"command_that_takes_time",
     {5},
     [](Record& r) {
       Interaction& m = where(r, [](const Interaction& i) {
         return is_command(i) && beyond_grid(i.reply_at) < kStep - Duration(10);
       });
       m.reply_at += kNs;
       m.grid_error = std::max(m.grid_error, beyond_grid(m.reply_at));
     }},
    {"reply_before_request",
     {0, 1, 3, 5},
     [](Record& r) {
       Interaction& m = where(r, is_off_grid_range);
       m.reply_at = m.request_at - kNs;
     }},
    {"recorded_violation",
     {5},
     [](Record& r) {
       where(r, is_sleep).violation = "request in the past by 5 ns";
       r.footer->causality_violations = 1;
     }},
    {"stages_of_another_length",
     {5},
     [](Record& r) {
       Interaction& m = where(r, is_sleep, 10);
       m.stages = {{"detect", m.request_at.time_since_epoch() + kNs}};
     }},
    {"request_after_finish", {5}, [](Record& r) { where(r, is_sleep).kind = record::kFinish; }},
    {"et_at_end_before_last_reply", {5}, [](Record& r) { r.footer->et_at_end[1] -= kNs; }},
    // Rule 6.
    {"not_stamped", {6}, [](Record& r) { where(r, is_sleep).stamped = false; }},
    {"stamped_by_unstamped_clock",
     {6},
     [](Record& r) { r.header.suts[0].clock.kind = computer::ClockKind::kUnstamped; }},
    {"clock_of_another_kind",
     {6},
     [](Record& r) { require_clock(r, {computer::ClockKind::kCpu}); }},
    {"clock_with_another_factor",
     {6},
     [](Record& r) {
       require_clock(r, {computer::ClockKind::kScripted, 12.0});
     }},
    {"clock_with_another_step",
     {6},
     [](Record& r) {
       require_clock(r, {computer::ClockKind::kScripted, 1.0, Duration(1)});
     }},
    // Rule 7.
    {"slept_too_short", {0, 7}, [](Record& r) { where(r, is_long_sleep).reply_at -= kNs; }},
    {"slept_too_long", {7}, [](Record& r) { *where(r, is_long_sleep).sleep_until -= kNs; }},
    {"sleep_without_end", {0}, [](Record& r) { where(r, is_sleep).sleep_until.reset(); }},
    // The record itself.
    {"unknown_uav", {0, 5}, [](Record& r) { where(r, is_sleep).uav = "nobody"; }},
    {"unknown_sensor", {0}, [](Record& r) { where(r, is_range).sensor = "sonar"; }},
    {"unknown_kind",
     {0},
     [](Record& r) {
       const auto is_short = [](const auto& m) {
         return is_sleep(m) && m.reply_at == m.request_at;
       };
       where(r, is_short, 0).kind = "telepathy";
     }},
    {"wrong_log_time", {0}, [](Record& r) { entry_where(r, is_sleep).at -= kNs; }},
    {"wrong_grid_error", {0}, [](Record& r) { where(r, is_range).grid_error -= kNs; }},
    {"truth_missing", {0}, [](Record& r) { r.ground_truth.erase(r.ground_truth.begin() + 7); }},
    {"truth_stops_early", {0}, [](Record& r) { r.ground_truth.pop_back(); }},
    {"truth_off_grid",
     {0},
     [](auto& r) { r.ground_truth[9].at = r.ground_truth[9].message.at -= kNs; }},
    {"truth_logged_early", {0}, [](Record& r) { r.ground_truth[9].at -= kNs; }},
    {"truth_not_finite", {0}, [](auto& r) { r.ground_truth[9].message.p_WB_m[1] = std::nan(""); }},
    {"truth_not_a_rotation", {0}, [](Record& r) { r.ground_truth[9].message.q_WB[0] = 1.001; }},
    {"removed_message",
     {0},
     [](Record& r) {
       r.miscounts.push_back({"/interactions", SimTime(kStep), 5, 6});
     }},
    {"reply_before_arrival_by_wall_time",
     {0},
     [](Record& r) {
       Interaction& m = r.interactions.front().message;
       m.wall_at_arrival = m.wall_at_release + kNs;
     }},
    {"pose_that_jumps", {0}, [](Record& r) { r.ground_truth[40].message.p_WB_m[1] += 0.2; }},
    {"pose_that_jumps_with_its_speed",
     {0},
     [](Record& r) {
       auto& truth = r.ground_truth[40].message;
       truth.p_WB_m[0] -= 2.0;
       truth.v_WB_m_s[0] -= 200.0;
     }},
    {"command_beyond_its_limits",
     {0, 2},
     [](Record& r) { r.commands[3].message.vy_H_m_s = -100.001; }},
    {"command_not_finite",
     {0, 2},
     [](Record& r) { r.commands[3].message.yaw_rate_rad_s = HUGE_VAL; }},
    {"annotation_out_of_order",
     {0},
     [](Record& r) {
       r.annotations.push_back({from_ns<SimTime>(5), r.interactions.back().order + 1, {}});
     }},
    {"contact_off_the_grid", {0}, [](Record& r) { add_contact(r, -kNs, 1.0); }},
    {"contact_from_the_future", {0}, [](Record& r) { add_contact(r, kStep, 1.0); }},
    {"contact_of_negative_speed", {0}, [](Record& r) { add_contact(r, -kStep, -1.0); }},
    {"contact_not_reported",
     {0},
     [](Record& r) {
       add_contact(r, -kStep, 1.0);
       r.header.reports_contacts = false;
     }},
    {"wrong_count_of_interactions", {0}, [](Record& r) { ++r.footer->interactions; }},
    {"wrong_count_of_violations", {0}, [](Record& r) { ++r.footer->causality_violations; }},
    {"wrong_largest_lag", {0}, [](Record& r) { r.footer->largest_lag += kNs; }},
    {"wrong_largest_grid_error", {0}, [](Record& r) { r.footer->largest_grid_error += kNs; }},
    {"end_before_last_message", {0}, [](Record& r) { r.footer->st_at_end -= kStep; }},
    {"too_few_ets_at_end", {0}, [](Record& r) { r.footer->et_at_end.pop_back(); }},
    {"two_suts_with_one_uav", {0, 2, 5}, [](Record& r) { r.header.suts[1].uav = "uav0"; }},
    {"unknown_policy", {0}, [](Record& r) { r.header.policy = "best_effort"; }},
    {"no_step", {0}, [](Record& r) { r.header.step = Duration(0); }},
    {"damaged_but_with_end", {0}, [](Record& r) { r.damage = "damaged at byte 5"; }},
};

class PlantedViolation : public ::testing::TestWithParam<Planted> {};

TEST_P(PlantedViolation, IsFoundAsABreachOfItsRules) {
  Record record = generate({.seed = 7});
  ASSERT_TRUE(audit(record).passed());
  GetParam().plant(record);
  const Verdict verdict = audit(record);
  EXPECT_FALSE(verdict.passed());
  EXPECT_EQ(rules_of(verdict), GetParam().rules) << to_text(verdict);
}

INSTANTIATE_TEST_SUITE_P(Planted, PlantedViolation, ::testing::ValuesIn(kPlanted),
                         [](const auto& planted) { return std::string(planted.param.what); });

TEST(PlantedViolations, AContactIsNone) {
  Record record = generate({.seed = 7});
  add_contact(record, -kStep, 4.0);
  EXPECT_TRUE(audit(record).passed()) << to_text(audit(record));
}

TEST(PlantedViolations, StAheadOfAnExpelledSutIsNone) {
  Record record = generate({.seed = 7});
  std::ranges::find(kPlanted, std::string("st_ahead_of_running_sut_at_end"), &Planted::what)
      ->plant(record);
  record.footer->expelled = {record.header.suts.back().uav};
  EXPECT_TRUE(audit(record).passed()) << to_text(audit(record));
}

TEST(PlantedViolations, CoverEveryRule) {
  Rules covered;
  for (const Planted& planted : kPlanted)
    covered.insert(planted.rules.begin(), planted.rules.end());
  EXPECT_EQ(covered, (Rules{0, 1, 2, 3, 4, 5, 6, 7}));
}

}  // namespace
}  // namespace tether::audit
