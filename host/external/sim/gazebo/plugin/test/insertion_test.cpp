#include <gtest/gtest.h>

#include <tether/sim_gazebo_plugin/session.h>

namespace tether::gazebo_plugin {
namespace {

TEST(Insertion, PutsTheIdleCameraOnTheLink) {
  const std::string sdf = "<sdf><model name='a'><link name='base_link'><x/></link></model></sdf>";
  const std::string with = with_idle_camera(sdf);
  const std::size_t sensor = with.find("<sensor ");
  ASSERT_NE(sensor, std::string::npos);
  EXPECT_LT(with.find("<x/>"), sensor);
  EXPECT_LT(with.find("</sensor>"), with.find("</link>"));
  EXPECT_NE(with.find("<always_on>false"), std::string::npos);
}

TEST(Insertion, LeavesAloneWhatHasNoLink) {
  EXPECT_EQ(with_idle_camera("<sdf/>"), "<sdf/>");
}

}  // namespace
}  // namespace tether::gazebo_plugin
