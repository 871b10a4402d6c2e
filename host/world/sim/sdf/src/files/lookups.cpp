#include "files/lookups.h"

#include <algorithm>
#include <cerrno>
#include <utility>

#include <tether/os/text_file.h>

namespace tether::sim {

namespace fs = std::filesystem;

namespace {

thread_local Lookups* current = nullptr;

}  // namespace

class LookupNote {
 public:
  /// Before the question, so that a change between both shows later.
  static void add(const fs::path& path, bool is_listed = false) {
    if (current == nullptr) return;
    std::error_code ignored;
    const auto [known, is_new] =
        current->answers_.try_emplace({fs::absolute(path, ignored), is_listed});
    if (!is_new) return;
    known->second = state_of(path, is_listed);
    if (!is_older(known->second, current->tick_)) current->are_certain_ = false;
  }
  static void doubt() {
    if (current != nullptr) current->are_certain_ = false;
  }
};

Lookups::Lookups(Duration tick) : tick_(tick), outer_(std::exchange(current, this)) {}

Lookups::~Lookups() {
  current = outer_;
}

bool is_folder(const fs::path& path) {
  LookupNote::add(path);
  std::error_code ignored;
  return fs::is_directory(path, ignored);
}

bool is_file(const fs::path& path) {
  LookupNote::add(path);
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

bool is_there(const fs::path& path) {
  return is_file(path) || is_folder(path);
}

std::vector<fs::path> entries_of(const fs::path& folder) {
  LookupNote::add(folder, true);
  std::vector<fs::path> entries;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error))
    entries.push_back(entry->path());
  const int reason = error.value();
  if (reason != 0 && reason != ENOENT && reason != ENOTDIR && reason != EACCES) LookupNote::doubt();
  std::ranges::sort(entries);
  return entries;
}

std::string read_file(const fs::path& file, std::uintmax_t limit) {
  note_file(file);
  return os::read_file(file, limit);
}

void note_file(const fs::path& file) {
  LookupNote::add(file);
}

bool are_current(const Lookups::Answers& answers) {
  return std::ranges::all_of(answers, [](const auto& one) {
    const auto& [path, is_listed] = one.first;
    return state_of(path, is_listed) == one.second;
  });
}

}  // namespace tether::sim
