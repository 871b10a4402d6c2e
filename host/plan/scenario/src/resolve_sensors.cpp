#include "layered_sensor.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include <tether/base/error.h>
#include <tether/base/text.h>
#include <tether/scenario/scenario.h>

// Each sensor of the world is wrapped in a LayeredSensor, to which the layers are applied in order:
// the UAV's profile, the scenario's own tables, the condition's profiles.
namespace tether::scenario {
namespace {

using Sensors = std::vector<LayeredSensor>;

Sensors sensors_of(sim::Uav& uav) {
  Sensors sensors;
  for (sim::Sensor& sensor : uav.sensors) sensors.emplace_back(sensor);
  return sensors;
}

std::vector<std::string_view> names_of(const std::vector<const LayeredSensor*>& sensors) {
  std::vector<std::string_view> names;
  for (const LayeredSensor* sensor : sensors) names.push_back(sensor->sensor().name);
  return names;
}

LayeredSensor* find_sensor(Sensors& sensors, std::string_view name) {
  const auto found = std::find_if(sensors.begin(), sensors.end(),
                                  [&](const LayeredSensor& s) { return s.sensor().name == name; });
  return found == sensors.end() ? nullptr : &*found;
}

// Profiles. Their authors need not know the UAV, so an entry is matched to a sensor.

/// One profile, applied to the sensors of one UAV.
class ProfileLayer {
 public:
  ProfileLayer(const Profile& profile, const sim::Uav& uav, Sensors& sensors)
      : profile_(profile), uav_(uav), sensors_(sensors) {}

  /// By name first, so that a named sensor is not matched by another entry.
  void lay(const sim::WarningSink& warn) {
    for (const auto& [name, entry] : profile_.sensors) {
      LayeredSensor* sensor = find_sensor(sensors_, name);
      if (sensor != nullptr && sensor->sensor().kind() == entry.kind) sensor_of_[name] = sensor;
    }
    for (const auto& [name, entry] : profile_.sensors) {
      if (!sensor_of_.contains(name)) match_by_kind(name, entry, warn);
    }
    for (const auto& [name, sensor] : sensor_of_) sensor->lay(profile_.sensors.at(name));
  }

 private:
  void match_by_kind(const std::string& name, const SensorProfile& entry,
                     const sim::WarningSink& warn) {
    std::vector<LayeredSensor*> candidates;
    for (LayeredSensor& sensor : sensors_) {
      if (sensor.sensor().kind() == entry.kind) candidates.push_back(&sensor);
    }
    if (candidates.size() > 1) refuse_choice(name, entry, {candidates.begin(), candidates.end()});
    LayeredSensor* only = candidates.empty() ? nullptr : candidates.front();
    const std::string* other = entry_of(only);
    if (only == nullptr || (other != nullptr && *other == only->sensor().name)) {
      return warn(no_sensor(name, entry, other));
    }
    if (other != nullptr) refuse_second(name, entry, *other, only->sensor().name);
    sensor_of_[name] = only;
  }

  /// nullptr where there is none yet.
  const std::string* entry_of(const LayeredSensor* sensor) const {
    const auto found = std::find_if(sensor_of_.begin(), sensor_of_.end(),
                                    [&](const auto& match) { return match.second == sensor; });
    return found == sensor_of_.end() ? nullptr : &found->first;
  }

  /// `other` is the entry that matches the only sensor of the kind; nullptr: there is no sensor.
  Warning no_sensor(const std::string& name, const SensorProfile& entry,
                    const std::string* other) const {
    const std::string reason = other == nullptr
                                   ? ""
                                   : fmt::format("; its only one matches [sensors.{}] (line {})",
                                                 *other, profile_.sensors.at(*other).where.line);
    return {Consequence::kNoEffect, entry.where, fmt::format("[sensors.{}]", name),
            fmt::format("of the profile '{}' applies to nothing: the UAV '{}' has no sensor of the "
                        "kind \"{}\" for it{}",
                        profile_.name, uav_.name, uav::name(*entry.kind), reason)};
  }

  [[noreturn]] void refuse_choice(const std::string& name, const SensorProfile& entry,
                                  const std::vector<const LayeredSensor*>& candidates) const {
    throw Error(
        ErrorCode::kBadFile, entry.where,
        fmt::format("the UAV '{}' has no sensor '{}' of the kind \"{}\", but {}. Name one "
                    "of them.",
                    uav_.name, name, uav::name(*entry.kind), quoted_list(names_of(candidates))))
        .about(name);
  }

  [[noreturn]] void refuse_second(const std::string& name, const SensorProfile& entry,
                                  const std::string& other, const std::string& sensor) const {
    throw Error(
        ErrorCode::kBadFile, entry.where,
        fmt::format("[sensors.{}] and [sensors.{}] (line {}) would both apply to '{}', "
                    "the only sensor of the kind \"{}\" of the UAV '{}'. Rename one of them "
                    "to [sensors.{}].",
                    name, other, profile_.sensors.at(other).where.line, sensor,
                    uav::name(*entry.kind), uav_.name, sensor))
        .about(name);
  }

  const Profile& profile_;
  const sim::Uav& uav_;
  Sensors& sensors_;
  std::map<std::string, LayeredSensor*> sensor_of_;  // by the entry's name
};

// The scenario's own settings. Its author knows the UAV, so names must match.

[[noreturn]] void refuse_name(const UavSetup& setup, const Sensors& sensors,
                              const std::string& name, const FileLocation& at) {
  std::vector<const LayeredSensor*> all;
  for (const LayeredSensor& sensor : sensors) all.push_back(&sensor);
  throw Error(ErrorCode::kBadFile, at,
              fmt::format("the UAV '{}' has no sensor '{}' ({}); {}", setup.placement.name, name,
                          setup.placement.model.string(), allowed_hint(name, names_of(all))))
      .about(name);
}

void lay_setup(const UavSetup& setup, Sensors& sensors) {
  for (const auto& [name, layer] : setup.sensors) {
    LayeredSensor* sensor = find_sensor(sensors, name);
    if (sensor == nullptr) refuse_name(setup, sensors, name, layer.where);
    const uav::SensorKind kind = sensor->sensor().kind();
    if (layer.kind && layer.kind != kind) {
      throw Error(ErrorCode::kBadFile, layer.at("kind"),
                  fmt::format("'kind' is \"{}\", but the sensor '{}' of the UAV '{}' is of the "
                              "kind \"{}\"",
                              uav::name(*layer.kind), name, setup.placement.name, uav::name(kind)))
          .about("kind");
    }
    sensor->lay(layer);
  }
}

void require_sensors_of_metrics(const Scenario& scenario, const UavSetup& setup, Sensors& sensors) {
  for (const Metric& metric : scenario.metrics) {
    if (metric.uav != setup.placement.name || metric.sensor.empty()) continue;
    if (find_sensor(sensors, metric.sensor) != nullptr) continue;
    refuse_name(setup, sensors, metric.sensor, {scenario.file.string(), metric.line});
  }
}

void require_sensors_of_clauses(const UavSetup& setup, Sensors& sensors) {
  if (!setup.sut.mission) return;
  for (const mission::Clause& clause : setup.sut.mission->clauses) {
    if (!clause.condition || clause.condition->quantity->subject != mission::Subject::kSensor)
      continue;
    const std::string& name = clause.condition->of;
    if (!name.empty() && find_sensor(sensors, name) == nullptr)
      refuse_name(setup, sensors, name, clause.where);
    const auto is_meant = [&](const LayeredSensor& sensor) {
      return sensor.sensor().kind() == uav::SensorKind::kCamera &&
             (name.empty() || sensor.sensor().name == name);
    };
    if (clause.condition->quantity->name == "reaction_time" &&
        std::ranges::none_of(sensors, is_meant))
      throw Error(
          ErrorCode::kBadFile, clause.where,
          fmt::format("the clause \"{}\" is about a reaction time, which needs a camera, "
                      "but {}. Name a camera.",
                      clause.name,
                      name.empty() ? fmt::format("the UAV '{}' has none", setup.placement.name)
                                   : fmt::format("'{}' is none", name)))
          .about(clause.name);
  }
}

/// A sensor measures at the last step that is not after its instant.
void check_rate(const LayeredSensor& sensor, const uav::SensorTiming& timing,
                const std::string& uav, const sim::World& world, Duration time_limit,
                const sim::WarningSink& warn) {
  constexpr int kSteady = 10;  // periods of so many steps and more vary little
  const auto* periodic = std::get_if<uav::PeriodicTiming>(&timing);
  if (periodic == nullptr) return;
  const std::string subject = fmt::format("sensor '{}' of UAV '{}'", sensor.sensor().name, uav);
  const auto ms = [](Duration d) { return fmt::format("{} ms", 1e3 * to_seconds(d)); };
  const std::string problem = fmt::format("measures every {}, but a step is {}{}",
                                          ms(periodic->period), ms(world.step), sim::set_at(world));
  if (periodic->period < world.step)
    throw Error(ErrorCode::kBadFile, sensor.rate_at(),
                fmt::format("{} {}: several measurements would be of one instant. Set 'step_ms' to "
                            "at most {:.6g}, or a rate of at most {:.6g} Hz",
                            subject, problem, 1e3 * to_seconds(periodic->period),
                            1.0 / to_seconds(world.step)))
        .about(subject);
  if (warn && periodic->phase >= time_limit)
    warn({Consequence::kDoubtful, sensor.rate_at(), subject,
          fmt::format("measures nothing: its first measurement is at {:.6g} s, and the flight ends "
                      "at {:.6g} s",
                      to_seconds(periodic->phase), to_seconds(time_limit))});
  if (periodic->period % world.step == Duration(0) || periodic->period >= kSteady * world.step)
    return;
  if (warn)
    warn({Consequence::kBehavesDifferent, sensor.rate_at(), subject,
          fmt::format("{}: the time between two measurements varies by {}. Set a 'step_ms' that "
                      "divides the period",
                      problem, ms(world.step))});
}

/// Of a sensor that is meant to fail, the answer says so; of another, it is a mistake.
void warn_of_losses(const sim::Sensor& sensor, const std::string& uav,
                    const sim::WarningSink& warn) {
  constexpr double kMany = 0.5;
  const auto warn_of = [&](double probability, std::string_view key, std::string_view does) {
    if (warn && probability >= kMany)
      warn({Consequence::kDoubtful,
            {},
            fmt::format("sensor '{}' of UAV '{}'", sensor.name, uav),
            fmt::format("{} {:.3g} % of its measurements ({} = {:.6g})", does, 100.0 * probability,
                        key, probability)});
  };
  std::visit(
      [&](const auto& model) {
        if constexpr (requires { model.dropout_probability; })
          warn_of(model.dropout_probability, "dropout_probability", "loses");
        if constexpr (requires { model.outage_every_s; })
          if (model.outage_every_s > 0.0)
            warn_of(model.outage_lasts_s / model.outage_every_s, "outage_lasts_s / outage_every_s",
                    "has no fix in");
      },
      sensor.model);
  warn_of(sensor.driver.lost_probability, "lost_probability", "loses");
  warn_of(sensor.driver.repeated_probability, "repeated_probability", "repeats");
}

const UavSetup& setup_of(const Scenario& scenario, const std::string& uav) {
  for (const UavSetup& setup : scenario.uavs) {
    if (setup.placement.name == uav) return setup;
  }
  throw Error(ErrorCode::kInternal,
              fmt::format("the world has a UAV '{}' that is not in its scenario", uav));
}

std::vector<uav::SensorTiming> resolve(const Scenario& scenario, const Condition& condition,
                                       const sim::World& world, sim::Uav& uav,
                                       const sim::WarningSink& warn) {
  const UavSetup& setup = setup_of(scenario, uav.name);
  Sensors sensors = sensors_of(uav);
  if (setup.profile) ProfileLayer(*setup.profile, uav, sensors).lay(warn);
  lay_setup(setup, sensors);
  for (const Profile& profile : condition.profiles) ProfileLayer(profile, uav, sensors).lay(warn);
  require_sensors_of_metrics(scenario, setup, sensors);
  require_sensors_of_clauses(setup, sensors);

  std::vector<uav::SensorTiming> timings;
  for (LayeredSensor& sensor : sensors) {
    timings.push_back(sensor.finish());
    check_rate(sensor, timings.back(), uav.name, world, scenario.time_limit, warn);
    warn_of_losses(sensor.sensor(), uav.name, warn);
  }
  return timings;
}

}  // namespace

std::vector<std::vector<uav::SensorTiming>> resolve_sensors(const Scenario& scenario,
                                                            const Condition& condition,
                                                            sim::World& world,
                                                            const sim::WarningSink& warn) {
  std::vector<std::vector<uav::SensorTiming>> timings;
  for (sim::Uav& uav : world.uavs)
    timings.push_back(resolve(scenario, condition, world, uav, warn));
  return timings;
}

}  // namespace tether::scenario
