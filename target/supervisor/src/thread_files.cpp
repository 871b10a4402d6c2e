#include "thread_files.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

namespace tether::supervisor {
namespace {

os::FileDescriptor open_file(pid_t process, pid_t thread, const char* name) {
  const std::string path =
      "/proc/" + std::to_string(process) + "/task/" + std::to_string(thread) + "/" + name;
  return os::FileDescriptor(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
}

/// What a file has now, up to a size; false: its thread has ended.
template <std::size_t kSize>
bool read_again(const os::FileDescriptor& file, char (&text)[kSize]) {
  const ssize_t size = file ? ::pread(file.get(), text, kSize - 1, 0) : -1;
  text[size > 0 ? size : 0] = '\0';
  return size >= 0;
}

enum class State { kEnded, kWaits, kRuns };

State state_in(const os::FileDescriptor& stat) {
  char text[512];
  if (!read_again(stat, text)) return State::kEnded;
  const char* const after_name = std::strrchr(text, ')');
  if (after_name == nullptr || std::strchr("ZXx", after_name[2]) != nullptr) return State::kEnded;
  return std::strchr("StT", after_name[2]) != nullptr ? State::kWaits : State::kRuns;
}

bool has_threads(client::GroupPage& page, pid_t process, pid_t except = 0) {
  return std::ranges::any_of(page.threads(), [=](const client::GroupPage::Thread& thread) {
    return thread.process == process && thread.id != 0 && thread.id != except;
  });
}

/// A number of a file `stat`, counted as proc(5) does; 0: there is none.
long number_of(const os::FileDescriptor& stat, int field) {
  constexpr int kState = 3;
  char text[512];
  const char* rest = read_again(stat, text) ? std::strrchr(text, ')') : nullptr;
  if (rest != nullptr) rest = std::strchr(rest, ' ');
  for (int i = kState; rest != nullptr && i < field; ++i) rest = std::strchr(rest + 1, ' ');
  return rest == nullptr ? 0 : std::strtol(rest, nullptr, 10);
}

/// Whether threads of a process are left beside its first one, also if that has ended.
bool has_others(const os::FileDescriptor& stat) {
  constexpr int kThreads = 20;
  return number_of(stat, kThreads) > 1;
}

bool has_buried(const os::FileDescriptor& stat) {
  constexpr int kFaultsOfChildren = 11;
  return number_of(stat, kFaultsOfChildren) > 0;
}

/// Whether the kernel tells where that thread sleeps (`wchan`). It does not of one that is in the
/// queue of a core, whatever its state, nor of any if it was built without names.
bool sleeps_somewhere(const os::FileDescriptor& where) {
  char text[64];
  return read_again(where, text) && std::string_view(text) != "0";
}

/// How often this thread has given its core to others.
long switches() {
  rusage usage{};
  ::getrusage(RUSAGE_THREAD, &usage);
  return usage.ru_nvcsw + usage.ru_nivcsw;
}

}  // namespace

// If another thread had the core meanwhile, what was seen first may not be so any more.
bool ThreadFiles::are_all_waiting(client::GroupPage& page) {
  const long before = switches();
  if (!own_children_) own_children_ = open_file(::getpid(), ::getpid(), "children");
  if (!are_known_or_waiting(own_children_, page)) return false;
  for (auto& thread : page.threads()) {
    const pid_t id = thread.id, process = thread.process;
    if (id == client::GroupPage::kBegins) return false;
    if (id <= 0) continue;
    Files& files = files_[id];
    if (!files.stat) files.stat = open_file(process, id, "stat");
    const State state = state_in(files.stat);
    if (state == State::kRuns) return false;
    if (state == State::kWaits && may_bury_child(files, process, id)) return false;
    if (state == State::kEnded) {
      // The library has a thread that is not in the page. Who waits for the process wakes when that
      // has ended, too.
      if (!has_threads(page, process, id) && has_others(open_file(process, process, "stat")))
        return false;
      files_.erase(id);
      // The first thread of a process may end before the others. After the last one nobody waits,
      // also if its parent takes its time to notice.
      client::GroupPage::end_thread(&thread);
      if (!has_threads(page, process)) page.begin_again(process);
      continue;
    }
    if (!files.children) files.children = open_file(process, id, "children");
    if (!are_known_or_waiting(files.children, page)) return false;
  }
  // One in which a handler ran may be about to look, however it waits.
  const bool is_any_unseen = std::ranges::any_of(
      page.processes(), [](const auto& one) { return one.id > 0 && one.unseen > 0; });
  return !is_any_unseen && switches() == before;
}

// Who waits for a child is in state S also while the kernel buries the child. That takes long, and
// may lose the core. The process `except_` always sleeps.
bool ThreadFiles::may_bury_child(Files& files, pid_t process, pid_t id) const {
  if (!has_buried(files.stat)) return false;
  if (!files.where) files.where = open_file(process, id, "wchan");
  return !sleeps_somewhere(files.where) && sleeps_somewhere(open_file(except_, except_, "wchan"));
}

// One that is not in the page has just been started, or ignores preloaded libraries.
bool ThreadFiles::are_known_or_waiting(const os::FileDescriptor& children,
                                       client::GroupPage& page) const {
  char text[4096];
  if (!read_again(children, text)) return true;
  char* rest = text;
  for (long child = std::strtol(rest, &rest, 10); child > 0; child = std::strtol(rest, &rest, 10)) {
    const auto id = static_cast<pid_t>(child);
    if (id == except_ || page.has(id)) continue;
    if (state_in(open_file(id, id, "stat")) == State::kRuns) return false;
    page.enter(id);
  }
  return true;
}

}  // namespace tether::supervisor
