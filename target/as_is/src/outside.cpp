#include "outside.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>

#include <sys/stat.h>
#include <sys/sysmacros.h>

namespace tether::as_is {
namespace {

/// Sockets that listen there, as /proc calls them: "socket:[INODE]".
std::set<std::string> listening(std::uint16_t port) {
  std::set<std::string> sockets;
  char at[8];
  std::snprintf(at, sizeof at, ":%04X", port);
  for (const char* table : {"/proc/net/tcp", "/proc/net/tcp6"}) {
    std::ifstream file(table);
    for (std::string line; std::getline(file, line);) {
      std::istringstream words(line);
      std::string number, local, remote, state, skipped, inode;
      words >> number >> local >> remote >> state;
      for (int i = 0; i < 5; ++i) words >> skipped;
      if (words >> inode && state == "0A" && local.ends_with(at))
        sockets.insert("socket:[" + inode + "]");
    }
  }
  return sockets;
}

bool has_any(pid_t process, const std::set<std::string>& sockets) {
  std::error_code none;
  for (const auto& entry :
       std::filesystem::directory_iterator("/proc/" + std::to_string(process) + "/fd", none))
    if (sockets.contains(std::filesystem::read_symlink(entry, none).string())) return true;
  return false;
}

}  // namespace

Who listens_at(std::uint16_t port, std::span<const pid_t> inside) {
  const std::set<std::string> sockets = listening(port);
  if (sockets.empty()) return Who::kNobody;
  if (std::ranges::any_of(inside, [&](pid_t process) { return has_any(process, sockets); }))
    return Who::kInside;
  // One of them may have closed it meanwhile.
  return listening(port) == sockets ? Who::kOutside : Who::kNobody;
}

// A line of the table: "1: FLOCK ADVISORY WRITE PROCESS MAJOR:MINOR:INODE START END", the device in
// hexadecimal digits. Of who waits, it has "->" behind the number.
Who has_locked(int fd, std::span<const pid_t> inside) {
  struct stat status {};
  if (::fstat(fd, &status) != 0) return Who::kNobody;
  char device[64];
  std::snprintf(device, sizeof device, "%02x:%02x:%ju", major(status.st_dev), minor(status.st_dev),
                static_cast<std::uintmax_t>(status.st_ino));
  std::ifstream file("/proc/locks");
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string number, kind, advice, access, file_of_lock;
    pid_t process = 0;
    words >> number >> kind;
    if (kind == "->" || !(words >> advice >> access >> process >> file_of_lock)) continue;
    if (file_of_lock != device) continue;
    return std::ranges::count(inside, process) > 0 ? Who::kInside : Who::kOutside;
  }
  return Who::kNobody;
}

}  // namespace tether::as_is
