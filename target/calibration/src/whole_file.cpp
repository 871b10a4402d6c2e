#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <optional>

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <tether/calibration/whole_file.h>

namespace tether::calibration {
namespace {

/// An interrupt that would leave the temporary file behind comes to nothing.
class IgnoreInterrupts {
 public:
  IgnoreInterrupts() : on_int_(signal(SIGINT, SIG_IGN)), on_term_(signal(SIGTERM, SIG_IGN)) {}
  ~IgnoreInterrupts() {
    signal(SIGINT, on_int_);
    signal(SIGTERM, on_term_);
  }
  IgnoreInterrupts(const IgnoreInterrupts&) = delete;
  IgnoreInterrupts& operator=(const IgnoreInterrupts&) = delete;

 private:
  sighandler_t on_int_;
  sighandler_t on_term_;
};

Failure failed(const std::string& path, int error) {
  return {Failure::Kind::kInvalid, path + ": cannot be written: " + std::strerror(error)};
}

/// A new file beside `path`, removed again unless it has become `path`.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& path)
      : path_(path + ".partial-" + std::to_string(getpid())),
        descriptor_(open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666)) {}
  ~TemporaryFile() {
    if (descriptor_ >= 0) {
      close(descriptor_);
      unlink(path_.c_str());
    }
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  bool is_open() const { return descriptor_ >= 0; }

  /// False: see errno.
  bool write_all(std::string_view bytes) {
    while (!bytes.empty()) {
      const ssize_t written = write(descriptor_, bytes.data(), bytes.size());
      if (written < 0 && errno != EINTR) {
        return false;
      }
      bytes.remove_prefix(written > 0 ? static_cast<std::size_t>(written) : 0);
    }
    return fsync(descriptor_) == 0;
  }
  bool become(const std::string& path) {
    if (std::rename(path_.c_str(), path.c_str()) != 0) {
      return false;
    }
    close(descriptor_);
    descriptor_ = -1;
    return true;
  }

 private:
  std::string path_;
  int descriptor_;
};

/// What is there already can be replaced.
Status check_target(const std::string& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    return Failure{Failure::Kind::kInvalid, path + ": is no regular file"};
  }
  return ok_status();
}

}  // namespace

Status check_writable(const std::string& path) {
  if (Status target = check_target(path); !target) {
    return target;
  }
  const IgnoreInterrupts guard;
  const TemporaryFile file(path);
  return file.is_open() ? ok_status() : Status(failed(path, errno));
}

Status write_whole(const std::string& path, std::string_view bytes) {
  if (Status target = check_target(path); !target) {
    return target;
  }
  const IgnoreInterrupts guard;
  TemporaryFile file(path);
  if (!file.is_open() || !file.write_all(bytes) || !file.become(path)) {
    return failed(path, errno);
  }
  return ok_status();
}

}  // namespace tether::calibration
