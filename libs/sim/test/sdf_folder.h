#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include <tether/base/error.h>
#include <tether/sim/world.h>

/// SDF files in a folder of their own, and what `load_world` says of them.
namespace tether::sim {

class SdfFolder {
 public:
  SdfFolder() {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    std::string name = std::string(test->test_suite_name()) + "_" + test->name();
    for (char& c : name) c = c == '/' ? '_' : c;
    path_ = std::filesystem::temp_directory_path() /
            ("tether_sim_" + std::to_string(::getpid()) + "_" + name);
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~SdfFolder() { std::filesystem::remove_all(path_); }
  SdfFolder(const SdfFolder&) = delete;
  SdfFolder& operator=(const SdfFolder&) = delete;

  std::filesystem::path write(const std::string& name, const std::string& text) const {
    const std::filesystem::path file = path_ / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file) << text;
    return file;
  }

 private:
  std::filesystem::path path_;
};

/// A world file: `content` begins on line 3.
inline std::string world_sdf(const std::string& content) {
  return "<sdf version='1.7' xmlns:tether='https://tether.dev/sdf'>\n<world name='w'>\n" + content +
         "\n</world>\n</sdf>\n";
}

/// A world with one link of one static model: `content` begins on line 5.
inline std::string link_sdf(const std::string& content) {
  return world_sdf("<model name='m'><static>true</static>\n<link name='l'>\n" + content +
                   "\n</link></model>");
}

struct Loaded {
  World world;
  std::vector<std::string> warnings;
};

inline Loaded load(const WorldRequest& request) {
  Loaded loaded;
  loaded.world =
      load_world(request, [&](const std::string& line) { loaded.warnings.push_back(line); });
  return loaded;
}

/// The message with which `load_world` refuses, "" if it does not.
inline std::string refusal(const WorldRequest& request) {
  try {
    load_world(request, nullptr);
    return "";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kBadFile);
    return error.what();
  }
}

/// `text` with its one occurrence of `from` replaced.
inline std::string with(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

}  // namespace tether::sim
