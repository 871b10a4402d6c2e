// Starts gzserver and its X server for one run, waits for the plugin, and describes their end. All
// decisions about their output use the typed parse of gazebo_log.h. `is_end_reported_` records
// whether an end was reported, so that `post_mortem` does not repeat it.

#include "gazebo_server.h"

#include "gazebo_log.h"
#include "gazebo_master.h"

#include <charconv>
#include <csignal>
#include <cstdlib>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include <tether/base/error.h>
#include <tether/link/socket.h>
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
                fmt::format("{} is \"{}\"; it must be a number of seconds, greater than 0 and at "
                            "most 1e6",
                            kStartLimit, text))
        .about(kStartLimit);
  return std::chrono::duration_cast<Duration>(std::chrono::duration<double>(seconds));
}

/// A port that is free now.
std::uint16_t free_port() {
  const auto socket = link::listen_on_tcp({"127.0.0.1", 0});
  if (!socket)
    throw Error(ErrorCode::kSetup, "no free port for gzserver: " + socket.failure().message);
  return link::local_address(socket->get()).port;
}

/// The folders of model:// URIs, as for sim::load_world.
std::string model_path(const std::filesystem::path& world) {
  const auto folder = world.parent_path(), above = folder.parent_path();
  std::string path = fmt::format("{}:{}:{}:{}", (folder / "models").string(),
                                 (above / "models").string(), above.string(), folder.string());
  for (const char* name : {"GAZEBO_MODEL_PATH", "GZ_SIM_RESOURCE_PATH"})
    if (const char* given = std::getenv(name); given && *given) path += std::string(":") + given;
  return path;
}

}  // namespace

GazeboServer::GazeboServer(GazeboRun run)
    : run_(std::move(run)),
      limit_(start_limit_of_user()),
      users_master_(master_of_user()),
      started_(Steady::now()),
      folder_("tether-gazebo-") {
  std::error_code ignored;
  std::filesystem::remove(run_.log, ignored);
  if (run_.draws) {
    x_server_ = std::make_unique<XServer>(folder_.path(), run_.log);
    wait_for_display();
  }
  start_gzserver();
}

// gzserver uses the X server, so it ends first.
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
  log_begin_ = os::read_whole(run_.log).size();
  master_ = users_master_;
  if (master_.empty()) master_ = fmt::format("http://127.0.0.1:{}", free_port());
  const std::string home = folder_.path();
  os::ChildCommand command{.arguments = run_.install.command,
                           .environment = run_.install.environment,
                           .log = run_.log,
                           .appends = true,
                           // Gazebo searches there for relative paths: no files of the user.
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
    // Another process may have taken the port in between.
    if (!new_log().has_port_in_use || !users_master_.empty() || ++attempt > kPortAttempts)
      fail(*why);
    start_gzserver();
  }
}

Duration GazeboServer::start_limit() const {
  const Duration passed = std::chrono::duration_cast<Duration>(Steady::now() - started_);
  return std::max(limit_ - passed, Duration(std::chrono::milliseconds(1)));
}

/// Ends the wait at its limit or at a stop.
void GazeboServer::look() const {
  if (run_.stop.stop_requested()) throw Error(ErrorCode::kSetup, "interrupted by the user");
  if (Steady::now() - started_ < limit_) return;
  throw Error(
      ErrorCode::kSetup,
      fmt::format("gzserver did not start within {:g} s (see {}); if it needs longer, set {}",
                  to_seconds(limit_), run_.log.string(), kStartLimit));
}

GazeboLog GazeboServer::whole_log() const {
  return parse_gazebo_log(os::read_whole(run_.log));
}

GazeboLog GazeboServer::new_log() const {
  return parse_gazebo_log(os::read_whole(run_.log).substr(log_begin_));
}

std::optional<std::string> GazeboServer::why_not_up() {
  const GazeboLog log = whole_log();
  if (!log.plugin_error.empty())
    return fmt::format("{} (see {})", log.plugin_error, run_.log.string());
  if (x_server_ && !log.drawing_error.empty())
    return fmt::format("it cannot draw for the cameras: {} (see {})", log.drawing_error,
                       run_.log.string());
  return lost();
}

std::optional<std::string> GazeboServer::lost() {
  auto end = describe_end(KnownReason::kNone);
  is_end_reported_ = is_end_reported_ || end.has_value();
  return end;
}

std::optional<std::string> GazeboServer::describe_end(KnownReason known) {
  if (x_server_)
    if (const auto end = x_server_->end())
      return fmt::format("{}; see {}", *end, run_.log.string());
  const auto& exit = gzserver_ ? gzserver_->poll() : std::nullopt;
  if (!exit) return std::nullopt;
  // Lines from before the world was open, or of a process that was killed, do not explain the end.
  const GazeboLog log = new_log();
  if (log.has_port_in_use)
    return fmt::format(
        "gzserver {}, because the port of {} is in use (by another gzserver?); stop the process "
        "that uses it, or unset GAZEBO_MASTER_URI",
        exit->description, master_);
  const bool is_known =
      known == KnownReason::kOfPlugin && log.last_writer == GazeboLog::Writer::kPlugin;
  return fmt::format("gzserver {}; {}", exit->description,
                     log.last_line.empty() || is_known || exit->code == os::kSignalled + SIGKILL
                         ? "see " + run_.log.string()
                         : fmt::format("last line in {}: {}", run_.log.string(), log.last_line));
}

// When the simulator's session fails, the plugin has sent its reason to the host, or lost it.
std::string GazeboServer::post_mortem() {
  gzserver_->wait(kEndLimit);
  const GazeboLog log = whole_log();
  const bool is_quoted = is_end_reported_ && log.last_writer == GazeboLog::Writer::kSdfReader;
  if (!log.reading_errors.empty() && !is_quoted)
    return fmt::format("; Gazebo reported in {}: {}", run_.log.string(),
                       log.reading_errors.front());
  if (is_end_reported_) return "";
  const auto end = describe_end(KnownReason::kOfPlugin);
  return end ? "; " + *end : "";
}

void GazeboServer::check_world() {
  const std::string text = os::read_whole(run_.log);
  const GazeboLog log = parse_gazebo_log(text);
  auto errors = log.reading_errors;
  if (!log.plugin_error.empty()) errors.push_back(log.plugin_error);
  if (!errors.empty())
    throw Error(ErrorCode::kSetup,
                fmt::format("Gazebo cannot read all of {}: {} (see {})", run_.world.string(),
                            errors.front(), run_.log.string()));
  log_begin_ = text.size();
}

void GazeboServer::fail(const std::string& what) const {
  throw Error(ErrorCode::kSetup, "Gazebo cannot be started: " + what);
}

}  // namespace tether::sim
