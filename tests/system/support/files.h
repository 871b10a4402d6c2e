#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <tether/base_testing/scratch_folder.h>

namespace tether::system_test {

/// A scratch folder that names what is in it as a path does: `folder / "out"`.
class TempFolder : public ScratchFolder {
 public:
  std::filesystem::path operator/(const std::string& name) const { return path(name); }
};

/// Whole content; empty where there is no such file, or it may not be read.
std::string read_text(const std::filesystem::path& file);
void write_text(const std::filesystem::path& file, const std::string& text);

/// What to replace, by what.
using Substitution = std::pair<std::string, std::string>;
/// `text` with each substitution made once, in order. @throws std::logic_error when one is not
/// there: the text that it was made for has changed.
std::string substituted(std::string text, const std::vector<Substitution>& substitutions);

/// Number of the line of `text` that contains `part`, from 1. @throws std::logic_error if none.
int line_of(const std::string& text, const std::string& part);

}  // namespace tether::system_test
