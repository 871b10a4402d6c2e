#include <tether/sim_gazebo_plugin/session.h>

namespace tether::gazebo_plugin {

std::string with_idle_camera(const std::string& sdf) {
  const std::size_t end = sdf.rfind("</link>");
  if (end == std::string::npos) return sdf;
  std::string with = sdf;
  with.insert(end,
              "<sensor name='tether_scene' type='camera'><always_on>false</always_on>"
              "<update_rate>1</update_rate><visualize>false</visualize><camera><image><width>16"
              "</width><height>16</height></image></camera></sensor>");
  return with;
}

}  // namespace tether::gazebo_plugin
