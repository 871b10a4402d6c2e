#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include <tether/base/text.h>

namespace tether {

/// The kind of an error; determines the exit code of the program (docs/design.md section 5).
enum class ErrorCode {
  kUsage,     ///< wrong option, or options that exclude each other (exit 2)
  kBadFile,   ///< a scenario, world, profile or record that cannot be used (exit 2)
  kSetup,     ///< the simulator, the link or a device could not be set up (exit 3)
  kLinkLost,  ///< a peer disconnected or violated the protocol (exit 3)
  kHung,      ///< a peer sent no message within its time limit (exit 3)
  kInternal,  ///< a broken invariant of Tether itself: a bug (exit 3)
};

/// Exit code of a program that ends with this error.
int exit_code(ErrorCode code);
std::string_view name(ErrorCode code);

/// A place in a file that a user wrote. `line` counts from 1; 0 means no line.
struct FileLocation {
  std::string file;
  int line = 0;

  friend bool operator==(const FileLocation&, const FileLocation&) = default;
};

/// "file:line: message", or "file: message".
std::string located(const FileLocation& where, const std::string& message);

/// The exception that host-side code throws. `what()` is one printable line: where (FILE:LINE),
/// what is wrong, what to do. Code and tests use the fields, not the message.
class Error : public std::runtime_error {
 public:
  Error(ErrorCode code, const std::string& message)
      : std::runtime_error(printable(message)), code_(code) {}
  /// With the message `located`.
  Error(ErrorCode code, const FileLocation& where, const std::string& message)
      : Error(code, located(where, message)) {
    where_ = where;
  }

  /// The same error, with its subject.
  Error&& about(std::string subject) && {
    subject_ = std::move(subject);
    return std::move(*this);
  }

  ErrorCode code() const { return code_; }
  /// The place of the error; its file is empty if there is none.
  const FileLocation& where() const { return where_; }
  /// The key, option, name or address that the error is about; empty if there is no single one.
  const std::string& subject() const { return subject_; }

 private:
  ErrorCode code_;
  FileLocation where_;
  std::string subject_;
};

/// For a file that could not be read: checks whether the cause is the limit of open files of this
/// process. @throws Error(kSetup) if it is.
void require_a_handle_for(const std::string& file);

/// The system's text for `error_number` (an errno), with advice if the limit of open files is
/// reached. Thread-safe.
std::string reason_of(int error_number);

/// "signal 9 (Killed)". Not thread-safe.
std::string name_of_signal(int signal);

}  // namespace tether
