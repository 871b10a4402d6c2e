#include "files.h"

#include <algorithm>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace tether::system_test {

std::string read_text(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

void write_text(const std::filesystem::path& file, const std::string& text) {
  std::ofstream out(file, std::ios::binary);
  out << text;
  if (!out.flush()) throw std::runtime_error("cannot write " + file.string());
}

std::string substituted(std::string text, const std::vector<Substitution>& substitutions) {
  for (const auto& [from, to] : substitutions) {
    const auto at = text.find(from);
    if (at == std::string::npos) throw std::logic_error("no \"" + from + "\" to replace");
    text.replace(at, from.size(), to);
  }
  return text;
}

int line_of(const std::string& text, const std::string& part) {
  const auto at = text.find(part);
  if (at == std::string::npos) throw std::logic_error("no \"" + part + "\"");
  return 1 + static_cast<int>(std::count(text.begin(), text.begin() + static_cast<long>(at), '\n'));
}

}  // namespace tether::system_test
