#include "meshes/obj_check.h"

#include <string>

#include <gtest/gtest.h>

#include <tether/base/error.h>

namespace tether::sim {
namespace {

/// The line that is refused; 0: none.
int refused(const std::string& text) try {
  check_obj(text, "a.obj");
  return 0;
} catch (const Error& e) {
  EXPECT_EQ(e.code(), ErrorCode::kBadFile);
  return e.where().line;
}

TEST(ObjCheck, TakesWhatWavefrontFilesHave) {
  EXPECT_EQ(refused("# f\nv 0 0 0\nvn 1 0 0\nf 1 2 3\nf 1/1 2/1 3/1 # f\n"), 0);
  EXPECT_EQ(refused("f 1//2 2//2 3//2\r\nl 1 2\np 1\nf -1/-1/-1 -2/-2/-2 -3/-3/-3"), 0);
  EXPECT_EQ(refused("f 1 2 \\\n 3 4\nusemtl f\n"), 0);
}

TEST(ObjCheck, RefusesElementsWithoutCorners) {
  EXPECT_EQ(refused("v 0 0 0\nf"), 2);
  EXPECT_EQ(refused("usemtl red\n\nf \n"), 3);
  EXPECT_EQ(refused("l\t\n"), 1);
  EXPECT_EQ(refused("f 1 2 \\\n\n"), 2);
  EXPECT_EQ(refused("f 1 x 3\n"), 1);
  EXPECT_EQ(refused("f /1 2 3\n"), 1);
}

}  // namespace
}  // namespace tether::sim
