#include "suts/sut_watch.h"

#include <algorithm>
#include <charconv>

#include <tether/link/messages.h>
#include <tether/os/process_table.h>

namespace tether::runner {

namespace {

// Both limits are in execution time: 100 ms is 50 looks, and three images of a usual camera. On a
// machine with twice as many programs as cores, shipped programs that wait for nothing were seen to
// wait for 22 and 43 ms. 1 % is what two measurements of a CPU clock differ by.
constexpr Duration kLeastDoubt = std::chrono::milliseconds(100);
constexpr double kDoubtfulShare = 0.01;
// Also of a factor that makes much of it, less waiting of a program that waits for nothing is seen
// on a busy machine.
constexpr Duration kLeastSeenWait = std::chrono::milliseconds(50);
// The first use of memory and of a library's pages waits for the disk, too.
constexpr Duration kLeastDiskDoubt = std::chrono::milliseconds(200);
constexpr double kDoubtfulDiskShare = 0.1;
// Threads that hand over to each other are both runnable for a moment: on a busy machine, 4 to 10 %
// of looks at such programs were seen to find two.
constexpr double kDoubtfulThreads = 1.3;
// Fewer say nothing: on a busy machine, each stands for 50 ms.
constexpr int kLeastParallelLooks = 5;
constexpr double kLooksAfterOthers = 5.0;
// Less waiting than the limits above matters where a flight is as close to a limit.
constexpr Duration kLeastSlightWait = std::chrono::milliseconds(20);

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
  return coordinator::ThreadStates{.runnable = states.runnable,
                                   .is_halted = states.halted > 0,
                                   .is_on_disk = states.on_disk > 0,
                                   .is_served = states.left_out_runnable > 0};
}

std::vector<campaign::Doubt> doubts_of(const coordinator::SutReport& sut,
                                       const computer::Clock& clock, bool has_waits,
                                       bool sees_waits) {
  using Kind = campaign::Doubt::Kind;
  std::vector<campaign::Doubt> doubts;
  const double et_s = to_seconds(sut.et.time_since_epoch());
  const double least_s = std::max(to_seconds(kLeastDoubt), kDoubtfulShare * et_s);
  const coordinator::SutLooks& looks = sut.looks;
  // In ET: a scaled wall clock stretches all waiting. Under a scaled CPU clock, it can be for a
  // program that computes, and for which the modelled computer would take that much longer; but not
  // that of a program as it is, whose waits for others are seen, and which is charged for them.
  const double waiting_s = to_seconds(looks.waiting);
  const bool counts = clock.counts_waiting();
  const double stretched_s = waiting_s * (counts       ? clock.factor
                                          : sees_waits ? 1.0
                                                       : std::max(1.0, clock.factor));
  // A side that sees waits looks at them from time to time, which takes some milliseconds each.
  const double least_wait_s = sees_waits ? kLooksAfterOthers * least_s : least_s;
  if (stretched_s > least_wait_s && (counts || waiting_s > to_seconds(kLeastSeenWait)) &&
      !has_waits)
    doubts.push_back(counts ? campaign::Doubt{Kind::kStretchedWait, sut.uav, waiting_s}
                            : campaign::Doubt{Kind::kUnseenWait, sut.uav, stretched_s});
  else if ((counts ? waiting_s : stretched_s) > to_seconds(kLeastSlightWait) && !has_waits &&
           !sees_waits)
    doubts.push_back({Kind::kSlightWait, sut.uav, std::min(1.0, stretched_s / et_s)});
  if (const double on_disk_s = to_seconds(looks.on_disk);
      on_disk_s > std::max(to_seconds(kLeastDiskDoubt), kDoubtfulDiskShare * et_s) && !has_waits &&
      !clock.counts_waiting())
    doubts.push_back({Kind::kDiskWait, sut.uav, on_disk_s});
  const double computing_s = to_seconds(looks.computing);
  const double of_all_s = to_seconds(looks.of_all_threads);
  // Threads that wait look after each other, which is not the program's computing.
  const double least_parallel_s = sees_waits ? kLooksAfterOthers * least_s : least_s;
  if (clock.kind == computer::ClockKind::kCpu && looks.parallel_looks >= kLeastParallelLooks &&
      (of_all_s - computing_s) * clock.factor > least_parallel_s &&
      of_all_s > kDoubtfulThreads * computing_s)
    doubts.push_back({Kind::kParallelThreads, sut.uav, of_all_s / computing_s});
  return doubts;
}

}  // namespace tether::runner
