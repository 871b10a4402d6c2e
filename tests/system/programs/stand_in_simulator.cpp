// A simulator in which nothing ever moves, and that fails on request: for what the real one
// cannot be made to do.
//
//   stand_in_simulator ENDPOINT
//   or in the place of Gazebo's loader, with TETHER_SIMULATOR_ENDPOINT
//
// STAND_IN_MODE selects how it fails; without one it serves until it is ended. kill_PHASE and
// stop_PHASE: SIGKILL or SIGSTOP strikes it there.
#include "support/still_world.h"

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include <sys/prctl.h>
#include <unistd.h>

#include <tether/sim_protocol/connection.h>

namespace {

using namespace std::chrono_literals;
namespace protocol = tether::sim::protocol;
using tether::system_test::StillWorld;

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

const std::string kMode = variable("STAND_IN_MODE");
// Modes with "in_flight" fail at this ST.
constexpr tether::SimTime kFailsAt = tether::from_ns<tether::SimTime>(500'000'000);

[[noreturn]] void print_and_exit(const char* text, int code) {
  std::fprintf(stderr, "%s\n", text);
  std::exit(code);
}

[[noreturn]] void end_by(int signal) {
  prctl(PR_SET_DUMPABLE, 0);  // no core file
  std::signal(signal, SIG_DFL);
  std::raise(signal);
  std::abort();
}

[[noreturn]] void crash() {
  std::fprintf(stderr, "the wheels came off\n");
  end_by(SIGSEGV);
}

[[noreturn]] void wait_for_ever() {
  while (true) pause();
}

void strike(const std::string& phase) {
  if (kMode == "kill_" + phase) std::raise(SIGKILL);
  if (kMode == "stop_" + phase) std::raise(SIGSTOP);
}

// ---- What it does in the place of an answer, or before it

using Answer = std::optional<protocol::Reply>;

StillWorld g_world;

Answer fault_at(const protocol::Open&) {
  strike("opening");
  return std::nullopt;
}

Answer fault_at(const protocol::Advance& advance) {
  if (advance.to < kFailsAt) return std::nullopt;
  strike("advancing");
  if (kMode == "crash_in_flight") crash();
  if (kMode == "exit_in_flight") print_and_exit("[Err] [World.cc:1] I have had enough", 5);
  if (kMode == "stop_in_flight") std::raise(SIGSTOP);
  if (kMode == "old_words") end_by(SIGABRT);
  if (kMode != "refuse_in_flight") return std::nullopt;
  std::fputs("tether: the world has come to its end\n", stderr);
  return protocol::Failed{"the world has come to its end"};
}

Answer fault_at(const protocol::Render&) {
  if (kMode == "no_gl") return protocol::Failed{"no camera can be made: rendering is off"};
  strike(g_world.now() < kFailsAt ? "warming_up" : "rendering");
  return std::nullopt;
}

template <class Other>
Answer fault_at(const Other&) {
  return std::nullopt;
}

protocol::Reply answer(const protocol::Request& request) {
  const auto fault = std::visit([](const auto& r) { return fault_at(r); }, request);
  return fault ? *fault : g_world.answer(request);
}

// ---- One host after the other

void serve(protocol::Connection& host) {
  while (const auto request = host.receive_request()) {
    const auto reply = answer(*request);
    if (!host.send(reply)) return;
    // As Tether's plugin does.
    if (std::holds_alternative<protocol::Failed>(reply) && kMode == "refuse_in_flight")
      std::exit(1);
  }
  strike("closing");
}

int listen(const std::string& text) {
  const auto endpoint = protocol::parse_endpoint(text);
  if (!endpoint) print_and_exit(endpoint.failure().message.c_str(), 2);
  const auto listener = protocol::listen(*endpoint);
  if (!listener) print_and_exit(listener.failure().message.c_str(), 3);
  std::printf("listening on %s\n", protocol::to_string((*listener)->endpoint()).c_str());
  std::fflush(stdout);
  while (const auto host = (*listener)->accept()) serve(**host);
  return 0;
}

const std::map<std::string, std::function<void()>> kModesAtStart = {
    {"exit_at_start", [] { print_and_exit("[Err] [Server.cc:1] no wheels", 7); }},
    {"crash_at_start", [] { crash(); }},
    {"silent", [] { wait_for_ever(); }},
    // As Gazebo prints it.
    {"port_in_use",
     [] {
       print_and_exit(
           "[Err] [Master.cc:95] EXCEPTION: Unable to start server[bind: Address already in use].",
           255);
     }},
    // As libsdformat prints it, of a world that Gazebo then goes on without.
    {"misread",
     [] { std::fputs("Error Code 12 Msg: Unable to find uri[model://wheels]\n", stderr); }},
    // As Gazebo prints it of a plugin of the world, which it goes on without.
    {"no_plugin",
     [] {
       std::fputs("[Err] [Plugin.hh:178] Failed to load plugin libwheels.so: no such file\n",
                  stderr);
     }},
    {"old_words", [] { std::fputs("[Err] [World.cc:1] an old line\n", stderr); }},
    {"stubborn", [] { std::signal(SIGINT, SIG_IGN); }},
    {"child",
     [] {
       if (fork() == 0) wait_for_ever();
     }},
};

}  // namespace

int main(int argc, char** argv) {
  const auto mode = kModesAtStart.find(kMode);
  if (mode != kModesAtStart.end()) mode->second();
  const std::string endpoint = variable("TETHER_SIMULATOR_ENDPOINT");
  return listen(endpoint.empty() && argc == 2 ? argv[1] : endpoint);
}
