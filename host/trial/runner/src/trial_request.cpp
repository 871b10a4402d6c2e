#include <concepts>
#include <type_traits>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <tether/base/error.h>
#include <tether/runner/trial_request.h>

/// The text of a request, and the trial that it asks for. `fields` lists the members once, for both
/// directions; `make_condition` lays them over the scenario's condition.
namespace tether::runner {

namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

void fields(auto& io, auto& request) {
  io("scenario", request.scenario);
  io("settings", request.settings);
  io("profile", request.profile);
  io("model_folders", request.reading.model_folders);
  io("strict", request.reading.is_strict);
  io("tolerant", request.reading.is_tolerant);
  io("condition", request.condition);
  io("target", request.target);
  io("simulator", request.simulator);
  io("unknown_stages", request.unknown_stages);
  io("slowdown", request.slowdown);
  io("cpu_time_scale", request.cpu_time_scale);
  io("real_time_factor", request.real_time_factor);
  io("seed", request.seed);
  io("record_images", request.record_images);
  io("listen", request.listen);
  io("tunnel", request.uses_tunnel);
  io("folder", request.folder);
  io("replaces_earlier", request.replaces_earlier);
}

template <class Value>
concept Plain = std::same_as<Value, std::string> || std::is_arithmetic_v<Value>;

// A value as JSON, and the inverse.
Json json_of(const Plain auto& value) {
  return value;
}
Json json_of(const fs::path& path) {
  return path.string();
}
Json json_of(const TargetChoice& choice) {
  return to_text(choice);
}
Json json_of(const scenario::Setting& setting) {
  return Json{{"key", setting.key}, {"value", setting.value}};
}
Json json_of(const std::optional<double>& value) {
  return value ? Json(*value) : Json(nullptr);
}
template <class Value>
Json json_of(const std::vector<Value>& values) {
  Json list = Json::array();
  for (const Value& value : values) list.push_back(json_of(value));
  return list;
}

void read(const Json& json, Plain auto& value) {
  json.get_to(value);
}
void read(const Json& json, fs::path& path) {
  path = json.get<std::string>();
}
void read(const Json& json, TargetChoice& choice) {
  choice = parse_target_choice(json.get<std::string>());
}
void read(const Json& json, scenario::Setting& setting) {
  setting = {json.at("key"), json.at("value")};
}
void read(const Json& json, std::optional<double>& value) {
  if (!json.is_null()) value = json.get<double>();
}
template <class Value>
void read(const Json& json, std::vector<Value>& values) {
  for (const Json& element : json) read(element, values.emplace_back());
}

/// Moves the condition's SUTs to that target. A condition that was selected by name keeps its name,
/// so that results show both.
void move_to(scenario::Condition& condition, const scenario::Target& target, bool keep_name) {
  scenario::place_on(condition, target);
  condition.moved_from = condition.name;
  condition.name = keep_name ? fmt::format("{} on {}", condition.name, target.name) : target.name;
  if (!keep_name) condition.description = target.description;
}

/// The target for a board's address; its time is measured by the wall clock.
scenario::Target board_at(const scenario::SshAddress& address) {
  scenario::Target target;
  target.name = address.destination;
  target.ssh = address;
  return target;
}

/// On a machine of another speed. It is the same condition: its name stays.
void scale_cpu_time(scenario::Condition& condition, double scale) {
  bool is_used = false;
  for (scenario::Computer& own : condition.computers) {
    if (own.clock.kind != computer::ClockKind::kCpu) continue;
    own.clock.factor *= scale;
    is_used = true;
  }
  if (is_used) return;
  throw Error(ErrorCode::kUsage,
              fmt::format("--cpu-time-scale {}: condition \"{}\" does not have clock = \"cpu\".",
                          scale, condition.name))
      .about("--cpu-time-scale");
}

scenario::Condition make_condition(const scenario::Scenario& scenario,
                                   const TrialRequest& request) {
  scenario::Condition condition = scenario::pick_condition(scenario, request.condition);
  if (request.real_time_factor) condition.real_time_factor = *request.real_time_factor;
  const bool keep_name = !request.condition.empty();
  if (const auto* file = std::get_if<fs::path>(&request.target))
    move_to(condition, scenario::load_target(*file), keep_name);
  if (const auto* address = std::get_if<scenario::SshAddress>(&request.target))
    move_to(condition, board_at(*address), keep_name);
  if (!request.simulator.empty()) condition.simulator = request.simulator;
  if (request.slowdown) scenario::slow_down(condition, *request.slowdown);
  if (request.cpu_time_scale) scale_cpu_time(condition, *request.cpu_time_scale);
  if (!request.unknown_stages.empty())
    scenario::set_unknown_stages(condition, request.unknown_stages);
  return condition;
}

/// Rejects --tunnel if it has no effect.
void require_use_of_tunnel(const TrialSpec& spec) {
  if (!spec.uses_tunnel || spec.has_sut_at(SutPlace::kBoard)) return;
  throw Error(ErrorCode::kUsage,
              "--tunnel needs a SUT on a board. Select the board with --target "
              "ssh://[user@]board[:port] or a target file with its address, or omit --tunnel")
      .about("--tunnel");
}

link::Address listen_address(const std::string& text) {
  const auto address = link::parse_address(text);
  if (address) return *address;
  throw Error(ErrorCode::kUsage, "--listen: " + address.failure().message).about("--listen");
}

}  // namespace

std::string to_json(const TrialRequest& request) {
  Json json;
  const auto write = [&json](const char* name, const auto& value) { json[name] = json_of(value); };
  fields(write, request);
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

TrialRequest parse_trial_request(std::string_view text) try {
  const Json json = Json::parse(text);
  TrialRequest request;
  const auto read_field = [&json](const char* name, auto& value) { read(json.at(name), value); };
  fields(read_field, request);
  return request;
} catch (const Json::exception& wrong) {
  throw Error(ErrorCode::kBadFile,
              fmt::format("the request of a trial is not as Tether writes it: {}", wrong.what()));
}

TrialRequest request_of(const campaign::TrialPlan& plan) {
  const scenario::Condition& condition = *plan.condition;
  const bool is_slowed = !condition.slowed_from.empty();
  TrialRequest request{.scenario = plan.scenario->file,
                       .settings = plan.scenario->settings,
                       .profile = plan.profile,
                       .reading = plan.scenario->world_options,
                       .condition = is_slowed ? condition.slowed_from : condition.name,
                       .simulator = condition.simulator,
                       .seed = plan.seed,
                       .record_images = plan.record_images,
                       .folder = plan.folder};
  if (is_slowed) request.slowdown = condition.slowdown;
  return request;
}

TrialSpec make_trial(const TrialRequest& request) {
  TrialSpec spec;
  spec.scenario = scenario::load_scenario(request.scenario, request.settings);
  spec.scenario.record_images |= request.record_images;
  spec.scenario.world_options = request.reading;
  if (!request.profile.empty())
    scenario::lay_profile(spec.scenario, scenario::load_profile(request.profile));
  spec.condition = make_condition(spec.scenario, request);
  spec.seed = request.seed;
  spec.folder =
      request.folder.empty()
          ? "out" / campaign::trial_folder(spec.scenario.name, spec.condition.name, spec.seed)
          : request.folder;
  if (request.folder.empty() || request.replaces_earlier) spec.earlier = EarlierRun::kReplace;
  if (!request.listen.empty()) spec.listen = listen_address(request.listen);
  spec.waits_for_sut = std::holds_alternative<WaitForSut>(request.target);
  spec.uses_tunnel = request.uses_tunnel;
  require_use_of_tunnel(spec);
  return spec;
}

}  // namespace tether::runner
