// Names, reads and writes the files of a round (round.h has the layout). A file that others may
// read appears by a rename, and a claim is a file that only one worker can create.

#include <algorithm>
#include <charconv>
#include <sstream>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <tether/base/error.h>
#include <tether/os/text_file.h>
#include <tether/workers/round.h>

namespace tether::workers {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr int kSchema = 1;

fs::path rounds_folder() {
  return fs::path(kWorkersFolder) / "rounds";
}

fs::path round_folder(std::size_t number) {
  return rounds_folder() / fmt::format("{:04}", number);
}

std::string shard_name(std::size_t shard) {
  return fmt::format("{:05}", shard);
}

std::optional<std::size_t> number_of(std::string_view name) {
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  if (error != std::errc() || end != name.data() + name.size()) return std::nullopt;
  return number;
}

/// The text as JSON, read by `read`; whatever is wrong is an Error(kBadFile) about the file.
template <class Read>
auto from_json(const std::string& text, const fs::path& file, const Read& read) {
  try {
    return read(Json::parse(text));
  } catch (const Json::exception& wrong) {
    throw Error(ErrorCode::kBadFile, {file.string()},
                fmt::format("is not as tether writes it ({}). Remove {} and start again with "
                            "--resume; results are kept.",
                            wrong.what(), kWorkersFolder))
        .about(file.string());
  }
}

Json json_of(const RoundSettings& settings) {
  return Json{{"schema", kSchema},
              {"job", settings.job},
              {"items", settings.items},
              {"chunk", settings.chunk},
              {"beats", settings.beats},
              {"measures_nodes", settings.measures_nodes},
              {"scales_nodes", settings.scales_nodes},
              {"files", settings.files},
              {"command", settings.command}};
}

RoundSettings settings_from(const Json& json) {
  RoundSettings settings{.job = json.at("job"),
                         .items = json.at("items"),
                         .chunk = std::max<std::size_t>(1, json.at("chunk")),
                         .beats = json.at("beats"),
                         .measures_nodes = json.at("measures_nodes"),
                         .scales_nodes = json.at("scales_nodes"),
                         .files = json.at("files"),
                         .command = json.at("command")};
  return settings;
}

std::string line_of(const Item& item) {
  Json json{{"folder", item.folder}, {"request", item.request}};
  if (!item.losses.empty()) json["losses"] = item.losses;
  return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

Item item_from(const Json& json) {
  return {json.at("folder"), json.at("request"), json.value("losses", std::vector<std::string>{})};
}

}  // namespace

std::string unique_name() {
  // Of the kernel, since machines with equal names and process ids exist (containers).
  std::string name = os::last_line(os::read_whole("/proc/sys/kernel/random/uuid"));
  std::erase(name, '-');
  name.resize(std::min<std::size_t>(name.size(), 16));
  return name;
}

Round::Round(const SharedFolder& folder, std::size_t number)
    : folder_(&folder), number_(number), path_(round_folder(number)) {
  const fs::path file = whole_path("round.json");
  const auto text = folder.read(path("round.json"));
  if (!text)
    throw Error(ErrorCode::kSetup, {file.string()}, "cannot be read.").about(file.string());
  settings_ = from_json(*text, file, settings_from);
}

fs::path Round::whole_path(const std::string& name) const {
  return folder_->root() / path(name);
}

std::size_t Round::shards() const {
  const std::size_t per_shard = settings_.chunk * kChunksPerShard;
  return (settings_.items + per_shard - 1) / per_shard;
}

std::size_t Round::chunks(std::size_t shard) const {
  const std::size_t all = (settings_.items + settings_.chunk - 1) / settings_.chunk;
  return std::min(kChunksPerShard, all - std::min(all, shard * kChunksPerShard));
}

std::size_t Round::first_item(const Chunk& chunk) const {
  return (chunk.shard * kChunksPerShard + chunk.index) * settings_.chunk;
}

std::size_t Round::end_item(const Chunk& chunk) const {
  return std::min(settings_.items, first_item(chunk) + settings_.chunk);
}

std::vector<Item> Round::items(std::size_t shard) const {
  const std::string name = "items/" + shard_name(shard);
  std::istringstream lines(folder_->read(path(name)).value_or(""));
  std::vector<Item> items;
  for (std::string line; std::getline(lines, line);)
    items.push_back(from_json(line, whole_path(name), item_from));
  const std::size_t begin = first_item({shard, 0}), end = first_item({shard + 1, 0});
  if (items.size() != std::min(end, settings_.items) - begin)
    throw Error(ErrorCode::kSetup, {whole_path(name).string()}, "cannot be read.")
        .about(whole_path(name).string());
  return items;
}

std::vector<std::size_t> Round::claimed_chunks(std::size_t shard) const {
  std::vector<std::size_t> chunks;
  for (const std::string& name : folder_->list(path("claims/" + shard_name(shard))))
    if (const auto number = number_of(name)) chunks.push_back(*number);
  return chunks;
}

fs::path Round::claim_file(const Chunk& chunk) const {
  return path("claims/" + shard_name(chunk.shard)) / fmt::format("{:02}", chunk.index);
}

std::optional<Round> newest_round(const SharedFolder& folder) {
  std::optional<std::size_t> newest;
  for (const std::string& name : folder.list(rounds_folder()))
    if (const auto number = number_of(name)) newest = std::max(newest.value_or(0), *number);
  if (!newest) return std::nullopt;
  return Round(folder, *newest);
}

std::optional<Round> create_round(const SharedFolder& folder, std::size_t number,
                                  RoundSettings settings, const std::vector<Item>& items) {
  settings.items = items.size();
  const std::string writer = unique_name();
  const fs::path part = rounds_folder() / ("." + writer);
  try {
    for (const char* name : {"items", "claims", "full", "workers", "lost", "logs"})
      folder.make(part / name);
    for (const char* name : {"nodes", "staging"}) folder.make(fs::path(kWorkersFolder) / name);
    const std::size_t per_shard = settings.chunk * kChunksPerShard;
    for (std::size_t begin = 0; begin < items.size(); begin += per_shard) {
      const std::string shard = shard_name(begin / per_shard);
      std::string lines;
      for (std::size_t i = begin; i < std::min(begin + per_shard, items.size()); ++i)
        lines += line_of(items[i]);
      folder.create(part / "items" / shard, lines);
      folder.make(part / "claims" / shard);
    }
    folder.create(part / "round.json", json_of(settings).dump(2) + "\n");
    if (folder.rename(part, round_folder(number))) return Round(folder, number);
  } catch (...) {
    folder.remove(part);
    throw;
  }
  folder.remove(part);
  return std::nullopt;
}

}  // namespace tether::workers
