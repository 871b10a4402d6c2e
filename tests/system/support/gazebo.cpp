#include "gazebo.h"

#include "faults.h"

#include <regex>
#include <sstream>
#include <stdexcept>

namespace tether::system_test {

namespace fs = std::filesystem;

Variables stand_in_gazebo(const fs::path& folder, const std::string& mode) {
  const fs::path root = folder / "root", machine = root / "lib/x86_64-linux-gnu";
  fs::create_directories(machine);
  fs::create_symlink(stand_in_program(), machine / "ld-linux-x86-64.so.2");
  fs::create_directories(root / "usr/bin");
  write_text(root / "usr/bin/gzserver", "");
  write_text(root / "libtether_gazebo.so", "");
  return {{"TETHER_GAZEBO_ROOT", root},
          {"TETHER_GAZEBO_PLUGIN", root / "libtether_gazebo.so"},
          {"STAND_IN_MODE", mode}};
}

Command gazebo_run(const fs::path& scenario, const fs::path& out, const Variables& environment,
                   const std::string& mark) {
  return with(
      tether({"run", scenario, "--simulator", "gazebo", "--force", "--out", out, "--quiet"}, mark),
      {}, environment);
}

EndlessFlight::EndlessFlight(const fs::path& folder, const Variables& environment,
                             const std::string& mark, int hang_limit_s)
    : out_(folder / "out") {
  const auto scenario = write_hover_scenario(
      folder, "fly_on",
      {{"time_limit_s = 5", "time_limit_s = 600"},
       {"hang_limit_s = 2", "hang_limit_s = " + std::to_string(hang_limit_s)}});
  process_ = std::make_unique<Process>(
      with(gazebo_run(scenario, out_, environment, mark), {"--real-time-factor", "1"}));
  wait_until_recorded(*process_, out_);
}

std::optional<pid_t> find_process(const std::string& mark, const std::string& part) {
  for (const pid_t pid : processes_with_mark(mark))
    for (const char* words : {"/cmdline", "/comm"})  // a trial of a campaign only has a name
      if (read_text("/proc/" + std::to_string(pid) + words).find(part) != std::string::npos)
        return pid;
  return std::nullopt;
}

fs::path private_folder(const fs::path& out) {
  static const std::regex where("unix:(/tmp/tether-gazebo-[^/]+)/");
  const std::string log = read_text(out / "simulator.log");
  std::smatch match;
  if (!std::regex_search(log, match, where))
    throw std::runtime_error("no folder is named in simulator.log: " + log);
  return match[1].str();
}

bool has_x_lock(pid_t server) {
  for (const auto& entry : fs::directory_iterator("/tmp")) {
    const std::string name = entry.path().filename();
    if (!name.starts_with(".X") || !name.ends_with("-lock")) continue;
    std::istringstream text(read_text(entry.path()));
    pid_t pid = 0;
    if (text >> pid && pid == server) return true;
  }
  return false;
}

}  // namespace tether::system_test
