// An entry is a file: a header, its key, and from a multiple of 64 bytes on its content. It is
// written beside its place and renamed, and read by mapping it.

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <tuple>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <link.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <tether/base/error.h>
#include <tether/base/version.h>
#include <tether/os/file_descriptor.h>
#include <tether/os/text_file.h>
#include <tether/sim/file_cache.h>

namespace tether::sim {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kEntrySuffix = ".entry";
constexpr std::size_t kAlignment = 64;
constexpr std::size_t kMostParts = 16;

struct Header {
  std::array<char, 8> magic{'T', 'E', 'T', 'H', 'E', 'R', 'C', '1'};
  std::uint64_t checksum = 0;  // of all that follows, the key and the checked parts
  std::uint64_t key_bytes = 0;
  std::uint64_t checked = 0;
  std::uint64_t parts = 0;
  std::array<std::uint64_t, kMostParts> part_bytes{};
};

std::size_t aligned(std::size_t bytes) {
  return (bytes + kAlignment - 1) / kAlignment * kAlignment;
}

// FNV-1a by words of eight bytes; the last one is filled up with zeros.
std::uint64_t checksum(std::string_view bytes, std::uint64_t hash = 0xcbf29ce484222325U) {
  for (; !bytes.empty(); bytes.remove_prefix(std::min<std::size_t>(8, bytes.size()))) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data(), std::min<std::size_t>(8, bytes.size()));
    hash = (hash ^ word) * 0x100000001b3U;
    hash ^= hash >> 32U;
  }
  return hash;
}

std::uint64_t checksum_of(const Header& header, std::string_view key,
                          std::span<const std::string_view> parts) {
  const std::size_t own = offsetof(Header, key_bytes);
  const std::string_view bytes(reinterpret_cast<const char*>(&header), sizeof header);
  std::uint64_t hash = checksum(key, checksum(bytes.substr(own)));
  for (const std::string_view part : parts.first(header.checked)) hash = checksum(part, hash);
  return hash;
}

class Mapping {
 public:
  explicit Mapping(const fs::path& file) {
    const os::FileDescriptor fd(::open(file.c_str(), O_RDONLY | O_CLOEXEC));
    struct stat found {};
    if (!fd || ::fstat(fd.get(), &found) != 0 || !S_ISREG(found.st_mode) || found.st_size == 0)
      return;
    const auto size = static_cast<std::size_t>(found.st_size);
    void* const at = ::mmap(nullptr, size, PROT_READ, MAP_SHARED, fd.get(), 0);
    if (at != MAP_FAILED) bytes_ = {static_cast<const char*>(at), size};
  }
  ~Mapping() {
    if (!bytes_.empty()) ::munmap(const_cast<char*>(bytes_.data()), bytes_.size());
  }
  Mapping(const Mapping&) = delete;
  Mapping& operator=(const Mapping&) = delete;

  // Empty: the file is no entry of the key, or damaged.
  std::vector<std::string_view> parts_of(std::string_view key) const {
    Header header;
    if (bytes_.size() < sizeof header) return {};
    std::memcpy(&header, bytes_.data(), sizeof header);
    if (header.magic != Header().magic || header.key_bytes != key.size() ||
        header.parts > kMostParts || header.checked > header.parts ||
        bytes_.substr(sizeof header, key.size()) != key)
      return {};
    std::vector<std::string_view> parts;
    std::size_t at = aligned(sizeof header + key.size());
    for (std::size_t i = 0; i < header.parts; ++i) {
      const std::size_t size = header.part_bytes[i];
      if (at > bytes_.size() || size > bytes_.size() - at) return {};
      parts.push_back(bytes_.substr(at, size));
      at = aligned(at + size);
    }
    const bool is_whole = at == bytes_.size() && checksum_of(header, key, parts) == header.checksum;
    return is_whole ? parts : std::vector<std::string_view>();
  }

 private:
  std::string_view bytes_;
};

/// A folder's entries, and files that are being written or were left behind.
template <class Visit>
void for_each_file(const fs::path& folder, Visit visit) {
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string type = entry->path().extension();
    if (type == kEntrySuffix || type == os::kPartSuffix) visit(entry->path());
  }
}

// Each part begins at a multiple of the alignment. @return an error number; 0: none
int write_aligned(const fs::path& file, std::span<const std::string_view> parts) {
  constexpr std::array<char, kAlignment> kPadding{};
  std::string beside = file.string() + "-XXXXXX" + std::string(os::kPartSuffix);
  const os::FileDescriptor fd(
      ::mkostemps(beside.data(), static_cast<int>(os::kPartSuffix.size()), O_CLOEXEC));
  if (!fd) return errno;
  bool is_written = true;
  for (const std::string_view part : parts)
    is_written = is_written && os::write_all(fd, part) &&
                 os::write_all(fd, {kPadding.data(), aligned(part.size()) - part.size()});
  if (is_written && ::fsync(fd.get()) == 0 && ::rename(beside.c_str(), file.c_str()) == 0) return 0;
  const int reason = errno;
  ::unlink(beside.c_str());
  return reason;
}

std::int64_t nanoseconds(const timespec& time) {
  return std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
}

std::string variable(const char* name) {
  const char* const value = std::getenv(name);
  return value != nullptr ? value : "";
}

}  // namespace

std::optional<FileCache> FileCache::of_user() {
  if (const std::string own = variable("TETHER_CACHE"); !own.empty())
    return own == "off" ? std::nullopt : std::optional(FileCache(fs::absolute(own)));
  // What is not absolute is no folder of XDG's.
  if (const fs::path caches = variable("XDG_CACHE_HOME"); caches.is_absolute())
    return FileCache(caches / "tether");
  const fs::path home = variable("HOME");
  return home.is_absolute() ? std::optional(FileCache(home / ".cache/tether")) : std::nullopt;
}

fs::path FileCache::file_of(std::string_view key) const {
  return folder_ / (os::digest_of(key) + std::string(kEntrySuffix));
}

FileCache::Parts FileCache::find(std::string_view key) const {
  const fs::path file = file_of(key);
  struct Found {
    explicit Found(const fs::path& path) : mapping(path) {}
    Mapping mapping;
    std::vector<std::string_view> parts;
  };
  const auto found = std::make_shared<Found>(file);  // the parts refer to the mapping
  found->parts = found->mapping.parts_of(key);
  if (found->parts.empty()) return nullptr;
  ::utimensat(AT_FDCWD, file.c_str(), nullptr, 0);
  return {found, &found->parts};
}

void FileCache::keep(std::string_view key, std::span<const std::string_view> parts,
                     std::size_t checked) const {
  Header header;
  header.key_bytes = key.size();
  header.checked = checked;
  header.parts = parts.size();
  std::size_t bytes = aligned(sizeof header + key.size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    header.part_bytes[i] = parts[i].size();
    bytes += aligned(parts[i].size());
  }
  if (bytes > most_bytes_) return;
  header.checksum = checksum_of(header, key, parts);
  std::error_code ignored;
  fs::create_directories(folder_, ignored);
  const std::string head =
      std::string(reinterpret_cast<const char*>(&header), sizeof header) + std::string(key);
  std::vector<std::string_view> all{head};
  all.insert(all.end(), parts.begin(), parts.end());
  if (write_aligned(file_of(key), all) == 0) remove_oldest();
}

void FileCache::remove_oldest() const {
  std::vector<std::tuple<fs::file_time_type, fs::path, std::uintmax_t>> files;
  std::uintmax_t bytes = 0;
  for_each_file(folder_, [&](const fs::path& file) {
    std::error_code gone;
    const auto used = fs::last_write_time(file, gone);
    const std::uintmax_t size = gone ? 0 : fs::file_size(file, gone);
    if (gone) return;
    files.emplace_back(used, file, size);
    bytes += size;
  });
  std::sort(files.begin(), files.end());
  for (const auto& [used, file, size] : files) {
    if (bytes <= most_bytes_) return;
    std::error_code ignored;
    fs::remove(file, ignored);
    bytes -= size;
  }
}

FileCache::Size FileCache::size() const {
  Size size;
  for_each_file(folder_, [&](const fs::path& file) {
    std::error_code gone;
    const std::uintmax_t bytes = fs::file_size(file, gone);
    if (!gone) size = {size.entries + 1, size.bytes + bytes};
  });
  return size;
}

void FileCache::clear() const {
  for_each_file(folder_, [](const fs::path& file) {
    std::error_code error;
    fs::remove(file, error);
    if (error)
      throw Error(ErrorCode::kSetup, {file.string()}, "cannot be removed: " + error.message());
  });
}

void FileCache::require_writable() const {
  std::error_code error;
  fs::create_directories(folder_, error);
  const fs::path probe = folder_ / "probe";
  const std::string room(std::size_t{1} << 16U, '\0');
  const std::string_view part = room;
  const int reason = error ? error.value() : write_aligned(probe, {&part, 1});
  fs::remove(probe, error);
  if (reason != 0)
    throw Error(ErrorCode::kSetup, {folder_.string()}, "cannot be written: " + reason_of(reason));
}

FileState state_of(const fs::path& path, bool with_entries) {
  struct stat found {};
  if (::stat(path.c_str(), &found) != 0) return {};
  const std::int64_t kind = found.st_mode & S_IFMT;
  if (kind == S_IFDIR && !with_entries) return {kind};
  return {kind, static_cast<std::int64_t>(found.st_ino), found.st_size, nanoseconds(found.st_mtim),
          nanoseconds(found.st_ctim)};
}

bool is_older(const FileState& state, Duration age) {
  timespec now{};
  ::clock_gettime(CLOCK_REALTIME, &now);
  return state.back() < nanoseconds(now) - age.count();
}

const std::string& identity_of_program() {
  static const std::string identity = [] {
    std::string text(version());
    const auto add = [](dl_phdr_info* object, std::size_t, void* out) {
      // The program itself has no name.
      const char* const file = *object->dlpi_name != '\0' ? object->dlpi_name : "/proc/self/exe";
      // Without the time of its status, which links to it change.
      FileState state = state_of(file);
      state.back() = 0;
      for (const std::int64_t part : state)
        *static_cast<std::string*>(out) += ' ' + std::to_string(part);
      return 0;
    };
    ::dl_iterate_phdr(add, &text);
    return os::digest_of(text);
  }();
  return identity;
}

}  // namespace tether::sim
