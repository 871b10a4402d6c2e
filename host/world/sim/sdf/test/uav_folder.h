#pragma once

#include "sdf_folder.h"

#include <string>
#include <vector>

/// UAV models as tests write them.
namespace tether::sim {

/// A UAV as a test writes it; `with` changes parts of it.
inline const std::string kUav = R"(<sdf version='1.7' xmlns:tether='https://tether.dev/sdf'>
<model name='drone'>
<tether:multirotor>
<rotor><position_m>0.2 0 0</position_m><direction>cw</direction></rotor>
<rotor><position_m>0 0.2 0</position_m><direction>ccw</direction></rotor>
<rotor><position_m>-0.2 0 0</position_m><direction>cw</direction></rotor>
<rotor><position_m>0 -0.2 0</position_m><direction>ccw</direction></rotor>
<thrust_coefficient_N_s2>1e-5</thrust_coefficient_N_s2>
<moment_coefficient_m>0.02</moment_coefficient_m>
<rotor_drag_N_s2_per_m>0</rotor_drag_N_s2_per_m>
<linear_drag_N_s_per_m>0.25</linear_drag_N_s_per_m>
<max_rotor_speed_rad_s>900</max_rotor_speed_rad_s>
<time_constant_up_s>0.01</time_constant_up_s>
<time_constant_down_s>0.02</time_constant_down_s>
<max_tilt_rad>0.5</max_tilt_rad>
<max_horizontal_speed_m_s>4</max_horizontal_speed_m_s>
<max_vertical_speed_m_s>3</max_vertical_speed_m_s>
<max_yaw_rate_rad_s>2</max_yaw_rate_rad_s>
</tether:multirotor>
<link name='body'>
<inertial><mass>1.5</mass><inertia><ixx>0.01</ixx><iyy>0.02</iyy><izz>0.025</izz></inertia></inertial>
<sensor name='eye' type='camera'><pose>0.1 0 0 0 0.5 0</pose><update_rate>25</update_rate>
<camera><pose>0 0 0.05 0 0 0</pose><horizontal_fov>1.5</horizontal_fov>
<image><width>320</width><height>240</height></image><clip><near>0.1</near><far>20</far></clip>
<distortion><k1>-0.2</k1><p2>0.01</p2></distortion>
</camera></sensor>
<sensor name='nose' type='ray'><update_rate>10</update_rate>
<ray><scan><horizontal><samples>1</samples><resolution>1</resolution><min_angle>0</min_angle><max_angle>0</max_angle></horizontal></scan>
<range><min>0.1</min><max>5</max><resolution>0.01</resolution></range>
<noise><type>gaussian</type><mean>0.5</mean><stddev>0.25</stddev></noise></ray></sensor>
</link>
</model>
</sdf>
)";

/// Loads a UAV into an empty world.
class UavModel : public ::testing::Test {
 protected:
  WorldRequest request(const std::string& model) const {
    return {folder_.write("w.sdf", world_sdf("")),
            {{"uav", folder_.write("uav.sdf", model), {}, 0.0}},
            {}};
  }
  Uav read(const std::string& model) const { return load(request(model)).world.uavs.at(0); }
  std::vector<std::string> warnings(const std::string& model) const {
    std::vector<std::string> lines;
    for (const Warning& warning : load(request(model)).warnings) lines.push_back(to_line(warning));
    return lines;
  }

  ScratchFolder folder_;
};

/// A change of kUav that makes it unusable, and the place and subject of the error.
struct BadUav {
  const char* from;
  const char* to;
  int line;
  const char* subject;
};

class BadUavs : public UavModel {
 protected:
  void expect_refused(const std::vector<BadUav>& cases) const {
    for (const BadUav& bad : cases) {
      SCOPED_TRACE(bad.to);
      expect_error(refusal(request(with(kUav, bad.from, bad.to))), folder_.path("uav.sdf"),
                   bad.line, bad.subject);
    }
  }
};

}  // namespace tether::sim
