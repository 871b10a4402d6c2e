#include "gzserver.h"

#include <cstdlib>
#include <stdexcept>

#include <unistd.h>

namespace tether::system_test {
namespace {

using std::filesystem::path;

constexpr std::chrono::seconds kStartLimit{60};

path build_folder() {
  return path(TETHER_SOURCE_DIR) / "build";
}

bool has_gazebo() {
  return std::filesystem::exists(build_folder() / "gazebo-root") ||
         std::filesystem::exists("/usr/bin/gzserver");
}

// Gazebo's master needs a port that no other test has.
std::string master_uri() {
  return "http://127.0.0.1:" + std::to_string(20000 + ::getpid() % 20000);
}

Command command_of(const path& world, const std::string& display, const path& home,
                   const path& socket) {
  const path source(TETHER_SOURCE_DIR);
  return {{(source / "scripts/lib/gzserver").string(), (build_folder() / "gazebo/lib").string(),
           "--", "--lockstep", "-s", "libtether_gazebo.so", world.string()},
          {{"TETHER_SIMULATOR_ENDPOINT", "unix:" + socket.string()},
           {"GAZEBO_MASTER_URI", master_uri()},
           {"GAZEBO_MODEL_PATH", (source / "data/models").string()},
           {"HOME", home.string()},
           {"DISPLAY", display}},
          home};
}

}  // namespace

std::optional<std::string> no_gzserver() {
  std::string why;
  if (!has_gazebo()) why = "no Gazebo 11 here";
  if (!std::filesystem::exists(build_folder() / "gazebo/lib/libtether_gazebo.so")) {
    why = "the plugin is not built";
  }
  if (why.empty()) return std::nullopt;
  why += ": run scripts/gazebo-root";
  if (std::getenv("CI")) throw std::runtime_error(why);
  return why;
}

XServer::XServer()
    : process_(std::make_unique<Process>(Command{
          {"Xvfb", "-displayfd", "1", "-screen", "0", "64x64x24", "-nolisten", "tcp"}, {}, {}})) {
  if (!process_->wait_for_out("\n", kStartLimit)) {
    throw std::runtime_error("Xvfb does not come up: " + process_->err());
  }
  display_ = ":" + process_->out().substr(0, process_->out().find('\n'));
}

Gzserver::Gzserver(const path& world, const std::string& display)
    : socket_(folder_.path("simulator.sock")),
      process_(std::make_unique<Process>(command_of(world, display, folder_.path(), socket_))) {}

std::unique_ptr<sim::protocol::Connection> Gzserver::connect() {
  if (!process_->wait_for_out(socket_.string(), kStartLimit)) {
    throw std::runtime_error("gzserver does not come up: " + process_->out() + process_->err());
  }
  auto connection = sim::protocol::connect(socket_, kStartLimit);
  if (!connection) throw std::runtime_error(connection.failure().message);
  return std::move(connection).value();
}

}  // namespace tether::system_test
