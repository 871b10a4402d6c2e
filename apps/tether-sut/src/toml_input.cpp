#include "toml_input.h"

#include <cstddef>
#include <fstream>

namespace tether::sut {
namespace {

constexpr std::size_t kLargestFile = std::size_t{1} << 20;

}  // namespace

int line_of(const toml::node& node) {
  return static_cast<int>(node.source().begin.line);
}

int line_of(const toml::key& key) {
  return static_cast<int>(key.source().begin.line);
}

Result<std::string> read_text(const std::string& path, const std::string& what) {
  std::ifstream file(path, std::ios::binary);
  std::string text(kLargestFile + 1, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (file.bad() || !file.eof()) {
    return Failure{Failure::Kind::kInvalid, path + ": cannot be read, or is no " + what};
  }
  text.resize(static_cast<std::size_t>(file.gcount()));
  return text;
}

Failure bad_input(const std::string& path, int line, const std::string& what) {
  return {Failure::Kind::kInvalid, path + ":" + std::to_string(line) + ": " + what};
}

}  // namespace tether::sut
