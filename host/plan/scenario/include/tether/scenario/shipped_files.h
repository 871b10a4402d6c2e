#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tether::scenario {

/// The kinds of files that Tether ships.
enum class ShippedKind {
  kScenario,
  kCampaign,
  kMission,
  kWorld,
  kModel,
  kProfile,
  kEnergy,
  kTarget,
  kRig,
  kEngine
};
constexpr int kShippedKinds = 10;

/// "scenario", "energy file", ...
const char* to_text(ShippedKind kind);

struct ShippedFile {
  std::string name;         ///< of the file, without its extension; of a model's folder
  std::string description;  ///< one line: the key, or the beginning of the first comment
};

/// The files that Tether ships, found by name. Reads the folder at each call; thread-safe.
class ShippedFiles {
 public:
  /// @param data the folder that holds scenarios/, campaigns/, worlds/ and profiles/. If it does
  /// not exist, nothing is shipped.
  explicit ShippedFiles(std::filesystem::path data) : data_(std::move(data)) {}

  /// The files that belong to a program: share/tether beside bin/ where it is installed, or data/
  /// of the source tree that it is in.
  static ShippedFiles of_program(const std::filesystem::path& program);

  /// The folder that holds them.
  const std::filesystem::path& folder() const { return data_; }
  /// The folder of the models, for model:// (sim::WorldOptions).
  std::filesystem::path models() const { return data_ / "models"; }

  /// Sorted by name.
  /// @throws Error(kBadFile) if a file cannot be read.
  std::vector<ShippedFile> list(ShippedKind kind) const;

  bool has(ShippedKind kind, const std::string& name) const;
  /// The file of that name; it need not exist.
  std::filesystem::path file_of(ShippedKind kind, const std::string& name) const;

  /// What a command line can call the file in any folder: its name if it is shipped, else its path.
  /// @param file an absolute path
  std::string name_of(ShippedKind kind, const std::filesystem::path& file) const;

  /// What a file in `folder` means by `given`: nothing if it is a path, because there is such a
  /// file, or because it has a folder or an extension; else the shipped file of that name.
  /// @throws Error(kUsage), about `given`, with the nearest name, if there is neither; or if a file
  /// of the same kind in `folder` has that name and an extension, so that either may be meant.
  std::optional<std::filesystem::path> named(ShippedKind kind, const std::string& given,
                                             const std::filesystem::path& folder) const;

  /// The same for a command line, of which paths are returned as they are.
  std::filesystem::path find(ShippedKind kind, const std::string& given) const;

  /// "'room' is a shipped world. To use it, type: tether world check room."; empty: no file that is
  /// shipped has the name. `but`: what follows the kind.
  std::string what_is(const std::string& name, const std::string& but = "") const;

 private:
  std::string why_none(ShippedKind kind, const std::string& given,
                       const std::filesystem::path& folder) const;

  std::filesystem::path data_;
};

}  // namespace tether::scenario
