#pragma once

#include "sampler.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include <tether/link/messages.h>
#include <tether/sync/clock_witness.h>

/// What a SUT may say, decided from what it has said so far. Pure: times are arguments.
namespace tether::coordinator {

/// Calls of a SUT between two steps of ST: a loop that waits for something, and takes no time or
/// next to none, would never end.
inline constexpr std::size_t kMaxCallsInAStep = 10'000;
/// Of one UAV: a latency of a second at a command every 15 us.
inline constexpr std::size_t kMaxWaitingCommands = 65'536;
/// Of one SUT's annotations in a run: two hours of 1 kB for each of 30 images a second.
inline constexpr std::size_t kMaxAnnotatedBytes = std::size_t{256} << 20;

/// How a SUT broke the protocol.
struct Fault {
  enum class Kind {
    kWrongMessage,   ///< a message that no SUT sends, or sends once only
    kTooEarly,       ///< a request before the Welcome
    kOutOfOrder,     ///< a request while it is held, after its Finish, or with a wrong number
    kTooMany,        ///< of open calls, of calls while ST stands, of commands, of annotations
    kStamp,          ///< a time that is out of range
    kAheadOfClock,   ///< a stamp beyond all that can have gone by
    kNotAvailable,   ///< something that its UAV or its run does not have
    kBadValue,       ///< a command that no multirotor can follow
    kImpossibleStop  ///< a stop that contradicts what it has said
  };
  Kind kind;
  std::string what;  ///< for a person: what it sent, after "the SUT … sent"
};

/// A SUT as far as it matters to what it may say next.
struct Standing {
  bool running = false;     ///< every SUT has joined
  bool tied = true;         ///< by the barrier; false: free running
  bool concurrent = false;  ///< it has several threads
  bool finished = false;    ///< its Finish has come
  bool held = false;        ///< it stands still for a reply of ours
  ExecTime bound;           ///< ET that it has reached; of a held one, of its reply
  std::size_t open_calls = 0;
  std::uint64_t next_sequence = 1;
  SimTime st;
  std::size_t calls_in_step = 0;  ///< while ST was what it is
  std::size_t waiting_commands = 0;
  const Sampler& sensors;
  const sync::ClockWitness* witness = nullptr;  ///< nullptr: its clock is not checked
  int clock_cores = 0;  ///< on so many at once its clock goes on; 0: no CPU clock
};

/// Whether a SUT's clock can have reached this. Sums of stamps and delays stay within int64.
bool is_stamp(ExecTime t);
/// Why it must not send this request, heard at `now`; none if it may.
std::optional<Fault> fault_of(const link::Request& request, const Standing& sut, WallTime now);
/// The same of progress, a stop among it. @pre running, tied, is_stamp(progress.reached).
std::optional<Fault> fault_of(const link::Progress& progress, const Standing& sut, WallTime now);
/// The same of a message that is neither Request, Progress nor Annotation.
Fault fault_of_other(const link::Message& message);

/// How much a SUT has annotated. A record is read whole when the run is judged.
class AnnotationBudget {
 public:
  std::optional<Fault> spend(const link::Annotation& note);

 private:
  std::size_t spent_bytes_ = 0;
};

}  // namespace tether::coordinator
