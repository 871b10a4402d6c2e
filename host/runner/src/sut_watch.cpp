#include "sut_watch.h"

#include <algorithm>
#include <charconv>

#include <tether/link/messages.h>
#include <tether/os/process_table.h>

namespace tether::runner {

namespace {

// Both limits are in execution time: 20 ms is less than the time between two images of a usual
// camera, and ten looks; 1 % is what two measurements of a CPU clock differ by.
constexpr Duration kLeastDoubt = std::chrono::milliseconds(20);
constexpr double kDoubtfulShare = 0.01;
// Threads that hand over to each other are both runnable for a moment: on a busy machine, 4 to 10 %
// of looks at such programs were seen to find two.
constexpr double kDoubtfulThreads = 1.3;

std::uint16_t port_of(const std::string& address) {
  std::uint16_t port = 0;
  const char* const end = address.data() + address.size();
  std::from_chars(address.data() + address.rfind(':') + 1, end, port);
  return port;
}

}  // namespace

void SutWatch::joined(std::size_t uav, const std::string& address, std::uint32_t process) {
  const auto number = static_cast<pid_t>(process);
  if (number > 0 && os::has_connection(number, port_of(address), port_)) processes_[uav] = number;
}

std::optional<coordinator::ThreadStates> SutWatch::states(std::size_t uav) const {
  const auto process = processes_.find(uav);
  if (process == processes_.end()) return std::nullopt;
  const os::ThreadStates states = os::thread_states(process->second, link::kClientThread);
  return coordinator::ThreadStates{.runnable = states.runnable, .is_halted = states.halted > 0};
}

std::vector<campaign::Doubt> doubts_of(const coordinator::SutReport& sut,
                                       const computer::Clock& clock, bool has_waits) {
  using Kind = campaign::Doubt::Kind;
  std::vector<campaign::Doubt> doubts;
  const double least_s =
      std::max(to_seconds(kLeastDoubt), kDoubtfulShare * to_seconds(sut.et.time_since_epoch()));
  const coordinator::SutLooks& looks = sut.looks;
  if (const double waiting_s = to_seconds(looks.waiting); waiting_s > least_s && !has_waits)
    doubts.push_back({Kind::kUnseenWait, sut.uav, waiting_s});
  const double computing_s = to_seconds(looks.computing);
  const double of_all_s = to_seconds(looks.of_all_threads);
  if (clock.kind == computer::ClockKind::kCpu &&
      (of_all_s - computing_s) * clock.factor > least_s &&
      of_all_s > kDoubtfulThreads * computing_s)
    doubts.push_back({Kind::kParallelThreads, sut.uav, of_all_s / computing_s});
  return doubts;
}

}  // namespace tether::runner
