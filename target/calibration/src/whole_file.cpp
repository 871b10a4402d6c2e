#include <cerrno>
#include <cstring>
#include <filesystem>

#include <unistd.h>

#include <tether/base/error.h>
#include <tether/calibration/characterize.h>
#include <tether/os/text_file.h>

namespace tether::calibration {
namespace {

Failure refuse(const std::string& path, const std::string& why) {
  return invalid(path + ": cannot be written (" + why + ")");
}

}  // namespace

Status check_writable(const std::string& path) {
  std::error_code ignored;
  const auto status = std::filesystem::status(path, ignored);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    return refuse(path, "not a regular file");
  }
  const auto folder = std::filesystem::path(path).parent_path() / ".";
  if (::access(folder.c_str(), W_OK | X_OK) != 0) return refuse(path, std::strerror(errno));
  return ok_status();
}

Status write_whole(const std::string& path, std::string_view bytes) {
  if (Status writable = check_writable(path); !writable) return writable;
  try {
    os::write_file_atomically(path, bytes);
  } catch (const Error& error) {
    return refuse(path, error.what());
  }
  return ok_status();
}

}  // namespace tether::calibration
