#include <cerrno>

#include <fcntl.h>
#include <unistd.h>

#include <tether/base/error.h>
#include <tether/base/text.h>

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
  return code == ErrorCode::kUsage || code == ErrorCode::kBadFile ? 2 : 3;
}

std::string_view name(ErrorCode code) {
  return enum_name(code,
                   {"usage", "bad file", "set-up failed", "link lost", "hung", "internal error"});
}

}  // namespace tether
