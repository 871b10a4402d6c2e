#include "board.h"

#include <algorithm>
#include <csignal>
#include <fstream>
#include <stdexcept>
#include <thread>

#include <arpa/inet.h>
#include <fcntl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

namespace tether::system_test {
namespace {

using namespace std::chrono_literals;

/// Free now. If another program takes it first, the server fails, and another port is tried.
std::uint16_t free_port() {
  const int fd = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  bind(fd, reinterpret_cast<const sockaddr*>(&address), size);
  getsockname(fd, reinterpret_cast<sockaddr*>(&address), &size);
  close(fd);
  return ntohs(address.sin_port);
}

void make_key(const std::filesystem::path& file) {
  const Output made =
      run({.arguments = {"ssh-keygen", "-q", "-t", "ed25519", "-N", "", "-f", file.string()},
           .environment = {},
           .working_folder = {}});
  if (made.code != 0) throw std::runtime_error("ssh-keygen: " + made.err);
}

/// The parent of each process whose name is `name`.
std::vector<std::pair<pid_t, pid_t>> children_named(const std::string& name) {
  std::vector<std::pair<pid_t, pid_t>> found;
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    const std::string stat = read_text(entry.path() / "stat");
    const auto open = stat.find('('), close = stat.rfind(')');
    if (open == std::string::npos || stat.substr(open + 1, close - open - 1) != name) continue;
    found.emplace_back(std::stoi(stat), std::stoi(stat.substr(close + 4)));
  }
  return found;
}

}  // namespace

SshBoard::SshBoard(const std::string& mark) {
  // The server insists on it when root starts it.
  if (geteuid() == 0) std::filesystem::create_directories("/run/sshd");
  for (const char* name : {"tmp", "bin"}) std::filesystem::create_directory(folder_ / name);
  make_key(folder_ / "host_key");
  make_key(folder_ / "user_key");
  std::filesystem::copy_file(folder_ / "user_key.pub", folder_ / "authorized_keys");
  for (int attempt = 0; attempt < 5; ++attempt) {
    port_ = free_port();
    write_settings(mark);
    server_ = std::make_unique<Process>(Command{
        .arguments = {"/usr/sbin/sshd", "-D", "-e", "-f", (folder_ / "sshd_config").string()},
        .environment = {},
        .working_folder = {}});
    if (server_->wait_for_err("Server listening", 10s)) break;
  }
  if (server_->has_ended()) throw std::runtime_error("sshd: " + server_->err());
  address_ = "ssh://127.0.0.1:" + std::to_string(port_);
}

SshBoard::~SshBoard() {
  cut_connections();
}

void SshBoard::write_settings(const std::string& mark) {
  const std::string port = std::to_string(port_);
  write_text(folder_ / "sshd_config",
             "ListenAddress 127.0.0.1\nPort " + port + "\nHostKey " +
                 (folder_ / "host_key").string() + "\nAuthorizedKeysFile " +
                 (folder_ / "authorized_keys").string() +
                 "\nStrictModes no\nUsePAM no\nPidFile none\nPermitRootLogin yes\n"
                 "PasswordAuthentication no\nKbdInteractiveAuthentication no\n"
                 "MaxStartups 50\nSetEnv TETHER_TEST_MARK=" +
                 mark + " TETHER_BOARD_LOCK=" + (folder_ / "lock").string() +
                 // Its shells do not read what this machine's shells read first.
                 " HOME=" + folder_.path().string() + " TMPDIR=" + (folder_ / "tmp").string() +
                 " PATH=" + (folder_ / "bin").string() + ":/usr/local/bin:/usr/bin:/bin\n");
  std::string key = read_text(folder_ / "host_key.pub");
  write_text(folder_ / "known_hosts", "[127.0.0.1]:" + port + " " + key);
  write_text(folder_ / "ssh_config",
             "Host *\nIdentityFile " + (folder_ / "user_key").string() +
                 "\nIdentitiesOnly yes\nUserKnownHostsFile " + (folder_ / "known_hosts").string() +
                 "\nGlobalKnownHostsFile none\nStrictHostKeyChecking yes\n");
}

std::string SshBoard::ssh() const {
  return "ssh -F " + (folder_ / "ssh_config").string();
}

std::vector<std::pair<std::string, std::string>> SshBoard::environment() const {
  return {{"TETHER_SSH", ssh()}};
}

void SshBoard::install(const std::string& name, const std::filesystem::path& program) const {
  std::filesystem::create_symlink(program, folder_.path("bin") / name);
}

void SshBoard::install_text(const std::string& name, const std::string& text) const {
  const auto file = folder_.path("bin") / name;
  write_text(file, text);
  chmod(file.c_str(), 0755);
}

void SshBoard::cut_connections() const {
  // The listener's children, and their children where privileges are split.
  std::vector<pid_t> sessions;
  const auto servers = children_named("sshd");
  std::vector<pid_t> parents{server_->pid()};
  while (!parents.empty()) {
    const pid_t parent = parents.back();
    parents.pop_back();
    for (const auto& [pid, its_parent] : servers)
      if (its_parent == parent) {
        sessions.push_back(pid);
        parents.push_back(pid);
      }
  }
  for (const pid_t session : sessions) kill(session, SIGKILL);
}

}  // namespace tether::system_test
