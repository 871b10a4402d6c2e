// Whole files: replaced by way of a file beside them, read with a limit, and their digests, which
// are remembered for as long as the file system shows that a file did not change.

#include <algorithm>
#include <cerrno>
#include <cinttypes>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <iterator>
#include <map>
#include <mutex>
#include <optional>
#include <sstream>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <tether/base/error.h>
#include <tether/base/text.h>
#include <tether/os/file_descriptor.h>
#include <tether/os/text_file.h>

namespace tether::os {
namespace {

[[noreturn]] void fail(const std::filesystem::path& file, const char* what) {
  throw Error(ErrorCode::kSetup, FileLocation{file.string()},
              std::string("cannot be ") + what + ": " + reason_of(errno));
}

bool is_special(const std::filesystem::path& file) {
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::status(file, ignored);
  return std::filesystem::exists(status) && !std::filesystem::is_regular_file(status);
}

void write_to_special(const std::filesystem::path& file, std::string_view text) {
  const FileDescriptor fd(::open(file.c_str(), O_WRONLY | O_CLOEXEC));
  if (!fd) fail(file, "opened");
  if (!write_all(fd, text)) fail(file, "written");
}

// The file behind the symbolic links, which need not exist.
std::filesystem::path behind_links(std::filesystem::path file) {
  constexpr int kMostLinks = 40;  // as Linux follows
  std::error_code ignored;
  for (int i = 0; std::filesystem::is_symlink(file, ignored); ++i) {
    if (i == kMostLinks) {
      errno = ELOOP;
      fail(file, "followed");
    }
    file = file.parent_path() / std::filesystem::read_symlink(file, ignored);
  }
  return file;
}

/// Errors name `file`, which is to be replaced by `beside`.
void write_and_flush(const std::filesystem::path& beside, const std::filesystem::path& file,
                     std::string_view text) {
  const FileDescriptor fd(::open(beside.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644));
  if (!fd) fail(file, "created");
  if (!write_all(fd, text)) fail(file, "written");
  if (::fsync(fd.get()) != 0) fail(file, "flushed to the disk");
}

std::string stripped(const std::string& line) {
  const auto begin = line.find_first_not_of(" \t\r");
  const auto end = line.find_last_not_of(" \t\r");
  return begin == std::string::npos ? "" : line.substr(begin, end - begin + 1);
}

/// The nearest name in the folder of a path; empty if there is none.
std::string neighbour_like(const std::filesystem::path& path) {
  constexpr std::size_t kMostNeighbours = 1000;
  std::error_code failed;
  std::vector<std::string> names;
  const auto folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
  for (std::filesystem::directory_iterator entry(folder, failed), end;
       !failed && entry != end && names.size() < kMostNeighbours; entry.increment(failed))
    names.push_back(entry->path().filename());
  std::sort(names.begin(), names.end());
  const std::vector<std::string_view> candidates(names.begin(), names.end());
  return std::string(nearest(path.filename().native(), candidates));
}

}  // namespace

std::string file_name_of(std::string_view name) {
  std::string part(name);
  for (char& c : part) c = c == '/' || static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? '_' : c;
  return part;
}

void write_file_atomically(const std::filesystem::path& path, std::string_view text) {
  if (is_special(path)) return write_to_special(path, text);
  const std::filesystem::path file = behind_links(path);
  const std::filesystem::path beside = file.string() + std::string(kPartSuffix);
  try {
    write_and_flush(beside, file, text);
    if (::rename(beside.c_str(), file.c_str()) != 0) fail(file, "replaced");
  } catch (...) {
    ::unlink(beside.c_str());
    throw;
  }
  // The rename itself is on the disk once the folder is.
  const FileDescriptor folder(
      ::open((file.parent_path() / ".").c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (folder) ::fsync(folder.get());
}

std::string why_no_file(const std::filesystem::path& path) {
  std::error_code failed;
  if (std::filesystem::is_directory(path, failed)) return "it is a folder, not a file";
  if (std::filesystem::exists(path, failed)) return "it is not a regular file";
  if (failed) return "it cannot be reached: " + failed.message();
  // The first part of the path that is missing.
  std::filesystem::path missing = path;
  while (missing.has_parent_path() && missing.has_relative_path() &&
         !std::filesystem::exists(missing.parent_path(), failed))
    missing = missing.parent_path();
  const std::string near = neighbour_like(missing);
  return (missing == path ? "there is no such file"
                          : "there is no folder '" + missing.string() + "'") +
         (near.empty() ? "" : "; did you mean '" + near + "'?");
}

std::string read_file(const std::filesystem::path& file, std::uintmax_t limit) {
  const auto fail_with = [&](const std::string& what) {
    throw Error(ErrorCode::kBadFile, FileLocation{file.string()}, what);
  };
  std::error_code failed;
  if (!std::filesystem::is_regular_file(file, failed)) fail_with(why_no_file(file));
  errno = 0;
  const std::uintmax_t size = std::filesystem::file_size(file, failed);
  if (!failed && size > limit) {
    fail_with("is " + std::to_string(size) + " bytes long; at most " + std::to_string(limit) +
              " are read");
  }
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  if (size > 0) text << stream.rdbuf();
  if (failed || !stream || !text) {
    require_a_handle_for(file.string());
    fail_with("cannot be read: " + (failed ? failed.message() : reason_of(errno)));
  }
  return std::move(text).str();
}

std::string begin_of(const std::filesystem::path& file, std::size_t most_bytes) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) return "";
  std::string begin(most_bytes, '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(begin.data(), std::ssize(begin));
  begin.resize(static_cast<std::size_t>(stream.gcount()));
  return begin;
}

std::string read_whole(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

std::string last_line(const std::string& text) {
  std::istringstream lines(text);
  std::string last;
  for (std::string line; std::getline(lines, line);)
    if (const std::string words = stripped(line); !words.empty()) last = words;
  return last;
}

namespace {

// What changes with a file's content.
using Version = std::tuple<dev_t, ino_t, off_t, std::int64_t, std::int64_t>;

constexpr std::int64_t kNanoseconds = 1'000'000'000;

std::int64_t nanoseconds(const timespec& time) {
  return time.tv_sec * kNanoseconds + time.tv_nsec;
}

std::optional<Version> version_of(const std::filesystem::path& file) {
  struct stat found {};
  if (stat(file.c_str(), &found) != 0) return std::nullopt;
  return Version{found.st_dev, found.st_ino, found.st_size, nanoseconds(found.st_mtim),
                 nanoseconds(found.st_ctim)};
}

// A file that changed within the last tick of its file system's clock can change again without
// another time.
bool is_settled(const Version& version) {
  constexpr std::int64_t kCoarsestTick = 2 * kNanoseconds;
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  return std::get<4>(version) < nanoseconds(now) - kCoarsestTick;
}

struct Digests {
  std::mutex mutex;
  std::map<std::filesystem::path, std::pair<Version, std::string>> known;
};
Digests& digests() {
  static Digests all;
  return all;
}

}  // namespace

std::string digest_of(std::string_view text) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  char digits[17];
  std::snprintf(digits, sizeof digits, "%016" PRIx64, hash);
  return digits;
}

std::string digest_of_file(const std::filesystem::path& file) {
  const std::optional<Version> version = version_of(file);
  if (version) {
    const std::lock_guard lock(digests().mutex);
    const auto found = digests().known.find(file);
    if (found != digests().known.end() && found->second.first == version)
      return found->second.second;
  }
  std::string digest = digest_of(read_file(file));
  if (version && is_settled(*version)) {
    const std::lock_guard lock(digests().mutex);
    digests().known[file] = {*version, digest};
  }
  return digest;
}

}  // namespace tether::os
