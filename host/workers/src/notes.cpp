#include "notes.h"

#include <nlohmann/json.hpp>

namespace tether::workers {
namespace {

using Json = nlohmann::json;

Json json_of(const WorkerName& self) {
  return Json{{"worker", self.id}, {"node", self.node}, {"task", self.task}};
}

std::string dump(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

/// An empty object if the text is not an object, for instance half a file.
Json object_of(const std::string& text) {
  Json json = Json::parse(text, nullptr, false);
  return json.is_object() ? json : Json::object();
}

std::string text_in(const Json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_string() ? found->get<std::string>() : "";
}

bool is_set(const Json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_boolean() && found->get<bool>();
}

}  // namespace

std::string text_of(const WorkerName& self, const std::string& why) {
  Json json = json_of(self);
  if (!why.empty()) json["why"] = why;
  return dump(json);
}

std::string text_of(const WorkerState& state) {
  Json json = json_of(state.name);
  json["beat"] = state.beat;
  json["ended"] = state.has_ended;
  json["refused"] = state.is_refused;
  json["why"] = state.why_early;
  return dump(json);
}

Note read_note(const SharedFolder& folder, const std::filesystem::path& file) {
  const Json json = object_of(folder.read(file).value_or(""));
  return {text_in(json, "worker"), text_in(json, "node"), text_in(json, "task"),
          text_in(json, "why")};
}

std::map<std::string, WorkerState> read_workers(const Round& round) {
  std::map<std::string, WorkerState> workers;
  for (const std::string& name : round.folder().list(round.path("workers"))) {
    const Json json = object_of(round.folder().read(round.path("workers/" + name)).value_or(""));
    if (text_in(json, "worker") != name) continue;
    const auto beat = json.find("beat");
    workers[name] = {
        .name = {name, text_in(json, "node"), text_in(json, "task")},
        .beat = beat != json.end() && beat->is_number_unsigned() ? beat->get<std::uint64_t>() : 0,
        .has_ended = is_set(json, "ended"),
        .why_early = text_in(json, "why"),
        .is_refused = is_set(json, "refused")};
  }
  return workers;
}

}  // namespace tether::workers
