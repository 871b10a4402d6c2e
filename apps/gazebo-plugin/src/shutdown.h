#pragma once

#include <string>

namespace tether::gazebo_plugin {

/// Ends gzserver as an interrupt does, with exit code 0, or with 1 and one line on stderr if
/// `wrong` is not empty. If that takes longer than some seconds, because a thread hangs, the
/// process is ended immediately. Does not block. Any thread; only the first call has an effect.
void shut_down(const std::string& wrong);

}  // namespace tether::gazebo_plugin
