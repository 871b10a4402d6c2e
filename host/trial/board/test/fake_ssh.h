#pragma once

#include <cstdlib>
#include <string>

#include <tether/base_testing/scratch_folder.h>
#include <tether/scenario/target.h>

namespace tether::board {

/// Replaces `ssh` while it exists: boards are this machine, with a separate lock and folder.
class FakeSsh {
 public:
  FakeSsh() {
    scratch_.write("ssh", R"(for word in "$@"; do
  case $word in
    ControlPath=*) socket=${word#ControlPath=} ;;
    -N) master=1 ;;
    -O) forward=1 ;;
  esac
  last=$word
done
[ -z "${forward-}" ] || exec echo "Allocated port 40123 for remote forward"
[ -z "${master-}" ] || { : >"$socket"; exec sleep 600; }
exec sh -c "$last"
)");
    set("TETHER_SSH", "sh " + scratch_.path("ssh").string());
    set("TETHER_BOARD_LOCK", scratch_.path("lock"));
    set("TMPDIR", scratch_.path());
    set("SSH_CONNECTION", "192.0.2.1 40000 192.0.2.2 22");
  }
  ~FakeSsh() {
    for (const char* name : {"TETHER_SSH", "TETHER_BOARD_LOCK", "TMPDIR", "SSH_CONNECTION"})
      unsetenv(name);
  }
  FakeSsh(const FakeSsh&) = delete;
  FakeSsh& operator=(const FakeSsh&) = delete;

  const ScratchFolder& scratch() const { return scratch_; }
  static scenario::SshAddress address() { return scenario::parse_ssh_address("ssh://pi@board"); }

 private:
  static void set(const char* name, const std::string& value) { setenv(name, value.c_str(), 1); }

  ScratchFolder scratch_;
};

}  // namespace tether::board
