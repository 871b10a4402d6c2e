#include "meshes/collada_check.h"

#include <string>

#include <gtest/gtest.h>

#include <tether/base_testing/thrown_error.h>

namespace tether::sim {
namespace {

// Node i refers to node i + 1 `times` times.
std::string chain(int nodes, int times) {
  std::string text = "<a>\n<visual_scene>\n<instance_node url='#n0'/></visual_scene>\n";
  for (int i = 0; i < nodes; ++i) {
    text += "<node id='n" + std::to_string(i) + "'>";
    for (int k = 0; k < times; ++k)
      text += "<instance_node url='#n" + std::to_string(i + 1) + "'/>";
    text += "</node>\n";
  }
  return text + "</a>";
}

TEST(ColladaCheck, TakesNodesThatOthersReferTo) {
  for (std::string text : {chain(150, 1), chain(16, 2)}) {
    const std::string before = text;
    check_collada(text, "a.dae");
    EXPECT_EQ(text, before);
  }
}

TEST(ColladaCheck, ChangesWhatAssimpRefuses) {
  std::string text =
      "<a><vertices><!-- b --><input/></vertices><image id='i'/><color>\n 1 0 0 1</color></a>";
  check_collada(text, "a.dae");
  EXPECT_EQ(text.find("<!--"), std::string::npos);
  EXPECT_NE(text.find("<init_from>no file</init_from>"), std::string::npos);
  EXPECT_NE(text.find("<input/>"), std::string::npos);
  EXPECT_NE(text.find("<color>1 0 0 1</color>"), std::string::npos);
}

TEST(ColladaCheck, RefusesCirclesDepthAndMultiplication) {
  const std::string circle =
      "<a><visual_scene>\n<node name='n'><node>\n<instance_node url='#n'/>"
      "</node></node></visual_scene></a>";
  for (std::string text : {chain(210, 1), chain(20, 2), circle}) {
    const Error error = bad_file_error([&] { check_collada(text, "a.dae"); });
    EXPECT_EQ(error.where().file, "a.dae");
    EXPECT_GT(error.where().line, 1);
  }
}

TEST(ColladaCheck, RefusesWhatIsNotXml) {
  for (std::string text : {"", "PK", "<a><b></a>", "<!-- a -->"}) {
    EXPECT_EQ(bad_file_error([&] { check_collada(text, "a.dae"); }).where().file, "a.dae");
  }
}

}  // namespace
}  // namespace tether::sim
