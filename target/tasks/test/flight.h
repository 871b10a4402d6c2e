#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <tether/tasks/task.h>
#include <tether/tasks/testing/planar_vehicle.h>

namespace tether::tasks {

/// A task flown to its end, and the vehicle that flew it.
struct Flight {
  TaskOutcome outcome;
  testing::PlanarVehicle vehicle;

  double result(const std::string& name) const { return outcome.results.at(name); }
  std::vector<nlohmann::json> notes(std::string_view topic) const {
    std::vector<nlohmann::json> notes;
    for (const auto& annotation : vehicle.annotations()) {
      if (annotation.topic == topic) notes.push_back(nlohmann::json::parse(annotation.json));
    }
    return notes;
  }
};

/// The fake's images are a quarter as wide as those that the default is for.
inline constexpr double kTolerance_px = 2.0;

/// Whatever the outcome, a task that could run leaves the UAV stopped.
inline Flight fly(Task& task, const testing::PlanarVehicle::Options& world) {
  Flight flight{{}, testing::PlanarVehicle(world)};
  TaskContext context(flight.vehicle);
  flight.outcome = run(task, context);
  if (flight.outcome.status != TaskStatus::kFailed) {
    EXPECT_EQ(flight.vehicle.commands().back(), uav::VelocityCommand{}) << "not stopped";
  }
  return flight;
}

}  // namespace tether::tasks
