#pragma once

#include "command.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <tether/base/result.h>
#include <tether/os/file_descriptor.h>

/// Between the group of a board (`tether-exec --group SOCKET --members N`) and the process of each
/// member (`tether-exec --group SOCKET COMMAND`). The member gives its command to the group, which
/// starts it, and gets back how the command ended. So each command has the environment, the folder,
/// the output and the exit code of a process of its own. Signals to the member go on to its
/// command. If either process ends, so does the command.
namespace tether::supervisor {

/// A command that the group is to start.
struct Program {
  std::string uav;  ///< empty: the one that the program names, or the only one
  Command command;  ///< with `descriptors` below
  std::array<os::FileDescriptor, 4> descriptors{};
};
/// From the member, once. Fails with kDisconnected.
Status send_program(int socket, const std::string& uav, const std::vector<std::string>& words);
/// Does not block. Fails with kTimeout if it has not arrived yet, kDisconnected or kProtocol.
Result<Program> receive_program(int socket);

/// From the group, once.
struct CommandEnd {
  int code = 0;         ///< as of `supervise`
  std::string message;  ///< to the user; may be empty
};
void send_end(int socket, const CommandEnd& end);
/// Blocks. None: the group is gone.
std::optional<CommandEnd> receive_end(int socket);

/// From the member, any number of times. Nothing is sent if the group is gone.
void send_signal(int socket, int signal);
/// Does not block. 0: none has arrived. None: the member is gone.
std::optional<int> receive_signal(int socket);

}  // namespace tether::supervisor
