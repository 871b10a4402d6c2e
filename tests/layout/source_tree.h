#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

/// The repository's files as the layout rules see them (docs/design.md, section 4).
namespace tether::layout {

/// Where in a library (or beside all of them) a file stands.
enum class Role {
  kPublicHeader,  ///< SIDE/<lib>/include
  kSource,        ///< SIDE/<lib>/src, private headers too
  kTesting,       ///< SIDE/<lib>/testing: fakes for others' tests
  kTest,          ///< SIDE/<lib>/test, apps/<program>/test
  kProgram,       ///< apps
  kOther,         ///< tests, bench
};

struct SourceFile {
  std::string path;  ///< relative to the repository, with '/'
  std::string
      library;  ///< name as in `#include <tether/NAME/…>`; empty outside of common, target and host
  Role role = Role::kOther;
  std::string text;

  /// Neither a test nor a fake nor a benchmark: what the product is made of.
  bool is_product() const {
    return role == Role::kPublicHeader || role == Role::kSource || role == Role::kProgram;
  }
  bool is_header() const { return path.ends_with(".h") || path.ends_with(".hpp"); }
};

/// Library and role of a path, with the nested library of host/sim/mujoco told apart from host/sim.
SourceFile classify(const std::string& path);

/// Every .h and .cpp below common, target, host, apps, tests and bench, sorted by path.
std::vector<SourceFile> read_sources(const std::filesystem::path& root);

/// Files below `root` that people read or write (sources, scripts, Markdown, CMake, data), sorted;
/// without build trees, installed packages and hidden folders other than .ci.
std::vector<std::filesystem::path> text_files(const std::filesystem::path& root);

/// For messages; empty where there is none.
std::string one_per_line(const std::vector<std::string>& texts);

std::string read_text(const std::filesystem::path& file);

}  // namespace tether::layout
