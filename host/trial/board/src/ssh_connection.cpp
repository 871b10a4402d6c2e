#include <cctype>
#include <charconv>
#include <chrono>
#include <cstdlib>
#include <sstream>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include <tether/base/error.h>
#include <tether/board/board.h>
#include <tether/os/child_process.h>
#include <tether/os/text_file.h>

/// The connection is a master process of ssh, whose socket further ssh processes share. Failures
/// are explained from the last line of its stderr.
namespace tether::board {

namespace {

constexpr Duration kConnectLimit = std::chrono::seconds(40);
constexpr Duration kForwardLimit = std::chrono::seconds(10);
constexpr Duration kPollPeriod = std::chrono::milliseconds(10);

/// `ssh`, or the value of TETHER_SSH.
std::vector<std::string> ssh_words() {
  const char* given = std::getenv("TETHER_SSH");
  std::istringstream text(given && *given ? given : "ssh");
  std::vector<std::string> words;
  for (std::string word; text >> word;) words.push_back(word);
  if (words.empty()) words.emplace_back("ssh");
  return words;
}

void append(std::vector<std::string>& words, std::initializer_list<std::string> more) {
  words.insert(words.end(), more);
}

bool contains(const std::string& text, std::string_view part) {
  return text.find(part) != std::string::npos;
}

std::string advice(const std::string& output, const scenario::SshAddress& address) {
  const std::string by_hand = fmt::format(
      "ssh {}{}", address.port ? fmt::format("-p {} ", address.port) : "", address.destination);
  if (contains(output, "IDENTIFICATION HAS CHANGED") || contains(output, "has changed"))
    return fmt::format(
        "the key of the board has changed; if the board was reinstalled, type: ssh-keygen -R {}",
        address.destination.substr(address.destination.rfind('@') + 1));
  if (contains(output, "Host key verification failed"))
    return fmt::format("the key of the board is unknown; connect once manually: {}", by_hand);
  if (contains(output, "Permission denied"))
    return fmt::format("copy your key to the board: ssh-copy-id {}{}",
                       address.port ? fmt::format("-p {} ", address.port) : "",
                       address.destination);
  if (contains(output, "Could not resolve"))
    return "check the name of the board, or use its address";
  if (contains(output, "Connection refused"))
    return "start an SSH server on the board, or pass its port";
  if (contains(output, "timed out") || contains(output, "No route"))
    return "check that the board is on and in the same network";
  return "try: " + by_hand;
}

}  // namespace

std::string explain_ssh(const std::string& output, const scenario::SshAddress& address) {
  const std::string last = os::last_line(output);
  return fmt::format("{}; {}", last.empty() ? "no message from ssh" : last,
                     advice(output, address));
}

SshConnection::SshConnection(const scenario::SshAddress& address, std::stop_token stop)
    : address_(address),
      stop_(std::move(stop)),
      folder_("tether-ssh-", "/tmp") {  // the path of a socket must be short
  connect();
}

std::vector<std::string> SshConnection::words() const {
  std::vector<std::string> words = ssh_words();
  append(words, {"-T", "-x", "-a", "-o", "BatchMode=yes", "-o",
                 "ControlPath=" + (folder_ / "socket").string(), "-o", "RemoteCommand=none"});
  if (address_.port != 0) append(words, {"-p", std::to_string(address_.port)});
  return words;
}

void SshConnection::connect() {
  std::vector<std::string> command = words();
  append(command,
         {"-N", "-o", "ControlMaster=yes", "-o", "ControlPersist=no", "-o", "ConnectTimeout=10",
          "-o", "ServerAliveInterval=3", "-o", "ServerAliveCountMax=3", "-o",
          "ClearAllForwardings=yes", "-o", "LogLevel=INFO", "--", address_.destination});
  master_ = std::make_unique<os::ChildProcess>(os::ChildCommand{.arguments = command,
                                                                .environment = {},
                                                                .log = folder_ / "master.out",
                                                                .errors = folder_ / "master.err"});
  const auto started = std::chrono::steady_clock::now();
  while (!std::filesystem::exists(folder_ / "socket")) {
    const std::string where = scenario::to_string(address_);
    if (stop_.stop_requested()) throw Error(ErrorCode::kSetup, "interrupted by the user");
    if (master_->wait(kPollPeriod))
      throw Error(ErrorCode::kSetup,
                  fmt::format("cannot reach {}: {}", where,
                              explain_ssh(os::read_whole(folder_ / "master.err"), address_)))
          .about(where);
    if (std::chrono::steady_clock::now() - started > kConnectLimit)
      throw Error(
          ErrorCode::kSetup,
          fmt::format("cannot reach {}: no connection within {} s", where,
                      std::chrono::duration_cast<std::chrono::seconds>(kConnectLimit).count()))
          .about(where);
  }
}

std::vector<std::string> SshConnection::shell(std::size_t script_bytes) const {
  std::vector<std::string> command = words();
  // Without the proxy command, ssh would open a new connection if the master has ended.
  append(command,
         {"-o", "ControlMaster=no", "-o", "ProxyCommand=false", "-o", "LogLevel=ERROR", "--",
          address_.destination,
          fmt::format("exec sh -c 'eval \"$(dd bs=1 count={} 2>/dev/null)\"'", script_bytes)});
  return command;
}

os::Captured SshConnection::run(std::string_view script, Duration limit, std::string_view input,
                                bool is_cleanup) const {
  return os::run_captured(shell(script.size()), std::string(script) + std::string(input), limit,
                          is_cleanup ? std::stop_token() : stop_);
}

std::optional<std::string> SshConnection::lost(Duration limit) {
  if (!master_->wait(limit)) return std::nullopt;
  std::string said = os::last_line(os::read_whole(folder_ / "master.err"));
  if (said.ends_with('.')) said.pop_back();
  return fmt::format("the connection to {} was lost{}", scenario::to_string(address_),
                     said.empty() ? "" : ": " + said);
}

std::uint16_t SshConnection::forward_back(std::uint16_t local_port) const {
  std::vector<std::string> command = words();
  append(command, {"-O", "forward", "-R", fmt::format("127.0.0.1:0:127.0.0.1:{}", local_port), "--",
                   address_.destination});
  const os::Captured said = os::run_captured(command, "", kForwardLimit, stop_);
  // "Allocated port 40123 for remote forward to …", or the number alone.
  const auto digits = said.out.find_first_of("0123456789");
  std::uint16_t port = 0;
  if (digits != std::string::npos)
    std::from_chars(said.out.data() + digits, said.out.data() + said.out.size(), port);
  if (said.code != 0 || port == 0)
    throw Error(ErrorCode::kSetup,
                fmt::format("{} does not forward a port ({}). Allow it with AllowTcpForwarding in "
                            "sshd_config, or do not use --tunnel",
                            scenario::to_string(address_), os::last_line(said.err + said.out)))
        .about(scenario::to_string(address_));
  return port;
}

}  // namespace tether::board
