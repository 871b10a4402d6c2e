#include "freezer.h"
#include "text_file.h"
#include "waiting.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>

#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <tether/os/file_descriptor.h>

// Finds the cgroup v2 of this process, makes one for the command below it, and stops the command
// with cgroup.freeze. The guardian removes the cgroup at the end.
namespace tether::supervisor {
namespace {

using os::FileDescriptor;

Failure no_cgroup(const std::string& why) {
  return {Failure::Kind::kInvalid, "cannot create a cgroup for the command: " + why};
}

/// Where a cgroup v2 file system is mounted, and which cgroup is its root there.
struct Mount {
  std::string point;
  std::string root;
};

/// One line of /proc/self/mountinfo: "ID PARENT DEV ROOT POINT OPTIONS … - TYPE SOURCE OPTIONS".
std::optional<Mount> parse_mount(const std::string& line) {
  const auto separator = line.find(" - cgroup2 ");
  if (separator == std::string::npos) return std::nullopt;
  std::istringstream fields(line);
  std::string skipped;
  Mount mount;
  fields >> skipped >> skipped >> skipped >> mount.root >> mount.point;
  return mount;
}

std::optional<Mount> find_mount() {
  std::ifstream file("/proc/self/mountinfo");
  for (std::string line; std::getline(file, line);) {
    if (auto mount = parse_mount(line)) return mount;
  }
  return std::nullopt;
}

/// The path of this process in the v2 hierarchy.
std::optional<std::string> own_cgroup() {
  std::ifstream file("/proc/self/cgroup");
  for (std::string line; std::getline(file, line);) {
    if (line.rfind("0::", 0) == 0) return line.substr(3);
  }
  return std::nullopt;
}

/// Folder of the cgroup `own` below the mount point; none if it is not visible there.
std::optional<std::string> folder_of(const Mount& mount, const std::string& own) {
  const std::string root = mount.root == "/" ? "" : mount.root;
  if (own.rfind(root, 0) != 0 || own.find("..") != std::string::npos) return std::nullopt;
  const std::string below = own.substr(root.size());
  return mount.point + (below == "/" ? "" : below);
}

class CgroupFreezer final : public Freezer {
 public:
  CgroupFreezer(FileDescriptor freeze, FileDescriptor events)
      : freeze_(std::move(freeze)), events_(std::move(events)) {}

  void add(pid_t /*group*/) override {}  // it has entered the cgroup itself
  void remove(pid_t /*group*/) override {}
  std::string name() const override { return "cgroup"; }
  Status freeze() override {
    if (const Status done = write_state('1'); !done) return done;
    // The kernel tells of changes at most every 10 ms; asking is faster.
    if (wait_until([this] { return is_frozen(); }, kLongestFreeze)) return ok_status();
    return Failure{Failure::Kind::kTimeout, "a thread of the command could not be stopped"};
  }
  void thaw() override { static_cast<void>(write_state('0')); }

 private:
  Status write_state(char state) {
    if (::pwrite(freeze_.get(), &state, 1, 0) == 1) return ok_status();
    return Failure{Failure::Kind::kTimeout,
                   std::string("cgroup.freeze cannot be written: ") + std::strerror(errno)};
  }
  bool is_frozen() {
    char text[256];
    const ssize_t size = ::pread(events_.get(), text, sizeof text, 0);
    if (size <= 0) return true;  // the cgroup is gone, and with it all that ran there
    return std::string_view(text, static_cast<std::size_t>(size)).find("frozen 1") !=
           std::string_view::npos;
  }

  FileDescriptor freeze_;
  FileDescriptor events_;
};

FileDescriptor open_file(const std::string& path, int flags) {
  return FileDescriptor(::open(path.c_str(), flags | O_CLOEXEC));
}

void kill_all(const std::string& cgroup) {
  if (write_file(cgroup + "/cgroup.kill", "1")) return;
  // Before Linux 5.14.
  std::ifstream processes(cgroup + "/cgroup.procs");
  for (pid_t process = 0; processes >> process;) ::kill(process, SIGKILL);
}

}  // namespace

Result<Cgroup> Cgroup::make() {
  const auto mount = find_mount();
  if (!mount) return no_cgroup("there is no cgroup v2 file system");
  const auto own = own_cgroup();
  const auto folder = own ? folder_of(*mount, *own) : std::nullopt;
  if (!folder) return no_cgroup("the cgroup of this process is not visible");
  // To move a process takes the right to do so in the cgroup above both, which is this one.
  if (::access((*folder + "/cgroup.procs").c_str(), W_OK) != 0) {
    return no_cgroup(*folder + "/cgroup.procs: " + std::strerror(errno));
  }
  Cgroup cgroup(*folder + "/tether-exec-" + std::to_string(::getpid()));
  if (::mkdir(cgroup.path_.c_str(), 0755) != 0) {
    return no_cgroup("mkdir " + cgroup.path_ + ": " + std::strerror(errno));
  }
  if (::access((cgroup.path_ + "/cgroup.freeze").c_str(), W_OK) == 0) return cgroup;
  const Failure failure = no_cgroup("the kernel has no cgroup.freeze (needs Linux 5.2 or later)");
  ::rmdir(cgroup.path_.c_str());
  return failure;
}

bool Cgroup::enter() const {
  return write_file(path_ + "/cgroup.procs", "0");
}

void remove_cgroup(const std::string& path) {
  wait_until(
      [&path] {
        if (::rmdir(path.c_str()) == 0 || errno == ENOENT) return true;
        kill_all(path);
        write_file(path + "/cgroup.freeze", "0");
        return false;
      },
      kLongestFreeze);
}

Result<std::unique_ptr<Freezer>> make_cgroup_freezer(const Cgroup& cgroup) {
  FileDescriptor freeze = open_file(cgroup.path() + "/cgroup.freeze", O_WRONLY);
  FileDescriptor events = open_file(cgroup.path() + "/cgroup.events", O_RDONLY);
  if (!freeze || !events) return no_cgroup(std::strerror(errno));
  return std::unique_ptr<Freezer>(
      std::make_unique<CgroupFreezer>(std::move(freeze), std::move(events)));
}

}  // namespace tether::supervisor
