#include <cerrno>

#include <fcntl.h>
#include <unistd.h>

#include <tether/base/error.h>
#include <tether/base/system_reason.h>

namespace tether {

std::string located(const FileLocation& where, const std::string& message) {
  std::string text = where.file;
  if (where.line > 0) text.append(":").append(std::to_string(where.line));
  return text + ": " + message;
}

void require_a_handle_for(const std::string& file) {
  const int handle = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (handle >= 0) {
    ::close(handle);
  } else if (errno == EMFILE || errno == ENFILE) {
    throw Error(ErrorCode::kSetup, {file}, "cannot be opened: " + reason_of(errno));
  }
}

int exit_code(ErrorCode code) {
  switch (code) {
    case ErrorCode::kUsage:
    case ErrorCode::kBadFile:
      return 2;
    case ErrorCode::kSetup:
    case ErrorCode::kLinkLost:
    case ErrorCode::kHung:
    case ErrorCode::kInternal:
      return 3;
  }
  return 3;
}

std::string_view name(ErrorCode code) {
  switch (code) {
    case ErrorCode::kUsage:
      return "usage";
    case ErrorCode::kBadFile:
      return "bad file";
    case ErrorCode::kSetup:
      return "set-up failed";
    case ErrorCode::kLinkLost:
      return "link lost";
    case ErrorCode::kHung:
      return "hung";
    case ErrorCode::kInternal:
      return "internal error";
  }
  return "unknown";
}

}  // namespace tether
