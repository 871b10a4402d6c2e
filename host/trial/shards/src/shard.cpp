#include <cerrno>
#include <charconv>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include <tether/base/error.h>
#include <tether/campaign/campaign_folder.h>
#include <tether/os/text_file.h>
#include <tether/shards/shard.h>

namespace tether::shards {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

bool read_number(std::string_view text, std::size_t& into) {
  const auto [end, failed] = std::from_chars(text.data(), text.data() + text.size(), into);
  return failed == std::errc{} && end == text.data() + text.size();
}

}  // namespace

Shard parse_shard(const std::string& text) {
  const std::size_t slash = text.find('/');
  Shard shard;
  const bool is_shard = slash != std::string::npos &&
                        read_number(std::string_view(text).substr(0, slash), shard.number) &&
                        read_number(std::string_view(text).substr(slash + 1), shard.of) &&
                        shard.number >= 1 && shard.number <= shard.of;
  if (is_shard) return shard;
  throw Error(ErrorCode::kUsage,
              fmt::format("--shard: '{}' is no part of a whole. Give K/N, as in 1/8 to 8/8.", text))
      .about("--shard");
}

// A trial's folder is SCENARIO/CONDITION/SEED.
std::vector<std::size_t> seed_numbers(const std::vector<TrialList::Trial>& trials) {
  std::map<fs::path, std::size_t> known;
  std::vector<std::size_t> numbers;
  for (const TrialList::Trial& trial : trials) {
    const fs::path seed = trial.folder.parent_path().parent_path() / trial.folder.filename();
    numbers.push_back(known.try_emplace(seed, known.size()).first->second);
  }
  return numbers;
}

std::string to_json(const TrialList& list) {
  Json json{{"files", list.files}, {"measures", list.measures}, {"trials", Json::array()}};
  for (const TrialList::Trial& trial : list.trials)
    json["trials"].push_back({{"folder", trial.folder.string()}, {"request", trial.request}});
  return json.dump(1) + "\n";
}

TrialList parse_trial_list(std::string_view text, const fs::path& file) try {
  const Json json = Json::parse(text);
  TrialList list{.files = json.at("files").get<std::map<std::string, std::string>>(),
                 .measures = json.at("measures").get<bool>()};
  for (const Json& trial : json.at("trials"))
    list.trials.push_back({.folder = trial.at("folder").get<std::string>(),
                           .request = trial.at("request").get<std::string>()});
  return list;
} catch (const nlohmann::json::exception&) {
  throw Error(ErrorCode::kBadFile, {file.string()},
              "is no list of trials as `tether campaign --engine` writes it.")
      .about(file.string());
}

std::map<std::string, std::string> digests_of(const std::vector<fs::path>& files) {
  std::map<std::string, std::string> digests;
  for (const fs::path& file : files)
    if (!digests.contains(file.string())) digests[file.string()] = os::digest_of_file(file);
  return digests;
}

void require_same_files(const std::map<std::string, std::string>& digests) {
  for (const auto& [file, digest] : digests) {
    const bool exists = fs::exists(file);
    if (exists && os::digest_of_file(file) == digest) continue;
    throw Error(ErrorCode::kBadFile, {file},
                std::string(exists ? "is not the file with which the campaign was started"
                                   : "does not exist on this machine") +
                    ". All machines need the same files at the same paths.")
        .about(file);
  }
}

void require_same_machine(const fs::path& campaign, const std::string& machine) {
  const fs::path file = campaign / campaign::kShardsFolder / "machine";
  {
    // With its text from the start, or not at all.
    const os::TemporaryFolder own("machine-", file.parent_path());
    os::write_file_atomically(own / "machine", machine);
    if (::link((own / "machine").c_str(), file.c_str()) != 0 && errno != EEXIST)
      throw Error(ErrorCode::kSetup, {file.string()}, "cannot be made: " + reason_of(errno) + ".")
          .about(file.string());
  }
  const std::string first = os::read_whole(file);
  if (first == machine) return;
  throw Error(ErrorCode::kBadFile, {file.string()},
              fmt::format("other flights of this campaign are measured on \"{}\", and this machine "
                          "is \"{}\": their times cannot be compared. Have the engine choose equal "
                          "machines, or fly a counted target.",
                          first, machine))
      .about("machine");
}

}  // namespace tether::shards
