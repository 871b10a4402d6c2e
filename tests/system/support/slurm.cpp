#include "slurm.h"

#include "files.h"

#include <csignal>
#include <sstream>
#include <stdexcept>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <pwd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <tether/os/file_descriptor.h>
#include <tether/os/process_table.h>

namespace tether::system_test {
namespace {

using namespace std::chrono_literals;

enum Daemon { kMunge, kController, kNode1, kNode2 };

/// Ports that are free now, all different.
std::vector<int> free_ports(std::size_t count) {
  std::vector<os::FileDescriptor> sockets;
  std::vector<int> ports;
  for (std::size_t i = 0; i < count; ++i) {
    sockets.emplace_back(::socket(AF_INET, SOCK_STREAM, 0));
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    auto* any = reinterpret_cast<sockaddr*>(&address);
    if (::bind(sockets.back().get(), any, size) != 0 ||
        ::getsockname(sockets.back().get(), any, &size) != 0)
      throw std::runtime_error("no port");
    ports.push_back(ntohs(address.sin_port));
  }
  return ports;
}

std::string host_name() {
  char name[256] = "";
  (void)::gethostname(name, sizeof name - 1);
  return name;
}

std::string config(const std::filesystem::path& folder) {
  const passwd* user = ::getpwuid(::geteuid());
  const std::string own = user ? user->pw_name : "root", host = host_name(), at = folder.string();
  const std::vector<int> ports = free_ports(3);
  std::ostringstream text;
  text << "ClusterName=test\nSlurmctldHost=" << host << "(127.0.0.1)\nSlurmUser=" << own
       << "\nSlurmdUser=" << own
       << "\nAuthType=auth/munge\nCredType=cred/munge\nAuthInfo=socket=" << at
       << "/munge.socket\nStateSaveLocation=" << at << "/state\nSlurmdSpoolDir=" << at
       << "/spool-%n\nSlurmctldPidFile=" << at << "/slurmctld.pid\nSlurmdPidFile=" << at
       << "/slurmd-%n.pid\nSlurmctldPort=" << ports[0]
       << "\nProctrackType=proctrack/linuxproc\nTaskPlugin=task/none\nSelectType=select/cons_tres\n"
          "SelectTypeParameters=CR_CPU\nMpiDefault=none\nReturnToService=2\nSlurmdTimeout=5\n"
          "KillWait=5\nSchedulerParameters=sched_interval=1,batch_sched_delay=0\n";
  for (int node = 1; node <= 2; ++node)
    text << "NodeName=n" << node << " NodeHostname=" << host
         << " NodeAddr=127.0.0.1 Port=" << ports[static_cast<std::size_t>(node)] << " CPUs=1\n";
  text << "PartitionName=all Nodes=n1,n2 Default=YES State=UP\n";
  return text.str();
}

}  // namespace

bool SlurmCluster::is_installed() {
  for (const char* program : {"/usr/sbin/slurmctld", "/usr/sbin/slurmd", "/usr/sbin/munged"})
    if (::access(program, X_OK) != 0) return false;
  return true;
}

SlurmCluster::SlurmCluster(const std::filesystem::path& folder)
    : folder_(folder), conf_(folder / "slurm.conf") {
  for (const char* name : {"state", "spool-n1", "spool-n2"})
    std::filesystem::create_directories(folder / name);
  write_text(folder / "munge.key", std::string(64, 'k'));
  std::filesystem::permissions(folder / "munge.key", std::filesystem::perms(0600));
  std::filesystem::permissions(folder, std::filesystem::perms(0755));
  write_text(conf_, config(folder));
  const std::string at = folder.string() + "/munge.";
  daemons_[kMunge] = std::make_unique<os::ChildProcess>(
      os::ChildCommand{.arguments = {"/usr/sbin/munged", "--foreground", "--force",
                                     "--key-file=" + at + "key", "--socket=" + at + "socket",
                                     "--pid-file=" + at + "pid", "--seed-file=" + at + "seed"},
                       .environment = {},
                       .log = folder / "munged.log"});
  (void)wait_until([&] { return std::filesystem::exists(at + "socket"); });
  daemons_[kController] = std::make_unique<os::ChildProcess>(
      os::ChildCommand{.arguments = {"/usr/sbin/slurmctld", "-D", "-f", conf_},
                       .environment = {},
                       .log = folder / "slurmctld.log"});
  start_node("n1");
  start_node("n2");
  const bool is_up = wait_until([&] {
    return run(in({{"sinfo", "--noheader", "--format=%D %T"}})).out == "2 idle\n";
  });
  if (!is_up)
    throw std::runtime_error("Slurm does not come up: " + read_text(folder / "munged.log") +
                             read_text(folder / "slurmctld.log") +
                             read_text(folder / "slurmd-n1.log"));
}

SlurmCluster::~SlurmCluster() {
  (void)run(in({{"scancel", "--state=PENDING", "--user=" + std::to_string(::geteuid())}}));
  for (const char* node : {"n1", "n2"}) lose_node(node);
}

void SlurmCluster::start_node(const std::string& node) {
  daemons_[node == "n1" ? kNode1 : kNode2] = std::make_unique<os::ChildProcess>(
      os::ChildCommand{.arguments = {"/usr/sbin/slurmd", "-D", "-N", node, "-f", conf_},
                       .environment = {{"TETHER_TEST_MARK", folder_.string() + node}},
                       .log = folder_ / ("slurmd-" + node + ".log"),
                       .appends = true});
}

Command SlurmCluster::in(Command command) const {
  return with(std::move(command), {}, {{"SLURM_CONF", conf_}});
}

std::vector<std::string> SlurmCluster::running() const {
  std::istringstream lines(
      run(in({{"squeue", "--noheader", "--array", "--states=RUNNING", "--format=%i %N"}})).out);
  std::vector<std::string> tasks;
  for (std::string line; std::getline(lines, line);) tasks.push_back(line);
  return tasks;
}

void SlurmCluster::lose_node(const std::string& node) {
  // What slurmd started knows its node by a variable; slurmd itself is this process's child.
  for (const pid_t process : os::all_processes()) {
    const std::string variables = '\0' + read_text("/proc/" + std::to_string(process) + "/environ");
    if (variables.find('\0' + ("SLURM_CONF=" + conf_) + '\0') != std::string::npos &&
        variables.find('\0' + ("SLURMD_NODENAME=" + node) + '\0') != std::string::npos)
      ::kill(process, SIGKILL);
  }
  auto& slurmd = daemons_[node == "n1" ? kNode1 : kNode2];
  if (slurmd) ::kill(slurmd->pid(), SIGKILL);
  slurmd.reset();
}

void SlurmCluster::wait_until_idle() const {
  (void)wait_until([&] { return run(in({{"squeue", "--noheader"}})).out.empty(); });
}

}  // namespace tether::system_test
