#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace tether::system_test {

/// A new, empty folder of its own below the system's folder for temporary files.
std::filesystem::path make_temp_folder(const std::string& purpose);

/// A folder that goes with its object; kept when the running test has failed, so that one can look
/// at what it left.
class TempFolder {
 public:
  TempFolder();
  ~TempFolder();
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
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
