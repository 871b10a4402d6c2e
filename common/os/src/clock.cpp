#include <array>
#include <cerrno>

#include <tether/os/machine.h>

namespace tether::os {

Duration read_clock(clockid_t clock) {
  timespec t{};
  ::clock_gettime(clock, &t);
  return std::chrono::seconds(t.tv_sec) + Duration(t.tv_nsec);
}

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text.data();
}

void sleep_until(Duration monotonic) {
  if (monotonic <= read_clock(CLOCK_MONOTONIC)) return;
  const auto whole = std::chrono::duration_cast<std::chrono::seconds>(monotonic);
  timespec until{};
  until.tv_sec = whole.count();
  until.tv_nsec = (monotonic - whole).count();
  while (::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
}

}  // namespace tether::os
