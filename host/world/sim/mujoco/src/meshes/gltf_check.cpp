#include "meshes/gltf_check.h"

#include <algorithm>
#include <array>
#include <string>

#include <nlohmann/json.hpp>

#include <tether/base/error.h>

namespace tether::sim {
namespace {

using Json = nlohmann::json;

constexpr int kMaxJsonDepth = 64;
constexpr std::array<std::string_view, 4> kSizes = {"byteLength", "byteOffset", "byteStride",
                                                    "count"};

[[noreturn]] void refuse_gltf(const std::filesystem::path& file, const std::string& what) {
  throw Error(ErrorCode::kBadFile, FileLocation{file.string()}, what);
}

std::uint32_t word_at(std::string_view bytes, std::size_t at) {
  std::uint32_t word = 0;
  for (std::size_t i = 0; i < 4; ++i)
    word |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at + i])) << (8 * i);
  return word;
}

// Of a binary file, its first chunk.
std::string_view json_of(std::string_view content, const std::filesystem::path& file) {
  constexpr std::size_t kHead = 20;
  if (!content.starts_with("glTF")) return content;
  if (content.size() < kHead || word_at(content, 12) > content.size() - kHead)
    refuse_gltf(file, "is cut off in its first chunk");
  return content.substr(kHead, word_at(content, 12));
}

bool is_size(const std::string& key) {
  return std::ranges::find(kSizes, key) != kSizes.end();
}

}  // namespace

void check_gltf(std::string_view content, std::uintmax_t most_bytes,
                const std::filesystem::path& file) {
  std::string too_large;
  std::string key;
  const auto look = [&](int depth, Json::parse_event_t event, Json& value) {
    if (depth > kMaxJsonDepth) refuse_gltf(file, "has JSON that is nested deeper than 64");
    if (event == Json::parse_event_t::key) key = value.get<std::string>();
    const bool is_wrong = event == Json::parse_event_t::value && is_size(key) &&
                          (!value.is_number_unsigned() || value.get<std::uint64_t>() > most_bytes);
    if (is_wrong) too_large = key + " " + value.dump();
    return true;
  };
  const std::string_view json = json_of(content, file);
  const Json parsed = Json::parse(json.begin(), json.end(), look, false);
  if (parsed.is_discarded() || !parsed.is_object()) refuse_gltf(file, "is not glTF's JSON");
  if (!too_large.empty())
    refuse_gltf(file, "has the impossible " + too_large + "; the file has not that much");
}

}  // namespace tether::sim
