#pragma once

#include <ostream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tether/base/error.h>
#include <tether/base_testing/scratch_folder.h>
#include <tether/base_testing/thrown_error.h>
#include <tether/sim/world.h>
#include <tether/sim_sdf/load_world.h>

/// SDF files for a scratch folder, and the results of `load_world` for them.
namespace tether {

inline void PrintTo(const Warning& warning, std::ostream* out) {
  *out << name(warning.consequence) << ": " << to_line(warning);
}

}  // namespace tether

namespace tether::sim {

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
  std::vector<Warning> warnings;
};

inline Loaded load(const WorldRequest& request) {
  Loaded loaded;
  loaded.world =
      load_world(request, [&](const Warning& warning) { loaded.warnings.push_back(warning); });
  return loaded;
}
/// The same for a world file with that content from line 3 on.
inline Loaded load_content(const std::string& content) {
  const ScratchFolder folder;
  return load({folder.write("w.sdf", world_sdf(content)), {}, {}});
}

/// The error with which `load_world` refuses, read strictly.
inline Error refusal(WorldRequest request) {
  request.options.is_strict = true;
  return bad_file_error([&] { load_world(request, nullptr); });
}

/// Matches a warning by its fields; its message is free.
inline auto is_warning(Consequence consequence, const std::filesystem::path& file, int line,
                       const std::string& subject) {
  using ::testing::Field;
  return ::testing::AllOf(Field("consequence", &Warning::consequence, consequence),
                          Field("where", &Warning::where, FileLocation{file.string(), line}),
                          Field("subject", &Warning::subject, subject));
}

inline void expect_error(const Error& error, const std::filesystem::path& file, int line,
                         const std::string& subject) {
  EXPECT_EQ(error.where().file, file.string()) << error.what();
  EXPECT_EQ(error.where().line, line) << error.what();
  EXPECT_EQ(error.subject(), subject) << error.what();
}

/// `text` with its one occurrence of `from` replaced.
inline std::string with(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

}  // namespace tether::sim
