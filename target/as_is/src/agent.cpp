#include "agent.h"

#include "clocks.h"
#include "real.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <set>
#include <string>
#include <thread>
#include <utility>

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <tether/link/messages.h>
#include <tether/os/clock.h>

namespace tether::as_is {
namespace {

// How long a thread waits in real time before it looks again whether all others wait, first and
// later. Whoever begins to wait last looks by itself; only waits that are not seen need this.
constexpr Duration kFirstSlice = std::chrono::milliseconds(1);
constexpr Duration kLongestSlice = std::chrono::milliseconds(4);
constexpr Duration kShortestSlice = std::chrono::microseconds(20);
// Of a wait without a deadline; then it begins again.
constexpr Duration kForEver = std::chrono::hours(1);

void say(const std::string& line) {
  std::fprintf(stderr, "tether: %s\n", line.c_str());
}

/// The eventfd that wakes the calling thread, with nothing in it.
int wake_of_thread() {
  struct Descriptor {
    int fd = ::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
    Descriptor() = default;
    ~Descriptor() { TETHER_REAL(close)(fd); }
  };
  thread_local const Descriptor kDescriptor;
  std::uint64_t count = 0;
  static_cast<void>(TETHER_REAL(read)(kDescriptor.fd, &count, sizeof count));
  return kDescriptor.fd;
}

/// The program's own name: the last part of its path.
std::string program_name() {
  char path[4096];
  const ssize_t size = ::readlink("/proc/self/exe", path, sizeof path - 1);
  const std::string whole(path, size > 0 ? static_cast<std::size_t>(size) : 0);
  return whole.substr(whole.rfind('/') + 1);
}

}  // namespace

thread_local int Inside::depth_ = 0;
std::atomic<Agent*> Agent::instance_ = nullptr;

void Agent::start() {
  const Inside inside;
  auto options = client::options_from_environment();
  if (!options) return say(options.failure().message + "; the program runs by itself");
  options->sut_name = program_name();
  client::TimeSource* const source = options->time.get();
  auto vehicle = client::connect(std::move(*options));
  if (!vehicle) {
    say(vehicle.failure().message);
    ::_exit(3);
  }
  instance_.store(new Agent(std::move(*vehicle), *source), std::memory_order_release);
}

// The run is over, or cannot go on: so is the program. It says nothing that the coordinator does
// not know.
void Agent::end(const Failure& failure) {
  if (failure.kind != Failure::Kind::kRunEnded) say(failure.message);
  instance_.store(nullptr);
  TETHER_REAL(_exit)(failure.kind == Failure::Kind::kRunEnded ? 0 : 3);
  std::abort();
}

bool Agent::receive_until(std::optional<ExecTime> until) {
  const Duration timeout = until ? std::max(Duration(0), *until - now()) : kForEver;
  auto message = vehicle_->receive(timeout);
  if (message) {
    if (message->from == link::kAutopilot) port_.deliver(message->bytes);
    return true;
  }
  if (message.failure().kind != Failure::Kind::kNothingYet) end(message.failure());
  return false;
}

void Agent::take_arrived() {
  const std::lock_guard leading(leading_);
  while (receive_until(now())) {
  }
}

bool Agent::send(std::span<const std::uint8_t> bytes) {
  const std::lock_guard leading(leading_);
  const Status sent = vehicle_->send(link::kAutopilot, bytes);
  if (sent) return true;
  if (sent.failure().kind != Failure::Kind::kInvalid) end(sent.failure());
  return false;
}

/// What the calling thread computes while it lives is not the program's, but for calls of the
/// vehicle, in which the clock stands anyway.
class Agent::Unpaid {
 public:
  explicit Unpaid(client::TimeSource& source) : source_(&source) { go_on(); }
  ~Unpaid() { pause(); }
  Unpaid(const Unpaid&) = delete;
  Unpaid& operator=(const Unpaid&) = delete;

  void go_on() { since_ = os::read_clock(CLOCK_THREAD_CPUTIME_ID); }
  void pause() { source_->leave_out(os::read_clock(CLOCK_THREAD_CPUTIME_ID) - since_); }

 private:
  client::TimeSource* source_;
  Duration since_{0};
};

// Until the deadline, if another thread computes all that time.
Duration Agent::slice(std::optional<ExecTime> deadline, int looks) const {
  const Duration longest = looks == 0 ? kFirstSlice : kLongestSlice;
  if (!deadline) return longest;
  const auto left = static_cast<std::int64_t>(static_cast<double>((*deadline - now()).count()) /
                                              std::max(1.0, factor_));
  return std::clamp(Duration(left), kShortestSlice, longest);
}

// Whether ET went on, or a message came. Nobody may be past its deadline: that one runs first.
bool Agent::lead(Unpaid& unpaid) {
  const std::unique_lock leading(leading_, std::try_to_lock);
  if (!leading || !threads_.are_others_waiting()) return false;
  std::optional<ExecTime> earliest;
  bool is_empty = true;
  {
    const std::lock_guard lock(waits_mutex_);
    is_empty = waits_.empty();
    for (const auto& [deadline, wake] : waits_)
      if (deadline) earliest = std::min(earliest.value_or(*deadline), *deadline);
  }
  if (is_empty || (earliest && *earliest <= now())) return false;
  unpaid.pause();
  receive_until(earliest);
  unpaid.go_on();
  wake_due();
  return true;
}

void Agent::wake_due() {
  constexpr std::uint64_t kOnce = 1;
  const std::lock_guard lock(waits_mutex_);
  for (const auto& [deadline, wake] : waits_)
    if (deadline && *deadline <= now())
      static_cast<void>(TETHER_REAL(write)(wake, &kOnce, sizeof kOnce));
}

std::list<Agent::Wait>::iterator Agent::enter(std::optional<ExecTime> deadline) {
  const int wake = wake_of_thread();
  const std::lock_guard lock(waits_mutex_);
  return waits_.insert(waits_.end(), {deadline, wake});
}

void Agent::leave(std::list<Wait>::iterator wait) {
  const std::lock_guard lock(waits_mutex_);
  waits_.erase(wait);
}

bool Agent::wait(std::optional<ExecTime> deadline, const std::function<bool()>& is_ready,
                 const Block& block) {
  Unpaid unpaid(*source_);
  const auto own = enter(deadline);
  bool ready = false;
  for (int looks = 0; !(ready = is_ready()) && !(deadline && now() >= *deadline);)
    if (!lead(unpaid)) block(slice(deadline, looks++), own->wake);
  leave(own);
  return ready;
}

bool Agent::wait_for_thread(ExecTime deadline, const std::function<bool(Duration)>& block) {
  constexpr std::uint64_t kOnce = 1;
  std::call_once(leader_begins_, [this] {
    leader_wake_ = ::eventfd(0, EFD_CLOEXEC);
    std::thread([this] { lead_for_others(); }).detach();
  });
  const Unpaid unpaid(*source_);
  if (block(Duration(0))) return true;
  const auto own = enter(deadline);
  static_cast<void>(TETHER_REAL(write)(leader_wake_, &kOnce, sizeof kOnce));
  bool is_given = false;
  while (!is_given && now() < deadline) is_given = block(std::min(kFirstSlice, slice(deadline, 0)));
  leave(own);
  return is_given;
}

// As long as somebody waits; then until somebody does.
void Agent::lead_for_others() {
  const Inside inside;
  for (;;) {
    bool is_any = false;
    {
      const std::lock_guard lock(waits_mutex_);
      is_any = !waits_.empty();
    }
    Unpaid unpaid(*source_);
    if (!lead(unpaid)) {
      pollfd fd{leader_wake_, POLLIN, 0};
      const timespec time = to_timespec(kFirstSlice);
      TETHER_REAL(ppoll)(&fd, 1, is_any ? &time : nullptr, nullptr);
      std::uint64_t count = 0;
      if (fd.revents != 0) static_cast<void>(TETHER_REAL(read)(leader_wake_, &count, sizeof count));
    }
  }
}

void Agent::sleep_until(ExecTime deadline) {
  wait(
      deadline, [] { return false; },
      [](Duration slice, int wake) {
        pollfd fd{wake, POLLIN, 0};
        const timespec time{0, static_cast<long>(slice.count())};
        TETHER_REAL(ppoll)(&fd, 1, &time, nullptr);
      });
}

void Agent::tell_gap(const char* what) {
  static std::mutex mutex;
  static std::set<std::string> told;
  {
    const std::lock_guard lock(mutex);
    if (!told.insert(what).second) return;
  }
  say(std::string("the program uses ") + what +
      ", which follows the machine's clock: its time is not that of the run");
  const std::lock_guard leading(leading_);
  static_cast<void>(
      vehicle_->annotate("as_is", std::string("{\"not_covered\": \"") + what + "\"}"));
}

void Agent::finish(int exit_code) {
  if (instance_.exchange(nullptr) == nullptr) return;
  const std::lock_guard leading(leading_);
  static_cast<void>(vehicle_->finish(
      exit_code == 0, "the program ended with exit code " + std::to_string(exit_code), "{}"));
}

}  // namespace tether::as_is
