#include <array>
#include <chrono>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <tether/base/error.h>
#include <tether/os/child_process.h>
#include <tether/os/file_descriptor.h>
#include <tether/os/text_file.h>
#include <tether/runner/trial_server.h>

// Campaign and server exchange whole messages through a socket, which is the server's standard
// input. A message is the trial's log, a zero byte, and its request as JSON; the reply says how the
// trial ended. "stop" asks to end the trial that is running. Each side notices by the end of the
// stream that the other one has ended.
namespace tether::runner {

namespace {

constexpr Duration kPollPeriod = std::chrono::milliseconds(50);
constexpr char kEnd = '\0';
constexpr std::string_view kStop = "stop";

/// Waits for a message at most that long. None: there is none yet; empty: the other side has ended.
std::optional<std::string> receive(int socket, Duration limit) {
  pollfd readable{socket, POLLIN, 0};
  const auto limit_ms = std::chrono::duration_cast<std::chrono::milliseconds>(limit).count();
  if (poll(&readable, 1, static_cast<int>(limit_ms)) <= 0) return std::nullopt;
  std::string message(std::size_t{1} << 17, kEnd);
  const ssize_t length = recv(socket, message.data(), message.size(), 0);
  message.resize(length > 0 ? static_cast<std::size_t>(length) : 0);
  return message;
}

bool send_message(int socket, std::string_view text) {
  return send(socket, text.data(), text.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(text.size());
}

/// The second attempt keeps the log of the first.
std::filesystem::path log_file(const std::filesystem::path& folder) {
  const std::filesystem::path first = folder / campaign::kTrialLog;
  return std::filesystem::exists(first) ? folder / campaign::kSecondTrialLog : first;
}

os::Pipe make_sockets() {
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) != 0)
    throw Error(ErrorCode::kSetup, "cannot start a trial: no socket: " + reason_of(errno));
  return {os::FileDescriptor(ends[0]), os::FileDescriptor(ends[1])};
}

}  // namespace

class TrialServers::Server {
 public:
  /// @param body of a copy of this process; none: a new process.
  explicit Server(const std::function<int()>& body = {}) : Server(make_sockets(), body) {}

  /// How a trial ended; none: the server has ended before that.
  std::optional<std::string> run(const std::string& request, const std::stop_token& stop) {
    if (!send_message(socket_.get(), request)) return std::nullopt;
    for (bool is_stopping = false;;) {
      const std::optional<std::string> reply = receive(socket_.get(), kPollPeriod);
      if (reply) return reply->empty() ? std::nullopt : reply;
      if (stop.stop_requested() && !std::exchange(is_stopping, true))
        send_message(socket_.get(), kStop);
    }
  }
  std::string end() {
    process_.wait(std::chrono::seconds(1));
    const auto& exit = process_.poll();
    return exit ? exit->description : "did not answer";
  }

 private:
  // It notices our end by the socket: it may be started by a thread that ends before this process.
  // A copy first closes its copies of both ends, or it would not.
  Server(os::Pipe sockets, const std::function<int()>& body)
      : process_(
            {.arguments = body ? std::vector<std::string>{"trials"}
                               : std::vector{os::own_file().string(), std::string(kServeTrials)},
             .environment = {},
             .log = {},
             .input_pipe = sockets.read_end.get(),
             .death_signal = 0,
             .body = body ? [&] {
               sockets = {};
               return body();
             } : body}),
        socket_(std::move(sockets.write_end)) {}

  os::ChildProcess process_;
  os::FileDescriptor socket_;
};

TrialServers::TrialServers() = default;
TrialServers::~TrialServers() = default;

// A server also holds our ends of the sockets of those before it, which therefore end after it.
void TrialServers::start(int count, const TrialService& service) {
  for (int i = 0; i < count; ++i)
    idle_.push_back(std::make_unique<Server>([&] { return serve_trials(service); }));
}

std::unique_ptr<TrialServers::Server> TrialServers::take() {
  const std::lock_guard lock(mutex_);
  if (idle_.empty()) return std::make_unique<Server>();
  std::unique_ptr<Server> server = std::move(idle_.back());
  idle_.pop_back();
  return server;
}

std::optional<campaign::TrialResult> TrialServers::run(const TrialRequest& request,
                                                       const std::stop_token& stop) {
  const std::filesystem::path& folder = request.folder;
  const std::filesystem::path log = log_file(folder);
  std::unique_ptr<Server> server = take();
  const std::optional<std::string> end = server->run(log.string() + kEnd + to_json(request), stop);
  const std::string how = end ? *end : "was lost with its server, which " + server->end();
  if (end) {
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(server));
  }
  if (stop.stop_requested()) return std::nullopt;
  if (std::filesystem::exists(folder / campaign::kResultFile)) return campaign::read_result(folder);
  const std::string why = os::last_line(os::read_whole(log));
  throw Error(ErrorCode::kSetup, fmt::format("the trial left no result: it {}{}; see {}", how,
                                             why.empty() ? "" : ": " + why, log.string()));
}

campaign::TrialResult TrialServers::run(const campaign::TrialPlan& plan,
                                        const std::stop_token& stop) {
  if (auto result = run(request_of(plan), stop)) return std::move(*result);
  return interrupted(plan);
}

campaign::TrialResult interrupted(const campaign::TrialPlan& plan) {
  auto result = campaign::make_setup_failure(*plan.scenario, *plan.condition, plan.seed,
                                             "interrupted by the user");
  result.end = campaign::kEndInterrupted;
  return result;
}

namespace {

/// Runs one trial in a copy of this process. @return how it ended.
std::string run_copy(const TrialService& service, const std::string& message) try {
  const std::size_t end_of_log = message.find(kEnd);
  const TrialRequest request =
      parse_trial_request(std::string_view(message).substr(end_of_log + 1));
  service.prepare(request);
  // The grace period lets it end its own processes.
  os::ChildProcess trial({.arguments = {request.folder.filename().string()},
                          .environment = {},
                          .log = message.substr(0, end_of_log),
                          .grace = std::chrono::seconds(10),
                          .body = [&] { return service.run(request); }});
  while (!trial.wait(kPollPeriod)) {
    const auto asked = receive(STDIN_FILENO, Duration(0));
    if (asked && asked->empty()) _exit(exit_code(ErrorCode::kSetup));  // ends the trial, too
    if (asked) trial.terminate();
  }
  return trial.poll()->description;
} catch (const Error& e) {
  return std::string("could not be started: ") + e.what();
}

}  // namespace

int serve_trials(const TrialService& service) {
  constexpr Duration kForever = std::chrono::hours(1);
  for (;;) {
    const std::optional<std::string> request = receive(STDIN_FILENO, kForever);
    if (!request || *request == kStop) continue;
    if (request->empty()) return 0;
    if (!send_message(STDIN_FILENO, run_copy(service, *request))) return 0;
  }
}

}  // namespace tether::runner
