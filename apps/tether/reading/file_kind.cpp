#include "reading/file_kind.h"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include <tether/base/error.h>
#include <tether/campaign/campaign_folder.h>
#include <tether/campaign/result.h>
#include <tether/os/text_file.h>
#include <tether/runner/trial_folder.h>
#include <tether/toml/table.h>

namespace tether::app {

namespace {

namespace fs = std::filesystem;

struct KindText {
  const char* name;
  const char* use;  ///< what to do with it; {} is its path
};
constexpr std::array<KindText, 12> kFileKinds = {{
    {"a scenario", "To fly it, type: tether run {}"},
    {"a campaign", "To fly it, type: tether campaign {}"},
    {"a sensor profile", "To use it, type: tether run SCENARIO --profile {}"},
    {"a target", "To use it, type: tether run SCENARIO --target {}"},
    {"a world or model", "To use it, name it in a scenario ('world', or 'model' of a [[uav]])"},
    {"a mission", "To fly it, type: tether-sut mission {}"},
    {"a rig", "To use it, type: tether-sut TASK --rig {}"},
    {"an engine", "To fly by it, type: tether campaign CAMPAIGN --engine {}"},
    {"a record", "To check it, type: tether audit {0}; to draw it, tether plot {0}"},
    {"the folder of a run",
     "To report it, type: tether report {0}; its record is "
     "{0}/record.mcap"},
    {"the folder of a campaign", "To report it, type: tether report {}"},
    {"a program",
     "To fly it, type: tether run -- {}, with its interpreter before it if it needs one"},
}};

/// The keys by which a TOML file is recognised: it has all of the first list and none of the
/// second.
struct Signature {
  FileKind kind;
  std::vector<std::string_view> has, lacks;
};
const std::vector<Signature>& signatures() {
  static const std::vector<Signature> all = {
      {FileKind::kScenario, {"world", "uav"}, {}},
      {FileKind::kCampaign, {"scenario"}, {"world"}},
      {FileKind::kMission, {"task"}, {"world", "sensors"}},
      {FileKind::kRig, {"sensors", "uav"}, {"world", "name"}},
      {FileKind::kRig, {"sensors", "anchor"}, {"world", "name"}},
      {FileKind::kProfile, {"name", "sensors"}, {"world"}},
      {FileKind::kEngine, {"command", "shards"}, {"world", "name"}},
      {FileKind::kTarget, {"name", "clock"}, {"sensors", "world"}},
      {FileKind::kTarget, {"name", "address"}, {"sensors", "world"}},
  };
  return all;
}

std::optional<FileKind> kind_of_toml(const fs::path& file) try {
  const toml::Document document = toml::Document::load(file);
  const toml::Table root = document.root();
  const auto has = [&](std::string_view key) { return root.has(key); };
  const auto found = std::ranges::find_if(signatures(), [&](const Signature& s) {
    return std::ranges::all_of(s.has, has) && std::ranges::none_of(s.lacks, has);
  });
  return found == signatures().end() ? std::nullopt : std::optional(found->kind);
} catch (const Error&) {
  return std::nullopt;
}

}  // namespace

std::optional<FileKind> results_in(const fs::path& folder) {
  std::error_code ignored;
  if (fs::exists(folder / campaign::kCampaignFile, ignored)) return FileKind::kCampaignFolder;
  if (fs::exists(folder / campaign::kResultFile, ignored)) return FileKind::kRun;
  return std::nullopt;
}

std::optional<FileKind> kind_of(const fs::path& path) {
  constexpr std::string_view kMcap = "\x89MCAP";
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) {
    const bool has_record = fs::exists(path / runner::kRecordFile, ignored);
    const auto results = results_in(path);
    return results || !has_record ? results : FileKind::kRun;
  }
  if (!fs::is_regular_file(path, ignored)) return std::nullopt;
  const std::string begin = os::begin_of(path, kMcap.size());
  if (begin == kMcap) return FileKind::kRecord;
  if (begin.starts_with('<')) return FileKind::kWorld;
  if (begin.starts_with("#!") ||
      begin.starts_with("\x7f"
                        "ELF") ||
      path.extension() == ".py" || path.extension() == ".js")
    return FileKind::kProgram;
  return kind_of_toml(path);
}

void require_kind(const fs::path& path, FileKind wanted) {
  const auto kind = kind_of(path);
  if (!kind || kind == wanted) return;
  const auto& [name, use] = kFileKinds.at(static_cast<std::size_t>(*kind));
  throw Error(
      ErrorCode::kUsage, {path.string()},
      fmt::format("is {}, not {}. {}", name, kFileKinds.at(static_cast<std::size_t>(wanted)).name,
                  fmt::format(fmt::runtime(use), path.string())))
      .about(path.string());
}

}  // namespace tether::app
