#include "files/named_file.h"
#include "files/scenario_keys.h"
#include "files/settings.h"
#include "tables/read_clock.h"
#include "tables/read_computers.h"
#include "tables/read_delay.h"
#include "tables/read_flight_controller.h"
#include "tables/read_metric.h"
#include "tables/read_motion.h"
#include "tables/read_radio.h"
#include "tables/read_replay.h"
#include "tables/read_sensor_profile.h"
#include "tables/read_sut.h"
#include "tables/read_vary.h"

#include <algorithm>
#include <array>
#include <set>

#include <fmt/format.h>

#include <tether/base/text.h>
#include <tether/base/units.h>
#include <tether/scenario/scenario.h>
#include <tether/toml/table.h>

// Reads a scenario table by table: each function reads one table, checks it with what was read
// before it, and adds the files that the table names to the scenario's.
namespace tether::scenario {
namespace {

constexpr std::array<std::string_view, 2> kPolicies = {"conservative_barrier", "free_running"};
constexpr std::array<std::string_view, 2> kSimulators = {"mujoco", "gazebo"};

// Profiles.

void add_files(Scenario& scenario, const std::vector<std::filesystem::path>& more) {
  scenario.files.insert(scenario.files.end(), more.begin(), more.end());
}

void sort_files(Scenario& scenario) {
  std::sort(scenario.files.begin(), scenario.files.end());
  const auto last = std::unique(scenario.files.begin(), scenario.files.end());
  scenario.files.erase(last, scenario.files.end());
}

std::optional<Profile> read_profile(const toml::Table& table, Scenario& scenario) {
  if (!table.has("profile")) return std::nullopt;
  Profile profile = load_profile(named_file(table, "profile", ShippedKind::kProfile));
  add_files(scenario, profile.files);
  return profile;
}

// UAVs.

void read_sensors(const toml::Table& table, Scenario& scenario, UavSetup& uav) {
  if (!table.has("sensors")) return;
  const toml::Table sensors = table.table("sensors");
  for (const std::string& name : sensors.keys()) {
    uav.sensors.emplace(name,
                        read_sensor_profile(sensors, name, KindKey::kOptional, scenario.files));
  }
}

void read_commands(const toml::Table& table, Scenario& scenario, UavSetup& uav) {
  constexpr toml::Range kLatency_ms{.min = 0.0, .max = 10'000.0};
  constexpr toml::Range kTimeout_ms{.min = 0.0, .max = 3.6e6, .above_min = true};
  constexpr std::array<std::string_view, 4> kActions = {"keep", "hover", "brake", "land"};
  if (table.has("command_latency") && table.has("command_latency_ms"))
    table.fail("command_latency_ms", "and 'command_latency' exclude each other. Remove one.");
  if (table.has("command_latency"))
    uav.command_latency = read_delay(table, "command_latency", scenario.files);
  else
    uav.command_latency =
        uav::ConstantDelay{table.duration_or("command_latency_ms", kLatency_ms, Duration{0})};
  if (table.has("setpoint_timeout_ms")) {
    uav.setpoint_loss.emplace();
    uav.setpoint_loss->timeout = table.duration("setpoint_timeout_ms", kTimeout_ms);
  }
  if (!table.has("on_setpoint_loss")) return;
  if (!uav.setpoint_loss)
    table.fail("on_setpoint_loss", "needs 'setpoint_timeout_ms'. Add it, or remove this key.");
  uav.setpoint_loss->action =
      static_cast<uav::LossAction>(table.choice("on_setpoint_loss", kActions));
}

constexpr std::string_view kAutopilot = "autopilot";  // as link::kAutopilot

UavSetup read_uav(const toml::Table& table, const std::optional<Sut>& default_sut,
                  Scenario& scenario) {
  constexpr toml::Range kCoordinate_m{.min = -1e5, .max = 1e5};
  constexpr toml::Range kYaw_deg{.min = -360.0, .max = 360.0};
  constexpr toml::Range kYawSpread_deg{.min = 0.0, .max = 180.0};
  UavSetup uav;
  uav.placement.name = table.identifier("name");
  uav.placement.model = named_file(table, "model", ShippedKind::kModel);
  scenario.files.push_back(uav.placement.model);
  const auto position_m = table.numbers("position_m", 3, kCoordinate_m);
  uav.placement.p_WB = {position_m[0], position_m[1], position_m[2]};
  uav.placement.yaw_rad = rad_from_deg(table.number_or("yaw_deg", kYaw_deg, 0.0));
  uav.yaw_spread_rad = rad_from_deg(table.number_or("yaw_spread_deg", kYawSpread_deg, 0.0));
  read_commands(table, scenario, uav);
  uav.profile = read_profile(table, scenario);
  read_sensors(table, scenario, uav);
  if (table.has("energy")) {
    uav.energy = load_energy(named_file(table, "energy", ShippedKind::kEnergy));
    scenario.files.push_back(uav.energy->file);
  }
  uav.flight_controller = read_flight_controller(table);
  if (uav.flight_controller && !uav.flight_controller->signing_key_file.empty())
    scenario.files.push_back(uav.flight_controller->signing_key_file);
  uav.seat = read_seat(table, scenario);
  uav.sut = read_sut(table, default_sut, scenario);
  if (uav.sut.mission)
    mission::require_possible(*uav.sut.mission, {.anchors = scenario.anchors,
                                                 .time_limit = scenario.time_limit,
                                                 .has_battery = uav.energy.has_value()});
  return uav;
}

void read_uavs(const toml::Table& root, Scenario& scenario) {
  const std::optional<Sut> default_sut = read_default_sut(root, scenario);
  std::set<std::string> names;
  for (const toml::Table& table : root.tables("uav", kUavKeys)) {
    scenario.uavs.push_back(read_uav(table, default_sut, scenario));
    const std::string& name = scenario.uavs.back().placement.name;
    if (name == kAutopilot)
      table.fail("name", "is the name of flight controllers for programs. Choose another one.");
    if (!names.insert(name).second) {
      table.fail(
          "name",
          fmt::format("is \"{}\", which is also the name of another UAV. Names must be unique.",
                      name));
    }
  }
}

// Conditions.

// Some keys and values need a certain clock or policy.
void read_own_clock(const toml::Table& table, Condition& condition) {
  using enum computer::ClockKind;
  if (!table.has("clock")) {
    table.fail("clock", "is missing. Add it, or a 'target' whose file specifies the clock.");
  }
  const computer::Clock clock =
      read_clock(table, {kWall, kCpu, kScripted, kUnstamped, kCounted, kReplayed});
  if (clock.kind == kCounted)
    table.fail("clock",
               "is \"counted\", which needs an emulator and costs. Name a 'target' whose file has "
               "them, instead of this key.");
  if (clock.needs_barrier() && condition.policy == Policy::kFreeRunning)
    table.fail("clock", fmt::format("is \"{}\", which needs policy = \"conservative_barrier\", "
                                    "because free running uses the wall clock.",
                                    computer::name(clock.kind)));
  condition.computers.front().clock = clock;
}

// The target's file specifies how the time of its SUTs is measured.
void read_target(const toml::Table& table, Condition& condition, Scenario& scenario) {
  for (const char* key : {"clock", "cpu_factor", "computing_ms"}) {
    if (table.has(key))
      table.fail(key, "is specified by the target's file. Remove this key, or 'target'.");
  }
  const Target target = load_target(named_file(table, "target", ShippedKind::kTarget));
  if (const std::string why = why_not_on(condition, target); !why.empty()) {
    table.fail("target", fmt::format("cannot be used here: {}", why));
  }
  scenario.files.push_back(target.file);
  place_on(condition, target);
}

Condition read_condition(const toml::Table& table, Scenario& scenario) {
  constexpr toml::Range kFactor{.min = 1e-3, .max = 1e4};
  Condition condition;
  condition.name = table.text("name");
  if (slug(condition.name).empty()) {
    table.fail("name",
               "must contain a letter or a digit, because it becomes the name of a folder.");
  }
  condition.description = table.text_or("description", "");
  condition.policy = static_cast<Policy>(table.choice("policy", kPolicies));
  const bool has_own = table.has("target") || table.has("clock");
  if (table.has("shared") && (has_own || scenario.computers.empty()))
    table.fail("shared",
               "is for conditions under which the UAVs run on the tables [[target]], without "
               "'clock' and 'target'.");
  if (table.has("target")) {
    read_target(table, condition, scenario);
  } else if (!has_own && !scenario.computers.empty()) {
    read_seats(table, condition, scenario);
  } else {
    read_own_clock(table, condition);
  }
  condition.replay = read_replay(table, condition, scenario);
  if (table.has("radio")) condition.radio = read_radio(table, scenario.files);
  condition.real_time_factor = table.number_or("real_time_factor", kFactor, 0.0);
  if (condition.policy == Policy::kFreeRunning && condition.real_time_factor == 0.0) {
    table.fail(
        "real_time_factor",
        "is missing. policy = \"free_running\" needs it: the seconds of ST per second of wall "
        "time.");
  }
  if (table.has("simulator"))
    condition.simulator = kSimulators[table.choice("simulator", kSimulators)];
  return condition;
}

void read_conditions(const toml::Table& root, Scenario& scenario) {
  std::map<std::string, std::string> slugs;
  for (const toml::Table& table : root.tables("condition", kConditionKeys)) {
    scenario.conditions.push_back(read_condition(table, scenario));
    if (auto profile = read_profile(table, scenario)) {
      scenario.conditions.back().profiles.push_back(std::move(*profile));
    }
    const std::string& name = scenario.conditions.back().name;
    const auto [other, is_new] = slugs.emplace(slug(name), name);
    if (!is_new && other->second == name)
      table.fail("name", fmt::format("is \"{}\", which is also the name of another condition. "
                                     "Names must be unique.",
                                     name));
    if (!is_new) {
      table.fail("name", fmt::format("is \"{}\", too similar to the condition \"{}\". Names must "
                                     "differ in their letters and digits.",
                                     name, other->second));
    }
  }
}

// The rest.

void read_anchors(const toml::Table& root, Scenario& scenario) {
  scenario.anchors = root.texts_or_none("anchors");
  if (root.has("anchors")) scenario.anchors_at = root.where("anchors");
  const std::set<std::string> distinct(scenario.anchors.begin(), scenario.anchors.end());
  if (distinct.size() < scenario.anchors.size()) root.fail("anchors", "names an anchor twice.");
}

void read_record(const toml::Table& root, Scenario& scenario) {
  if (!root.has("record")) return;
  const toml::Table record =
      root.table("record", {"ground_truth_period_ms", "images", "image_period_ms"});
  constexpr toml::Range kImagePeriod_ms{.min = 0.0, .max = 1e6};
  constexpr toml::Range kPeriod_ms{.min = 1e3 * to_seconds(sim::kLeastStep), .max = 1e6};
  scenario.ground_truth_period =
      record.duration_or("ground_truth_period_ms", kPeriod_ms, scenario.ground_truth_period);
  if (record.has("ground_truth_period_ms"))
    scenario.ground_truth_at = record.where("ground_truth_period_ms");
  scenario.record_images = record.boolean_or("images", scenario.record_images);
  scenario.image_period =
      record.duration_or("image_period_ms", kImagePeriod_ms, scenario.image_period);
}

void read_limits(const toml::Table& root, Scenario& scenario) {
  constexpr toml::Range kStep_ms{.min = 1e3 * to_seconds(sim::kLeastStep),
                                 .max = 1e3 * to_seconds(sim::kMostStep)};
  constexpr toml::Range kSpan_s{.min = 0.0, .max = kLongestRun_s, .above_min = true};
  constexpr toml::Range kSpeed_m_s{.min = 0.0, .with_inf = true};
  if (root.has("step_ms")) {
    scenario.step = root.duration("step_ms", kStep_ms);
    scenario.step_at = root.where("step_ms");
  }
  scenario.time_limit = root.duration("time_limit_s", kSpan_s);
  scenario.hang_limit = root.duration_or("hang_limit_s", kSpan_s, scenario.hang_limit);
  scenario.connect_limit = root.duration_or("connect_limit_s", kSpan_s, scenario.connect_limit);
  scenario.max_contact_speed_m_s =
      root.number_or("max_contact_speed_m_s", kSpeed_m_s, scenario.max_contact_speed_m_s);
}

}  // namespace

std::string_view name(Policy policy) {
  return kPolicies[static_cast<std::size_t>(policy)];
}

std::string slug(std::string_view name) {
  std::string slug;
  for (const char c : name) {
    const bool upper = c >= 'A' && c <= 'Z';
    const bool kept = upper || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
    if (kept) slug += upper ? static_cast<char>(c - 'A' + 'a') : c;
    if (!kept && !slug.empty() && slug.back() != '-') slug += '-';
  }
  while (slug.ends_with('-')) slug.pop_back();
  return slug;
}

Condition pick_condition(const Scenario& scenario, const std::string& wanted) {
  if (wanted.empty()) return scenario.conditions.front();
  if (const auto* condition = scenario.find_condition(wanted)) return *condition;
  std::vector<std::string_view> names;
  for (const Condition& condition : scenario.conditions) names.push_back(condition.name);
  throw Error(ErrorCode::kUsage, {scenario.file.string()},
              fmt::format("has no condition '{}'; {}", wanted, allowed_hint(wanted, names)))
      .about(wanted);
}

FileLocation Scenario::where(std::string_view key) const {
  return toml::place_of(file, key);
}

const Condition* Scenario::find_condition(std::string_view condition) const {
  const auto found = std::ranges::find(conditions, condition, &Condition::name);
  return found == conditions.end() ? nullptr : &*found;
}

namespace {

/// Results tell profiles by their names.
void check_profile_names(const Scenario& scenario) {
  std::map<std::string, std::filesystem::path> files;
  const auto check = [&files](const Profile& profile) {
    const auto [known, is_new] = files.emplace(profile.name, profile.file);
    if (!is_new && known->second != profile.file)
      throw Error(ErrorCode::kBadFile, toml::place_of(profile.file, "name"),
                  fmt::format("'name' is \"{}\", which is also the name of the profile {}. Names "
                              "must be unique, because results tell profiles by them.",
                              profile.name, known->second.string()))
          .about("name");
  };
  for (const UavSetup& uav : scenario.uavs)
    if (uav.profile) check(*uav.profile);
  for (const Condition& condition : scenario.conditions)
    for (const Profile& profile : condition.profiles) check(profile);
}

Scenario read_scenario(const std::filesystem::path& file, const std::vector<Setting>& settings) {
  Scenario scenario;
  scenario.file = std::filesystem::absolute(file).lexically_normal();
  toml::Document document = toml::Document::load(scenario.file);
  std::vector<Setting> of_profiles;
  for (const Setting& setting : settings)
    if (setting.key != kUavCount && !apply(setting, document)) of_profiles.push_back(setting);
  scenario.settings = settings;
  const toml::Table root = document.root();
  root.require_keys_in(kScenarioKeys);
  scenario.name = root.identifier("name") + name_suffix(settings);
  scenario.description = root.text_or("description", "");
  scenario.world = named_file(root, "world", ShippedKind::kWorld);
  scenario.files = {scenario.file, scenario.world};
  read_limits(root, scenario);
  read_anchors(root, scenario);
  read_computers(root, scenario);
  read_uavs(root, scenario);
  const bool lands_faster = std::ranges::any_of(
      scenario.uavs, [](const UavSetup& uav) { return uav.flight_controller.has_value(); });
  if (lands_faster && !root.has("max_contact_speed_m_s"))
    scenario.max_contact_speed_m_s = kHardLanding_m_s;
  require_users(scenario);
  scenario.radio = read_radio(root, scenario.files);
  read_motion(root, scenario);
  scenario.variations = read_vary(root);
  read_conditions(root, scenario);
  apply_to_profiles(of_profiles, scenario);
  check_profile_names(scenario);
  read_metrics(root, scenario);
  read_record(root, scenario);
  for (const Setting& setting : settings)
    if (setting.key == kUavCount) keep_first_uavs(scenario, setting.value);
  sort_files(scenario);
  return scenario;
}

/// If the error is about a value of a setting: the same error, which names the setting in place of
/// the file's line.
Error with_setting(const Error& error, const std::filesystem::path& file,
                   const std::vector<Setting>& settings, const std::string& from) {
  const auto wrong = std::ranges::find(settings, error.subject(), [](const Setting& setting) {
    return setting.key.substr(setting.key.rfind('.') + 1);
  });
  if (wrong == settings.end()) return error;
  try {
    read_scenario(file, {});
  } catch (const Error& own) {
    if (own.where() == error.where()) return error;  // another key of that name is wrong
  }
  return Error(error.code(), fmt::format("{}{}={}: {}", from, wrong->key, wrong->value,
                                         error.what() + located(error.where(), "").size()))
      .about(error.subject());
}

}  // namespace

Scenario load_scenario(const std::filesystem::path& file, const std::vector<Setting>& settings,
                       const std::string& from) {
  try {
    return read_scenario(file, settings);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::kBadFile) throw;
    throw with_setting(error, file, settings, from);
  }
}

void lay_profile(Scenario& scenario, const Profile& profile) {
  for (Condition& condition : scenario.conditions) condition.profiles.push_back(profile);
  check_profile_names(scenario);
  scenario.has_laid_profile = true;
  add_files(scenario, profile.files);
  sort_files(scenario);
}

std::vector<std::string> profile_names(const Scenario& scenario, const Condition& condition) {
  std::vector<std::string> names;
  for (const UavSetup& uav : scenario.uavs) {
    const bool is_new =
        uav.profile && std::find(names.begin(), names.end(), uav.profile->name) == names.end();
    if (is_new) names.push_back(uav.profile->name);
  }
  for (const Profile& profile : condition.profiles) {
    std::erase(names, profile.name);
    names.push_back(profile.name);
  }
  return names;
}

}  // namespace tether::scenario
