#include "notes.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <tether/base/error.h>
#include <tether/workers/worker.h>

// The speed of a node is kept in a folder that gets its name with its content, so that one
// measurement of a node counts, and one node is the first.
namespace tether::workers {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr const char* kFirst = ".first";  // no node has that name

struct Speed {
  std::string node;
  double ms = 0.0;
};

fs::path speed_folder(const std::string& name) {
  return fs::path(kWorkersFolder) / "nodes" / name;
}

std::optional<Speed> read_speed(const SharedFolder& folder, const std::string& name) {
  const auto text = folder.read(speed_folder(name) / "speed.json");
  const Json json = Json::parse(text.value_or(""), nullptr, false);
  if (!json.is_object() || !json.contains("node") || !json["node"].is_string() ||
      !json.contains("step_ms") || !json["step_ms"].is_number())
    return std::nullopt;
  return Speed{json["node"], json["step_ms"]};
}

/// That of the name, which is `own` if there was none.
Speed keep_speed(const SharedFolder& folder, const std::string& name, const Speed& own,
                 const WorkerName& self) {
  if (const auto earlier = read_speed(folder, name)) return *earlier;
  const fs::path staging = fs::path(kWorkersFolder) / "staging" / (self.id + name);
  folder.make(staging);
  folder.create(staging / "speed.json",
                Json{{"node", own.node}, {"step_ms", own.ms}}.dump() + "\n");
  if (!folder.rename(staging, speed_folder(name))) folder.remove(staging);
  return read_speed(folder, name).value_or(own);
}

}  // namespace

double node_scale(const Round& round, const WorkerSetup& setup) {
  if (!round.settings().measures_nodes) return 1.0;
  const SharedFolder& folder = round.folder();
  const std::string& node = setup.self.node;
  auto own = read_speed(folder, node);
  if (!own) own = keep_speed(folder, node, {node, setup.measure_ms()}, setup.self);
  const Speed first = keep_speed(folder, kFirst, *own, setup.self);
  const double scale = first.ms / own->ms;
  if (round.settings().scales_nodes) return scale;
  if (scale <= kLikeNodes && scale >= 1.0 / kLikeNodes) return 1.0;
  throw Error(ErrorCode::kUsage,
              fmt::format("node {} needs {:.1f} ms for the work that takes {:.1f} ms on {}, and "
                          "these trials measure CPU time. Use nodes of one kind, or "
                          "--scale-nodes, or a counted target.",
                          node, own->ms, first.ms, first.node))
      .about(node);
}

}  // namespace tether::workers
