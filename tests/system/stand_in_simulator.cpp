// A simulator in which nothing ever moves, and that fails as it is told: for what the real one
// cannot be made to do.
//
//   stand_in_simulator ENDPOINT
//   or in the place of Gazebo's loader, with TETHER_SIMULATOR_ENDPOINT
//
// STAND_IN_MODE says how it fails; without one it serves until it is ended. kill_PHASE and
// stop_PHASE: SIGKILL or SIGSTOP strikes it there.
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <limits>
#include <map>
#include <string>

#include <sys/prctl.h>
#include <unistd.h>

#include <tether/sim_protocol/connection.h>

namespace {

using namespace std::chrono_literals;
namespace protocol = tether::sim::protocol;

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

const std::string kMode = variable("STAND_IN_MODE");
// Modes with "in_flight" fail at this ST.
constexpr tether::SimTime kFailsAt = tether::from_ns<tether::SimTime>(500'000'000);

[[noreturn]] void say_and_exit(const char* words, int code) {
  std::fprintf(stderr, "%s\n", words);
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

// ---- A world in which nothing moves

protocol::Open g_open;
tether::SimTime g_now{};

std::vector<tether::uav::Pose> poses() {
  std::vector<tether::uav::Pose> list;
  for (const auto& uav : g_open.uavs) list.push_back(uav.X_WB);
  list.resize(list.size() + g_open.bodies.size());
  return list;
}

protocol::State state(std::int64_t steps) {
  protocol::State state;
  state.now = g_now;
  const auto bodies = poses();
  for (const auto& X_WB : bodies) {
    tether::uav::BodyState body;
    body.p_WB = X_WB.p;
    body.q_WB = X_WB.q;
    state.bodies.push_back(body);
  }
  state.motions.resize(g_open.uavs.size());
  for (std::int64_t i = 0; i < std::min<std::int64_t>(steps, g_open.past_steps); ++i)
    state.past.insert(state.past.end(), bodies.begin(), bodies.end());
  return state;
}

protocol::Reply answer(const protocol::Open& open) {
  strike("opening");
  g_open = open;
  g_now = {};
  return protocol::Opened{"a stand-in", state(0)};
}

protocol::Reply answer(const protocol::Reset&) {
  g_now = {};
  return state(0);
}

protocol::Reply answer(const protocol::Advance& advance) {
  const std::int64_t steps = (advance.to - g_now) / g_open.step;
  g_now = advance.to;
  if (g_now >= kFailsAt) {
    strike("advancing");
    if (kMode == "crash_in_flight") crash();
    if (kMode == "exit_in_flight") say_and_exit("[Err] [World.cc:1] I have had enough", 5);
    if (kMode == "stop_in_flight") std::raise(SIGSTOP);
    if (kMode == "old_words") end_by(SIGABRT);
    if (kMode == "refuse_in_flight") {
      std::fputs("tether: the world has come to its end\n", stderr);
      return protocol::Failed{"the world has come to its end"};
    }
  }
  return state(steps);
}

protocol::Reply answer(const protocol::CastRays& rays) {
  return protocol::Distances{
      std::vector<double>(rays.rays_S.size(), std::numeric_limits<double>::infinity())};
}

protocol::Reply answer(const protocol::Render& view) {
  if (kMode == "no_gl") return protocol::Failed{"no camera can be made: rendering is off"};
  strike(g_now < kFailsAt ? "warming_up" : "rendering");
  const auto width = view.camera.width_px, height = view.camera.height_px;
  protocol::Picture picture{width, height, {}, 1.0, "grey"};
  picture.rgb.resize(static_cast<std::size_t>(width * height) * 3, 127);
  return picture;
}

// ---- One host after the other

void serve(protocol::Connection& host) {
  while (const auto request = host.receive_request()) {
    const auto reply = std::visit([](const auto& r) { return answer(r); }, *request);
    if (!host.send(reply)) return;
    // As Tether's plugin does.
    if (std::holds_alternative<protocol::Failed>(reply) && kMode == "refuse_in_flight")
      std::exit(1);
  }
  strike("closing");
}

int listen(const std::string& text) {
  const auto endpoint = protocol::parse_endpoint(text);
  if (!endpoint) say_and_exit(endpoint.failure().message.c_str(), 2);
  const auto listener = protocol::listen(*endpoint);
  if (!listener) say_and_exit(listener.failure().message.c_str(), 3);
  std::printf("listening on %s\n", protocol::to_string((*listener)->endpoint()).c_str());
  std::fflush(stdout);
  while (const auto host = (*listener)->accept()) serve(**host);
  return 0;
}

const std::map<std::string, std::function<void()>> kModesAtStart = {
    {"exit_at_start", [] { say_and_exit("[Err] [Server.cc:1] no wheels", 7); }},
    {"crash_at_start", [] { crash(); }},
    {"silent", [] { wait_for_ever(); }},
    // As Gazebo says it.
    {"port_in_use",
     [] {
       say_and_exit(
           "[Err] [Master.cc:95] EXCEPTION: Unable to start server[bind: Address already in use].",
           255);
     }},
    // As libsdformat says it, of a world that Gazebo then goes on without.
    {"misread",
     [] { std::fputs("Error Code 12 Msg: Unable to find uri[model://wheels]\n", stderr); }},
    // As Gazebo says it of a plugin of the world, which it goes on without.
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
