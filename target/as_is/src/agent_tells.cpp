// What the user has to know of a program: on standard error, and where the answer depends on it,
// there too.

#include "agent.h"
#include "beside_source.h"
#include "outside.h"
#include "real.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <set>
#include <string>
#include <vector>

#include <arpa/inet.h>
#include <netinet/in.h>

namespace tether::as_is {
namespace {

// After so long it is told that nothing was used [ET].
constexpr Duration kIdle = std::chrono::seconds(10);
// Less than that computed beside calls is no doubt.
constexpr Duration kLeastBeside = std::chrono::milliseconds(100);
/// The address of another computer as text; empty: it is of this one, or of no network.
std::string other_computer(const sockaddr& address) {
  char text[INET6_ADDRSTRLEN] = "";
  if (address.sa_family == AF_INET) {
    const in_addr& ip = reinterpret_cast<const sockaddr_in&>(address).sin_addr;
    const bool is_own = (ntohl(ip.s_addr) >> 24) == IN_LOOPBACKNET || ip.s_addr == INADDR_ANY;
    return is_own ? "" : ::inet_ntop(AF_INET, &ip, text, sizeof text);
  }
  if (address.sa_family != AF_INET6) return "";
  const in6_addr& ip = reinterpret_cast<const sockaddr_in6&>(address).sin6_addr;
  const bool is_mapped = IN6_IS_ADDR_V4MAPPED(&ip) && ip.s6_addr[12] == IN_LOOPBACKNET;
  const bool is_own = IN6_IS_ADDR_LOOPBACK(&ip) || IN6_IS_ADDR_UNSPECIFIED(&ip) || is_mapped;
  return is_own ? "" : ::inet_ntop(AF_INET6, &ip, text, sizeof text);
}

}  // namespace

void say(const std::string& line) {
  std::fprintf(stderr, "tether: %s\n", line.c_str());
}

// A program that uses some of it is right: it need not use all.
void Agent::tell_if_idle() {
  if (is_known_to_be_used_) return;
  is_known_to_be_used_ = is_fed();
  if (is_known_to_be_used_ || now() < ExecTime(kIdle)) return;
  is_known_to_be_used_ = true;
  say("for 10 s the program has used nothing of the UAV: no UDP port of a companion (14540, "
      "14550), "
      "no serial port, and none of its cameras, of which it has " +
      std::to_string(cameras_.cameras().size()));
}

// Above a hundredth of the flight, as of what is seen from outside (ADR 0064).
void Agent::tell_if_beside() {
  const Duration beside = computed_beside_calls();
  if (is_known_to_be_beside_ || beside < kLeastBeside || beside < now().time_since_epoch() / 100)
    return;
  is_known_to_be_beside_ = true;
  doubt(
      "has a program whose threads compute beside its calls, during which the clock wall "
      "stands: add all_processes = true");
}

bool Agent::tell(const std::string& line) {
  static std::mutex mutex;
  static std::set<std::string> told;
  const std::lock_guard lock(mutex);
  const bool is_new = told.insert(line).second;
  if (is_new) say(line);
  return is_new;
}

void Agent::tell_gap(const char* what) {
  const std::string text = std::string("has a program that uses ") + what +
                           ", which follows the machine's clock: its time is not that of the run";
  doubt_once(text);
}

void Agent::doubt_once(const std::string& text) {
  if (!tell(text)) return;
  const auto alone = leading();
  doubt(text);
}

// With leading_, or alone: it is for the answer.
void Agent::doubt(const std::string& text) {
  static_cast<void>(vehicle().annotate("as_is", "{\"doubt\": \"" + text + "\"}"));
}

void Agent::tell_outside(const sockaddr* address) {
  if (address == nullptr) return;
  constexpr const char* kNotTimed =
      ", which has the real time: what it waits for there is not timed";
  if (const std::string other = other_computer(*address); !other.empty())
    return doubt_once("has a program that talks to another computer (" + other + ")" + kNotTimed);
  const std::uint16_t port = port_of(address, sizeof(sockaddr_storage));
  if (!group_ || port == 0) return;
  const Unpaid unpaid(*source_);
  if (listens_at(port, all_processes()) == Who::kOutside)
    doubt_once("has a program that talks to one that it did not start, at TCP port " +
               std::to_string(port) + kNotTimed + ". Start it with the program");
}

void Agent::tell_locked(int fd) {
  const Unpaid unpaid(*source_);
  if (has_locked(fd, all_processes()) == Who::kOutside)
    doubt_once(
        "has a program that waits for a lock of one that it did not start, which has the real "
        "time: how long it waits is not timed");
}

std::vector<pid_t> Agent::all_processes() const {
  std::vector<pid_t> all;
  for (const auto& one : group_->page().processes())
    if (const pid_t id = one.id; id > 0) all.push_back(id);
  return all;
}

}  // namespace tether::as_is
