#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <system_error>

#include <fcntl.h>
#include <sys/sendfile.h>
#include <sys/stat.h>
#include <unistd.h>

#include <tether/base/error.h>
#include <tether/base/system_reason.h>
#include <tether/os/file_descriptor.h>
#include <tether/os/pipe.h>
#include <tether/workers/shared_folder.h>

namespace tether::workers {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, const std::string& what, int error) {
  throw Error(ErrorCode::kSetup, {path.string()}, what + ": " + reason_of(error) + ".")
      .about(path.string());
}

void write(const os::FileDescriptor& file, const fs::path& path, std::string_view text) {
  if (!os::write_all(file, text)) fail(path, "cannot be written", errno);
  if (::fsync(file.get()) != 0) fail(path, "cannot be flushed", errno);
}

}  // namespace

fs::path SharedFolder::path(const fs::path& relative) const {
  ++operations_;
  return root_ / relative;
}

bool SharedFolder::create(const fs::path& file, std::string_view text) const {
  const fs::path whole = path(file);
  const os::FileDescriptor own(
      ::open(whole.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
  if (!own && errno == EEXIST) return false;
  if (!own) fail(whole, "cannot be created", errno);
  // Closing it sends it to the server. Whoever reads claims can do without their text.
  if (!os::write_all(own, text)) fail(whole, "cannot be written", errno);
  return true;
}

void SharedFolder::replace(const fs::path& file, std::string_view text,
                           const std::string& writer) const {
  const fs::path part = path(file.string() + "." + writer), whole = path(file);
  {
    const os::FileDescriptor own(
        ::open(part.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
    if (!own) fail(part, "cannot be created", errno);
    ++operations_;
    write(own, part, text);
  }
  if (::rename(part.c_str(), whole.c_str()) != 0) fail(whole, "cannot be replaced", errno);
}

std::optional<std::string> SharedFolder::read(const fs::path& file) const {
  std::ifstream stream(path(file), std::ios::binary);
  if (!stream) return std::nullopt;
  return std::string{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

std::vector<std::string> SharedFolder::list(const fs::path& folder) const {
  const fs::path whole = path(folder);
  std::error_code failed;
  std::vector<std::string> names;
  fs::directory_iterator entry(whole, failed);
  for (; !failed && entry != fs::directory_iterator(); entry.increment(failed))
    names.push_back(entry->path().filename().string());
  if (failed && failed != std::errc::no_such_file_or_directory)
    fail(whole, "cannot be listed", failed.value());
  std::ranges::sort(names);
  return names;
}

void SharedFolder::make(const fs::path& folder) const {
  const fs::path whole = path(folder);
  std::error_code failed;
  fs::create_directories(whole, failed);
  if (failed) fail(whole, "cannot be made", failed.value());
}

bool SharedFolder::rename(const fs::path& from, const fs::path& to) const {
  const fs::path whole = path(to);
  if (::rename((root_ / from).c_str(), whole.c_str()) == 0) return true;
  if (errno == EEXIST || errno == ENOTEMPTY) return false;
  fail(whole, "cannot be renamed", errno);
}

void SharedFolder::remove(const fs::path& path_in_it) const {
  std::error_code ignored;
  fs::remove_all(path(path_in_it), ignored);
}

bool SharedFolder::publish(const fs::path& local, const fs::path& staging,
                           const fs::path& target) const try {
  const fs::path copy = path(staging);
  if (::mkdir(copy.c_str(), 0777) != 0) {
    if (errno != ENOENT) fail(copy, "cannot be made", errno);
    make(staging);  // the first of its worker
  }
  for (const auto& entry : fs::recursive_directory_iterator(local)) {
    const fs::path to = staging / entry.path().lexically_relative(local);
    if (entry.is_directory()) make(to);
    if (!entry.is_regular_file()) continue;
    const fs::path whole = path(to);
    const os::FileDescriptor from(::open(entry.path().c_str(), O_RDONLY | O_CLOEXEC));
    const os::FileDescriptor own(::open(whole.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666));
    if (!from || !own) fail(whole, "cannot be created", errno);
    constexpr std::size_t kAtOnce = 1 << 30;
    bool has_content = false;
    for (ssize_t copied = 1; copied > 0; has_content = has_content || copied > 0) {
      copied = ::sendfile(own.get(), from.get(), nullptr, kAtOnce);
      if (copied < 0) fail(whole, "cannot be written", errno);
    }
    if (!has_content) continue;
    ++operations_;
    if (::fsync(own.get()) != 0) fail(whole, "cannot be flushed", errno);
  }
  const fs::path whole = path(target);
  if (::rename(copy.c_str(), whole.c_str()) == 0) return true;
  if (errno == ENOENT) {
    make(target.parent_path());
    ++operations_;
    if (::rename(copy.c_str(), whole.c_str()) == 0) return true;
  }
  const int error = errno;
  remove(staging);
  if (error == EEXIST || error == ENOTEMPTY) return false;
  fail(whole, "cannot be renamed", error);
} catch (...) {
  remove(staging);
  throw;
}

}  // namespace tether::workers
