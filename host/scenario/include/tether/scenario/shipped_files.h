#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace tether::scenario {

/// The kinds of files that Tether ships.
enum class ShippedKind { kScenario, kCampaign, kWorld, kProfile, kTarget };

/// "scenario", ...
const char* to_text(ShippedKind kind);

struct ShippedFile {
  std::string name;         ///< of the file, without its extension
  std::string description;  ///< one line; of a world the beginning of its first comment
};

/// The files that Tether ships, found by name. Reads the folder at each call; thread-safe.
class ShippedFiles {
 public:
  /// @param data the folder that holds scenarios/, campaigns/, worlds/ and profiles/. If it does
  /// not exist, nothing is shipped.
  explicit ShippedFiles(std::filesystem::path data) : data_(std::move(data)) {}

  /// The files that belong to a program: share/tether beside bin/ where it is installed, or data/
  /// of the source tree in whose build/PRESET/bin it is.
  static ShippedFiles of_program(const std::filesystem::path& program);

  /// The folder that holds them.
  const std::filesystem::path& folder() const { return data_; }
  /// The folder of the models, for model:// (sim::WorldOptions).
  std::filesystem::path models() const { return data_ / "models"; }

  /// Sorted by name.
  /// @throws Error(kBadFile) if a file cannot be read.
  std::vector<ShippedFile> list(ShippedKind kind) const;

  /// What a command line means by `given`: a path, if there is such a file or if it looks like a
  /// path (it has a folder or an extension), else the shipped file of that name.
  /// @throws Error(kUsage), about `given`, with the nearest name, if there is neither.
  std::filesystem::path find(ShippedKind kind, const std::string& given) const;

 private:
  std::filesystem::path file_of(ShippedKind kind, const std::string& name) const;

  std::filesystem::path data_;
};

}  // namespace tether::scenario
