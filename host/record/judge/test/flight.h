#pragma once

#include <algorithm>
#include <chrono>
#include <optional>
#include <string>

#include <tether/judge/judge.h>
#include <tether/toml/table.h>

namespace tether::judge {

inline SimTime st(double s) {
  return SimTime(duration_from_seconds(s));
}

/// A record made by hand, of "uav1" with a camera "eye": ground truth every 100 ms for 10 s, in
/// which the altitude rises by 1 m/s from 0, the speed is 1 m/s, and the anchor "box" is 3 m ahead.
class Flight {
 public:
  Flight() {
    record_.header.policy = record::kConservativeBarrier;
    record_.header.anchors = {{"box", "box", {1, 1, 1}, {3, 0, 0}, {1, 0, 0, 0}}};
    record_.header.sensors = {{.uav = "uav1", .name = "eye", .kind = "camera"}};
    record_.header.suts.emplace_back().uav = "uav1";
    for (int i = 0; i <= 100; ++i) {
      record::GroundTruth truth;
      truth.uav = "uav1";
      truth.at = st(0.1 * i);
      truth.p_WB_m[2] = 0.1 * i;
      truth.v_WB_m_s[2] = 1.0;
      record_.ground_truth.push_back({truth.at, order_++, truth});
    }
    record_.footer.emplace().st_at_end = st(10.0);
  }

  Flight& task(const std::string& name, double from_s, double to_s,
               const std::string& status = "reached") {
    note(from_s, R"({"task":")" + name + R"(","event":"start"})");
    return note(to_s, R"({"task":")" + name + R"(","event":"end","reason":"so","status":")" +
                          status + "\"}");
  }
  Flight& note(double at_s, const std::string& json) {
    record_.annotations.push_back(
        {st(at_s), order_++, {"uav1", same_instant(st(at_s)), "mission", json}});
    return *this;
  }
  Flight& finish(double at_s) {
    add(record::kFinish, at_s, at_s);
    return *this;
  }
  Flight& image(double asked_s, double had_s, double sampled_s) {
    record::Interaction& read = add(record::kSensor, asked_s, had_s);
    read.sensor = "eye";
    read.sampled_at = st(sampled_s);
    return *this;
  }
  /// By MAVLink.
  Flight& setpoint(double sent_s, std::optional<double> effect_s = {}) {
    record::AutopilotMessage& sent = record_.autopilot.emplace_back().message;
    sent.uav = "uav1";
    sent.to_controller = true;
    sent.name = "SET_ATTITUDE_TARGET";
    sent.sent_at = st(sent_s);
    if (effect_s) sent.acted_at = st(*effect_s);
    return *this;
  }
  Flight& command(double sent_s, double effect_s) {
    add(record::kCommand, sent_s, sent_s).effect_at = st(effect_s);
    return *this;
  }
  /// At each ground truth: 100 W from the start on, and 5 % of the charge each second.
  Flight& battery() {
    for (const auto& truth : record_.ground_truth) {
      const double t_s = to_seconds(truth.at);
      record_.batteries.push_back({truth.at,
                                   order_++,
                                   {.uav = "uav1",
                                    .at = truth.at,
                                    .charge = 1.0 - 0.05 * t_s,
                                    .lift_J = 90.0 * t_s,
                                    .idle_J = 10.0 * t_s}});
    }
    return *this;
  }
  /// To or from "uav2".
  Flight& message(const std::string& from, double at_s, std::string_view outcome) {
    record::RadioMessage message;
    message.uav = from;
    message.to = from == "uav1" ? "uav2" : "uav1";
    message.sent_at = message.at = st(at_s);
    message.outcome = outcome;
    record_.radio.push_back({st(at_s), order_++, message});
    return *this;
  }
  /// Ended by the time limit.
  Flight& cut(double end_s) {
    record_.footer->st_at_end = st(end_s);
    std::erase_if(record_.ground_truth, [&](const auto& logged) { return logged.at > st(end_s); });
    return *this;
  }

  record::Record& record() { return record_; }

  /// Verdicts on the clauses of a mission of the tasks "a", "b" and "c".
  Verdicts verdicts(const std::string& clauses) const {
    const std::string tasks =
        "anchor = \"box\"\n[[task]]\ntask = \"a\"\n[[task]]\ntask = \"b\"\n[[task]]\ntask = "
        "\"c\"\n";
    return judge(mission::read_mission(toml::Document::parse(tasks + clauses, "m.toml").root()),
                 "uav1", record_);
  }
  ClauseVerdict verdict(const std::string& clause) const {
    return verdicts("[[clause]]\n" + clause).clauses.at(0);
  }

 private:
  record::Interaction& add(std::string_view kind, double sent_s, double answered_s) {
    record::Interaction interaction;
    interaction.uav = "uav1";
    interaction.kind = kind;
    interaction.sequence = order_ + 1;
    interaction.request_at = same_instant(st(sent_s));
    interaction.reply_at = same_instant(st(answered_s));
    interaction.st_at_arrival = st(sent_s);
    interaction.st_at_release = st(answered_s);
    record_.interactions.push_back({st(answered_s), order_++, interaction});
    return record_.interactions.back().message;
  }

  record::Record record_;
  std::uint64_t order_ = 0;
};

}  // namespace tether::judge
