#pragma once

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include <gtest/gtest.h>

namespace tether {

/// The hashes of what a test computes, by name.
using GoldenHashes = std::map<std::string, std::uint64_t>;

/// Where `scripts/golden` wants new pictures to look at; empty when it does not run.
inline std::filesystem::path golden_folder() {
  const char* const folder = std::getenv("TETHER_GOLDEN_FOLDER");
  return folder ? folder : "";
}

/// Fails the test unless `file` has these hashes, a line "NAME HASH" for each. `scripts/golden`
/// has it written instead.
inline void expect_golden(const std::filesystem::path& file, const GoldenHashes& hashes) {
  if (!golden_folder().empty()) {
    std::ofstream out(file);
    for (const auto& [name, hash] : hashes) out << name << ' ' << hash << '\n';
    ASSERT_TRUE(out.flush()) << file;
    return;
  }
  GoldenHashes golden;
  std::ifstream in(file);
  std::string name;
  for (std::uint64_t hash = 0; in >> name >> hash;) golden[name] = hash;
  EXPECT_EQ(hashes, golden) << "differs from " << file << "; scripts/golden writes new hashes";
}

}  // namespace tether
