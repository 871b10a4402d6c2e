#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <tether/base/time.h>
#include <tether/sim/file_cache.h>

/// Questions about paths. The answer is "no" also for what cannot be a path, such as a name that is
/// too long. While a Lookups lives, each of them is noted with its answer.
namespace tether::sim {

bool is_folder(const std::filesystem::path& path);
bool is_file(const std::filesystem::path& path);
bool is_there(const std::filesystem::path& path);
/// The paths in a folder, sorted; none: it cannot be read.
std::vector<std::filesystem::path> entries_of(const std::filesystem::path& folder);
/// As os::read_file.
std::string read_file(const std::filesystem::path& file, std::uintmax_t limit);
/// The file is read by somebody else.
void note_file(const std::filesystem::path& file);

/// What the file system answered while it lived, on this thread.
class Lookups {
 public:
  /// A file that was changed less than `tick` before it was asked about may change again and keep
  /// its times.
  explicit Lookups(Duration tick);
  ~Lookups();
  Lookups(const Lookups&) = delete;
  Lookups& operator=(const Lookups&) = delete;

  /// By path, and whether the entries of a folder matter.
  using Answers = std::map<std::pair<std::filesystem::path, bool>, FileState>;

  const Answers& answers() const { return answers_; }
  /// Whether a change since then shows in the answers. Not, if a file was too new, or a folder
  /// could not be read for lack of handles.
  bool are_certain() const { return are_certain_; }

 private:
  friend class LookupNote;
  Answers answers_;
  Duration tick_;
  bool are_certain_ = true;
  Lookups* outer_;
};

/// Whether the file system would answer the same now.
bool are_current(const Lookups::Answers& answers);

}  // namespace tether::sim
