// An entry is a file: a header, its key, and from a multiple of 64 bytes on its content. It is
// written beside its place and renamed, and read by mapping it.

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
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

struct Header {
  std::array<char, 8> magic{'T', 'E', 'T', 'H', 'E', 'R', 'C', '1'};
  std::uint64_t key_bytes = 0;
  std::uint64_t bytes = 0;
  std::uint64_t checked_bytes = 0;
  std::uint64_t checksum = 0;  // of the key and what is checked

  std::size_t content_at() const { return (sizeof(Header) + key_bytes + 63) / 64 * 64; }
};

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

  // None: the file is no entry of the key, or damaged.
  std::optional<std::string_view> content_of(std::string_view key) const {
    Header header;
    if (bytes_.size() < sizeof header) return std::nullopt;
    std::memcpy(&header, bytes_.data(), sizeof header);
    if (header.magic != Header().magic || header.key_bytes != key.size() ||
        bytes_.size() < header.content_at() || header.checked_bytes > header.bytes ||
        bytes_.size() - header.content_at() != header.bytes ||
        bytes_.substr(sizeof header, key.size()) != key)
      return std::nullopt;
    const std::string_view content = bytes_.substr(header.content_at());
    if (checksum(content.substr(0, header.checked_bytes), checksum(key)) != header.checksum)
      return std::nullopt;
    return content;
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

// @return an error number; 0: none
int write_entry(const fs::path& file, std::initializer_list<std::string_view> head,
                std::span<const std::string_view> parts) {
  std::string beside = file.string() + "-XXXXXX" + std::string(os::kPartSuffix);
  const os::FileDescriptor fd(
      ::mkostemps(beside.data(), static_cast<int>(os::kPartSuffix.size()), O_CLOEXEC));
  if (!fd) return errno;
  bool is_written = true;
  for (const std::string_view part : head) is_written = is_written && os::write_all(fd, part);
  for (const std::string_view part : parts) is_written = is_written && os::write_all(fd, part);
  if (is_written && ::fsync(fd.get()) == 0 && ::rename(beside.c_str(), file.c_str()) == 0) return 0;
  const int reason = errno;
  ::unlink(beside.c_str());
  return reason;
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

FileCache::Content FileCache::find(std::string_view key) const {
  const fs::path file = file_of(key);
  struct Found {
    explicit Found(const fs::path& path) : mapping(path) {}
    Mapping mapping;
    std::string_view content;
  };
  const auto found = std::make_shared<Found>(file);
  const auto content = found->mapping.content_of(key);
  if (!content) return nullptr;
  found->content = *content;
  ::utimensat(AT_FDCWD, file.c_str(), nullptr, 0);
  return {found, &found->content};
}

void FileCache::keep(std::string_view key, std::span<const std::string_view> parts,
                     std::size_t checked) const {
  Header header;
  header.key_bytes = key.size();
  header.checksum = checksum(key);
  std::string checked_text;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    header.bytes += parts[i].size();
    if (i < checked) checked_text += parts[i];
  }
  header.checked_bytes = checked_text.size();
  header.checksum = checksum(checked_text, header.checksum);
  const std::string padding(header.content_at() - sizeof header - key.size(), '\0');
  if (header.content_at() + header.bytes > most_bytes_) return;
  std::error_code ignored;
  fs::create_directories(folder_, ignored);
  const std::string_view head(reinterpret_cast<const char*>(&header), sizeof header);
  if (write_entry(file_of(key), {head, key, padding}, parts) == 0) remove_oldest();
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
  const int reason = error ? error.value() : write_entry(probe, {}, {});
  fs::remove(probe, error);
  if (reason != 0)
    throw Error(ErrorCode::kSetup, {folder_.string()}, "cannot be written: " + reason_of(reason));
}

const std::string& identity_of_program() {
  static const std::string identity = [] {
    std::string text(version());
    const auto add = [](dl_phdr_info* object, std::size_t, void* out) {
      // The program itself has no name.
      const char* const file = *object->dlpi_name != '\0' ? object->dlpi_name : "/proc/self/exe";
      struct stat found {};
      if (::stat(file, &found) != 0) return 0;
      *static_cast<std::string*>(out) +=
          ' ' + std::to_string(found.st_ino) + '/' + std::to_string(found.st_size) + '/' +
          std::to_string(found.st_mtim.tv_sec) + '.' + std::to_string(found.st_mtim.tv_nsec);
      return 0;
    };
    ::dl_iterate_phdr(add, &text);
    return os::digest_of(text);
  }();
  return identity;
}

}  // namespace tether::sim
