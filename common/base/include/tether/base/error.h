#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

#include <tether/base/printable.h>

namespace tether {

/// What kind of thing went wrong; decides the exit code of the command line (DESIGN section 5).
enum class ErrorCode {
  kUsage,     ///< wrong option, or options that exclude each other (exit 2)
  kBadFile,   ///< a scenario, world, profile or record that cannot be used (exit 2)
  kSetup,     ///< the simulator, the link or a device could not be set up (exit 3)
  kLinkLost,  ///< a peer disconnected or sent what it must not (exit 3)
  kHung,      ///< a peer gave no word for longer than its limit (exit 3)
  kInternal,  ///< a broken invariant of Tether itself: a bug (exit 3)
};

/// Exit code of a program that ends with this error.
int exit_code(ErrorCode code);
std::string_view name(ErrorCode code);

/// A place in a file that a person wrote. `line` is 0 where there is none.
struct FileLocation {
  std::string file;
  int line = 0;
};

/// "file:line: message", or "file: message".
std::string located(const FileLocation& where, const std::string& message);

/// The one exception of host-side code. `what()` is one printable line, whatever a file or a peer
/// had in it: where (file:line), what is wrong, what to do.
class Error : public std::runtime_error {
 public:
  Error(ErrorCode code, const std::string& message)
      : std::runtime_error(printable(message)), code_(code) {}
  /// With the message `located`.
  Error(ErrorCode code, const FileLocation& where, const std::string& message);

  ErrorCode code() const { return code_; }

 private:
  ErrorCode code_;
};

/// For a file that could not be read: that this process may open no more files is not its fault.
/// @throws Error(kSetup) if so.
void require_a_handle_for(const std::string& file);

}  // namespace tether
