#include "gazebo_server.h"

#include "gazebo_log.h"
#include "gazebo_master.h"

#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <tether/base/error.h>
#include <tether/os/child_process.h>
#include <tether/os/text_file.h>

namespace tether::sim {

namespace {

using Steady = std::chrono::steady_clock;
constexpr Duration kLook = std::chrono::milliseconds(10);
// How long a process that lost its connection may take to end.
constexpr Duration kEndLimit = std::chrono::milliseconds(500);
constexpr int kPortAttempts = 5;
constexpr const char* kStartLimit = "TETHER_GAZEBO_START_LIMIT_S";

Duration start_limit_of_user() {
  const char* given = std::getenv(kStartLimit);
  if (!given || !*given) return std::chrono::seconds(60);
  const std::string_view text(given);
  double seconds = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seconds);
  if (error != std::errc() || end != text.data() + text.size() || !(seconds > 0.0) || seconds > 1e6)
    throw Error(ErrorCode::kSetup,
                fmt::format("{} is \"{}\": a number of seconds is expected", kStartLimit, text));
  return std::chrono::duration_cast<Duration>(std::chrono::duration<double>(seconds));
}

/// A port that nobody listens on, as yet.
std::uint16_t free_port() {
  const int descriptor = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  socklen_t size = sizeof address;
  auto* generic = reinterpret_cast<sockaddr*>(&address);
  const bool bound = descriptor >= 0 && bind(descriptor, generic, size) == 0 &&
                     getsockname(descriptor, generic, &size) == 0;
  const int why = errno;
  if (descriptor >= 0) close(descriptor);
  if (!bound)
    throw Error(ErrorCode::kSetup, std::string("no free port for gzserver: ") + std::strerror(why));
  return ntohs(address.sin_port);
}

/// Where model:// leads, as sim::load_world has it.
std::string model_path(const std::filesystem::path& world) {
  const auto folder = world.parent_path(), above = folder.parent_path();
  std::string path = fmt::format("{}:{}:{}:{}", (folder / "models").string(),
                                 (above / "models").string(), above.string(), folder.string());
  for (const char* name : {"GAZEBO_MODEL_PATH", "GZ_SIM_RESOURCE_PATH"})
    if (const char* given = std::getenv(name); given && *given) path += std::string(":") + given;
  return path;
}

void make_empty(const std::filesystem::path& log) {
  std::error_code ignored;
  std::filesystem::remove(log, ignored);
}

bool says(const std::string& text, std::string_view part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

GazeboServer::GazeboServer(GazeboRun run)
    : run_(std::move(run)),
      limit_(start_limit_of_user()),
      users_master_(master_of_user()),
      started_(Steady::now()),
      folder_("tether-gazebo-") {
  make_empty(run_.log);
  if (run_.draws) {
    x_server_ = std::make_unique<XServer>(folder_.path(), run_.log);
    wait_for_display();
  }
  start_gzserver();
}

// What uses the X server goes first.
GazeboServer::~GazeboServer() {
  gzserver_.reset();
  x_server_.reset();
}

void GazeboServer::wait_for_display() {
  while (!x_server_->is_ready()) {
    look();
    if (const auto end = lost()) fail(*end);
    std::this_thread::sleep_for(kLook);
  }
}

void GazeboServer::start_gzserver() {
  said_before_ = os::read_whole(run_.log).size();
  master_ = users_master_;
  if (master_.empty()) master_ = fmt::format("http://127.0.0.1:{}", free_port());
  const std::string home = folder_.path();
  os::ChildCommand command{.arguments = run_.install.command,
                           .environment = run_.install.environment,
                           .log = run_.log,
                           .appends = true,
                           // Gazebo looks there for any relative path: nothing of the user's.
                           .working_folder = home,
                           .end_signal = SIGINT};
  for (const std::string& word :
       {std::string("--verbose"), std::string("--lockstep"), std::string("-s"),
        run_.install.plugin.string(), run_.world.string()})
    command.arguments.push_back(word);
  const os::Environment own = {{"GAZEBO_MASTER_URI", master_},
                               {"GAZEBO_IP", "127.0.0.1"},
                               {"IGN_IP", "127.0.0.1"},
                               {"IGN_PARTITION", folder_.path().filename()},
                               {"GAZEBO_MODEL_PATH", model_path(run_.world)},
                               {"GAZEBO_MODEL_DATABASE_URI", ""},
                               {"GAZEBO_LOG_PATH", home + "/log"},
                               {"HOME", home},
                               {"TMPDIR", home},
                               {"ALSOFT_DRIVERS", "null"},
                               {"DISPLAY", ""},
                               {"TETHER_SIMULATOR_ENDPOINT", "unix:" + home + "/simulator"}};
  for (const auto& variable : own) command.environment.push_back(variable);
  if (x_server_)
    for (const auto& variable : x_server_->environment()) command.environment.push_back(variable);
  gzserver_ = std::make_unique<os::ChildProcess>(command);
}

std::unique_ptr<protocol::Connection> GazeboServer::connect() {
  const protocol::Endpoint endpoint = folder_.path() / "simulator";
  for (int attempt = 1;; std::this_thread::sleep_for(kLook)) {
    if (auto connection = protocol::connect(endpoint, start_limit())) return std::move(*connection);
    look();
    const auto why = why_not_up();
    if (!why) continue;
    // Somebody took the port between our look at it and gzserver's.
    if (!has_port_in_use() || !users_master_.empty() || ++attempt > kPortAttempts) fail(*why);
    start_gzserver();
  }
}

Duration GazeboServer::start_limit() const {
  const Duration passed = std::chrono::duration_cast<Duration>(Steady::now() - started_);
  return std::max(limit_ - passed, Duration(std::chrono::milliseconds(1)));
}

/// Whether to go on waiting.
void GazeboServer::look() const {
  if (run_.stop.stop_requested()) throw Error(ErrorCode::kSetup, "interrupted by the user");
  if (Steady::now() - started_ < limit_) return;
  throw Error(ErrorCode::kSetup,
              fmt::format("gzserver has not come up in {:g} s (see {}); where it needs longer, set "
                          "{}",
                          to_seconds(limit_), run_.log.string(), kStartLimit));
}

bool GazeboServer::has_port_in_use() {
  return says(os::read_whole(run_.log).substr(said_before_), "Address already in use");
}

std::optional<std::string> GazeboServer::why_not_up() {
  const std::string log = os::read_whole(run_.log);
  if (const std::string why = plugin_error(log); !why.empty())
    return fmt::format("{} (see {})", why, run_.log.string());
  if (const std::string why = drawing_error(log); x_server_ && !why.empty())
    return fmt::format("it cannot draw for the cameras: {} (see {})", why, run_.log.string());
  return lost();
}

std::optional<std::string> GazeboServer::lost() {
  return end_beyond("");
}

std::optional<std::string> GazeboServer::end_beyond(const std::string& said) {
  if (x_server_)
    if (const auto end = x_server_->end())
      return fmt::format("{}; see {}", *end, run_.log.string());
  const auto& exit = gzserver_ ? gzserver_->poll() : std::nullopt;
  if (!exit) return std::nullopt;
  if (has_port_in_use())
    return fmt::format(
        "gzserver {}, because the port of {} is in use (by another gzserver?); end "
        "what uses it, or unset GAZEBO_MASTER_URI",
        exit->description, master_);
  const std::string last = last_words(*exit);
  return fmt::format("gzserver {}; {}", exit->description,
                     last.empty() || says(said, last)
                         ? "see " + run_.log.string()
                         : fmt::format("its last words in {}: {}", run_.log.string(), last));
}

/// Who is killed says nothing of it; nor does what was said before the world was open.
std::string GazeboServer::last_words(const os::ChildExit& exit) const {
  if (exit.code == 128 + SIGKILL) return "";
  std::string last = last_words_of_gazebo(os::read_whole(run_.log).substr(said_before_));
  constexpr std::string_view kOwn = "tether: ";
  if (last.starts_with(kOwn)) last.erase(0, kOwn.size());
  return last;
}

std::string GazeboServer::post_mortem(const std::string& said) {
  gzserver_->wait(kEndLimit);
  const auto errors = reading_errors(os::read_whole(run_.log));
  if (!errors.empty() && !says(said, errors.front()))
    return fmt::format("; Gazebo said, in {}: {}", run_.log.string(), errors.front());
  const auto& exit = gzserver_->poll();
  if (exit && says(said, "gzserver " + exit->description)) return "";
  const auto end = end_beyond(said);
  return end && !says(said, *end) ? "; " + *end : "";
}

void GazeboServer::check_world() {
  const std::string log = os::read_whole(run_.log);
  auto errors = reading_errors(log);
  if (const std::string why = plugin_error(log); !why.empty()) errors.push_back(why);
  if (!errors.empty())
    throw Error(ErrorCode::kSetup,
                fmt::format("Gazebo cannot read all of {}: {} (see {})", run_.world.string(),
                            errors.front(), run_.log.string()));
  said_before_ = log.size();
}

void GazeboServer::fail(const std::string& what) const {
  throw Error(ErrorCode::kSetup, "Gazebo cannot be started: " + what);
}

}  // namespace tether::sim
