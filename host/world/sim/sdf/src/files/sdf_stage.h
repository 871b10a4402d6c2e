#pragma once

#include "files/model_path.h"

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <tinyxml2.h>

#include <tether/os/text_file.h>
#include <tether/sim/world.h>

namespace tether::sim {

/// An SDF file and every file that it includes, directly or not, as copies in a temporary folder
/// that the URIs of their <include> lead to. Every element of a copy is on its own line of the
/// original. libsdformat finds included files by rules of its own, which differ between the first
/// level and deeper ones, and reports deeper ones only on the console; here it has nothing to find.
class SdfStage {
 public:
  /// @throws Error(kBadFile) with file and line: no such file, not XML, not SDF, an incomplete
  /// number (`check_numbers`), an include of nothing or of itself; Error(kSetup) if there is no
  /// room for the copies.
  SdfStage(const std::filesystem::path& file, const ModelPath& path, const WorldOptions& options,
           const WarningSink& warn);

  struct File {
    std::filesystem::path original;  ///< absolute
    std::filesystem::path copy;
  };
  /// Each file behind those that it includes: the file itself comes last.
  const std::vector<File>& files() const { return files_; }
  /// What the URI of an <include> names that only places the model of this copy; the same file.
  static std::filesystem::path as_model(std::filesystem::path copy) {
    return copy.replace_extension(".model");
  }
  /// The original of a copy; other paths as they are.
  std::string original_of(const std::string& copy) const;
  /// Leaves the innermost element of that name on a line out of a copy, with the visual, collision,
  /// light, sensor or joint that it is part of. @return what was left out; empty: nothing
  std::string leave_out(const File& file, const std::string& name, int line);
  /// The outermost element of an original as it was read; nullptr for other files.
  const tinyxml2::XMLElement* root_of(const std::string& original) const;

 private:
  std::filesystem::path stage(const std::filesystem::path& file);
  void lower_version(const std::filesystem::path& file, tinyxml2::XMLElement& root);
  void resolve_includes(const std::filesystem::path& file, tinyxml2::XMLElement& element);
  void resolve(const std::filesystem::path& file, tinyxml2::XMLElement& include);
  std::filesystem::path find_included(const std::filesystem::path& file,
                                      const tinyxml2::XMLElement& uri) const;
  void replace(const std::filesystem::path& file, tinyxml2::XMLElement& include);

  const ModelPath& path_;
  const WorldOptions& options_;
  const WarningSink& warn_;
  os::TemporaryFolder folder_;
  std::vector<File> files_;
  std::set<std::filesystem::path> open_;  ///< their includes are being resolved
  std::map<std::string, std::unique_ptr<tinyxml2::XMLDocument>> originals_;
  int replaced_ = 0;
};

/// The last element of that name on the line: errors are of the innermost one. nullptr: none.
template <class Element>
Element* element_at(Element& element, const std::string& name, int line) {
  Element* found = element.Name() == name && element.GetLineNum() == line ? &element : nullptr;
  for (Element* child = element.FirstChildElement(); child; child = child->NextSiblingElement())
    if (Element* inner = element_at(*child, name, line)) found = inner;
  return found;
}

}  // namespace tether::sim
