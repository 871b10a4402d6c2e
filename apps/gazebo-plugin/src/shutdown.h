#pragma once

#include <string>

namespace tether::gazebo_plugin {

/// Ends gzserver as an interrupt does, with exit code 0, or with 1 and one line on stderr where
/// something was wrong. If that takes longer than some seconds, because a thread of it hangs, the
/// process is ended on the spot. Returns at once. Any thread; only the first call counts.
void shut_down(const std::string& wrong);

}  // namespace tether::gazebo_plugin
