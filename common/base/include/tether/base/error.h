#pragma once

#include <array>
#include <functional>
#include <span>
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

/// What a warning about a world, a UAV or a profile means for the simulation: mostly, that a part
/// of it is not represented.
enum class Consequence {
  kDoubtful,          ///< it may be a mistake: a start, a sensor's setting, how a flight ended
  kMissing,           ///< it is missing from the world
  kLooksDifferent,    ///< cameras see it differently
  kBehavesDifferent,  ///< it moves, collides or measures differently
  kNoEffect,          ///< it has no effect here
};
inline constexpr std::array kConsequences = {
    Consequence::kDoubtful, Consequence::kMissing, Consequence::kLooksDifferent,
    Consequence::kBehavesDifferent, Consequence::kNoEffect};
/// "doubtful", "missing", "looks_different", "behaves_differently", "no_effect".
std::string_view name(Consequence consequence);
/// Whether something with this consequence can usually change what a flight is found to do. Looks
/// usually cannot: lights and shadows that differ a little.
constexpr bool usually_changes_verdict(Consequence consequence) {
  return consequence != Consequence::kLooksDifferent && consequence != Consequence::kNoEffect;
}

/// Something that a file asks for and a simulation does not do, or does with a doubtful result.
struct Warning {
  Consequence consequence = Consequence::kNoEffect;
  FileLocation where;   ///< its file is empty if there is none
  std::string subject;  ///< "visual 'v'", "<script> of visual 'v'"
  std::string message;  ///< what is wrong with the subject, and what to do; follows it
  /// Whether a flight with it could be found to do something else than one without: the answer
  /// about a flight has to name it.
  bool can_change_verdict = usually_changes_verdict(consequence);

  friend bool operator==(const Warning&, const Warning&) = default;
};

using WarningSink = std::function<void(const Warning&)>;

/// A sink that passes each warning to `warn`, with unprintable characters replaced; empty if `warn`
/// is.
WarningSink printable_warnings(WarningSink warn);

/// "file:line: subject message": one line.
std::string to_line(const Warning& warning);

/// The warnings under one heading for each consequence, which has their number: several lines, each
/// with an end of line. Where a consequence has more than `most` warnings, kinds of subjects with
/// their numbers replace them ("12 plugin, 3 <script>").
std::string grouped(std::span<const Warning> warnings, std::size_t most);

}  // namespace tether
