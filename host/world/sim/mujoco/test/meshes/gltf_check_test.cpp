#include "meshes/gltf_check.h"

#include <string>

#include <gtest/gtest.h>

#include <tether/base_testing/thrown_error.h>

namespace tether::sim {
namespace {

TEST(GltfCheck, TakesSizesThatTheFileHas) {
  check_gltf(R"({"buffers":[{"byteLength":36}],"accessors":[{"count":3}]})", 100, "a.gltf");
}

TEST(GltfCheck, RefusesSizesThatTheFileHasNotAndWhatIsNoJson) {
  std::string deep;
  for (int i = 0; i < 100; ++i) deep += R"({"a":)";
  for (const std::string& text :
       {std::string(R"({"buffers":[{"byteLength":101}]})"), std::string(R"({"count":-1})"),
        std::string(R"({"count":1e9})"), std::string(R"({"byteOffset":"a"})"), std::string("[]"),
        std::string("{"), std::string("glTF"), "glTF" + std::string(16, '\x7f'), deep})
    EXPECT_EQ(bad_file_error([&] { check_gltf(text, 100, "a.gltf"); }).where().file, "a.gltf")
        << text.substr(0, 50);
}

}  // namespace
}  // namespace tether::sim
