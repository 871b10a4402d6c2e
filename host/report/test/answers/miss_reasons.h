#pragma once

#include "sample_results.h"

#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <tether/report/verdict.h>

namespace tether::report {

/// Flights of one UAV under conditions that differ in what the tests set.
class MissReasons : public testing::Test {
 protected:
  /// @return the index of the condition.
  std::size_t add(const std::string& name, std::size_t reached, std::size_t missed, Pace pace) {
    std::vector<double> times_s(reached, 4.0);
    times_s.resize(reached + missed, 6.0);
    scenario_.conditions.push_back(sample_results({{name, times_s}}).conditions[0]);
    for (campaign::TrialResult& trial : scenario_.conditions.back().trials) {
      trial.policy = "conservative_barrier";
      trial.metrics[0].max = 5.0;
      trial.profiles = {"paper_streaming"};
      trial.versions["simulator"] = "MuJoCo";
      trial.suts = {
          {.uav = "uav1", .sut = "s", .clock = {computer::ClockKind::kCpu}, .reached_goal = true}};
      if (!trial.metrics[0].is_met()) trial.outcome = campaign::Outcome::kGoalMissed;
    }
    paces_.emplace_back(std::move(pace));
    return paces_.size() - 1;
  }
  Verdict verdict() const { return verdict_of(scenario_, paces_); }
  Ruling ruling(std::size_t condition) const { return verdict().conditions[condition].ruling; }
  std::vector<campaign::TrialResult>& trials(std::size_t condition) {
    return scenario_.conditions[condition].trials;
  }
  Speed::Program& program(std::size_t condition) { return paces_[condition]->speed.programs[0]; }

  /// A program that is measured: an image costs so much.
  static Pace measured(double image_s) {
    Pace pace{.uav = "uav1",
              .stages = {{.stage = "detect", .count = 40, .share = 1.0}},
              .camera = "camera",
              .read_hz = 30.0,
              .offered_hz = 30.0,
              .median_s = image_s,
              .p95_s = image_s};
    pace.speed.programs = {{.uav = "uav1", .clock = {computer::ClockKind::kCpu}}};
    pace.speed.machine = "here";
    return pace;
  }
  static Pace scripted(Duration computing) {
    Pace pace = measured(to_seconds(computing));
    pace.speed.programs = {
        {.uav = "uav1", .clock = {computer::ClockKind::kScripted, 1.0, computing}}};
    pace.speed.machine.clear();
    return pace;
  }
  static Pace instant() { return scripted(std::chrono::microseconds(1)); }

  campaign::ScenarioResults scenario_;
  std::vector<std::optional<Pace>> paces_;
};

}  // namespace tether::report
