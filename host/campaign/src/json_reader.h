#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include <tether/base/time.h>

namespace tether::campaign {

using Json = nlohmann::ordered_json;

/// @throws Error(kBadFile) if the text is not a complete JSON document, or deeper than
/// kMaxJsonDepth.
Json parse_json(const std::string& text, const std::filesystem::path& file);

/// One object of a JSON file that Tether wrote, read with full checking: every function throws
/// Error(kBadFile) about the member if that is missing or of another type. A view: the document
/// must outlive it.
class JsonReader {
 public:
  JsonReader(const Json& object, std::filesystem::path file);

  bool has(std::string_view key) const;
  const Json& member(std::string_view key) const;
  std::string text(std::string_view key) const;
  bool boolean(std::string_view key) const;
  double number(std::string_view key) const;
  std::uint64_t count(std::string_view key) const;
  Duration seconds(std::string_view key) const;
  JsonReader object(std::string_view key) const;
  std::vector<JsonReader> objects(std::string_view key) const;
  std::vector<std::string> texts(std::string_view key) const;
  std::vector<std::uint64_t> counts(std::string_view key) const;
  std::vector<double> numbers(std::string_view key) const;
  /// Every member; each must be a string.
  std::map<std::string, std::string> all_texts() const;

  /// Checks the member "schema".
  void require_schema(int newest) const;
  /// Throws the error about the member `key`.
  [[noreturn]] void fail(std::string_view key, const std::string& problem) const;

 private:
  using IsType = bool (Json::*)() const;
  const Json& member(std::string_view key, IsType is_type, std::string_view type) const;
  template <class T>
  std::vector<T> elements(std::string_view key, IsType is_type, std::string_view type) const;

  const Json* object_;
  std::filesystem::path file_;
};

}  // namespace tether::campaign
