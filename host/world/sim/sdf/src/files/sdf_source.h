#pragma once

#include "files/model_path.h"
#include "files/sdf_stage.h"

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <sdf/sdf.hh>

#include <tether/base/error.h>
#include <tether/sim/world.h>

namespace tether::sim {

/// One SDF file with all that it includes, as libsdformat parsed it, with the place of every
/// element. First its elements are read, which may then be checked and changed; `load` makes
/// libsdformat's objects of them. libsdformat prints nothing: each file is read alone, by policies
/// that make every message a typed error.
class SdfSource {
 public:
  /// `warn` receives what libsdformat warns of.
  /// @throws Error(kBadFile) if the file or one that it includes is missing, a directory, not XML
  /// or not SDF, or has a value that SDF does not allow or would read in part only ("1 kg").
  SdfSource(const std::filesystem::path& file, const WorldOptions& options,
            const WarningSink& warn);

  /// <sdf>
  sdf::ElementPtr element() const { return parsed_->Root(); }
  /// @throws Error(kBadFile) for what is wrong beyond single values: frames, names, joints.
  void load();
  /// @pre `load`
  const sdf::Root& root() const { return root_; }

  const std::filesystem::path& file() const { return file_; }
  const WorldOptions& options() const { return options_; }

  /// Whether an element is from an included file, not from this one.
  bool is_included(const sdf::ElementPtr& element) const {
    return element->FilePath() != this->element()->FilePath();
  }
  /// File and line of an element, of its nearest ancestor with a line if need be.
  FileLocation where(const sdf::ElementPtr& element) const;

  /// The file that `uri` means at `element` (ModelPath); empty if it is not found and the options
  /// allow to go without it. @throws Error(kBadFile) about the element if they do not.
  std::filesystem::path find_resource(const sdf::ElementPtr& element, const std::string& uri) const;

  /// The file or folder that `uri` means at `element`; none if there is nothing.
  std::optional<std::filesystem::path> find(const sdf::ElementPtr& element,
                                            const std::string& uri) const;
  /// The content of a file, which is one that this one was made of from now on.
  /// @throws Error(kBadFile) if it cannot be read or has more than 16 MiB.
  std::string read_resource(const std::filesystem::path& file) const;
  /// The same for a file that is not read here. @return `file`
  std::filesystem::path use(const std::filesystem::path& file) const;
  /// What a mesh file names as parts of it (mesh_companions), found once.
  const std::vector<std::filesystem::path>& companions_of(const std::filesystem::path& mesh) const;

  /// Every file that this one was made of so far: itself, what it includes, and the resources
  /// found. Absolute.
  std::set<std::filesystem::path> files() const;
  /// Of these, the SDF files: itself and what it includes.
  std::set<std::filesystem::path> sdf_files() const;

 private:
  void read(const WarningSink& warn);
  bool leave_out_unreadable(const SdfStage::File& staged, sdf::Errors errors,
                            const WarningSink& warn);
  Warning warning_of(const sdf::Error& error) const;
  std::string reason_of(const sdf::Error& error) const;
  [[noreturn]] void refuse_by(const sdf::Errors& errors) const;
  FileLocation where(const sdf::Error& error) const;
  int line_in_xml(const sdf::ElementPtr& element) const;

  std::filesystem::path file_;
  WorldOptions options_;
  ModelPath path_;
  SdfStage stage_;
  sdf::SDFPtr parsed_;
  sdf::Root root_;
  mutable std::set<std::filesystem::path> resources_;
  mutable std::map<std::filesystem::path, std::vector<std::filesystem::path>> companions_;
};

/// In a handler: turns what libsdformat threw into the refusal of the file. Other errors stay.
[[noreturn]] void refuse_by_library(const FileLocation& where);

/// What `question` answers, with libsdformat, about a file. Some broken ones make it throw; `where`
/// is the place in doubt.
template <class Question>
auto ask_library(const FileLocation& where, Question question) try {
  return question();
} catch (...) {
  refuse_by_library(where);
}

/// "<mass> of link 'body'": an element by its name and its nearest named ancestor, for messages.
std::string describe(const sdf::ElementPtr& element);
/// The element's name attribute; empty where it has none.
std::string name_attribute(const sdf::ElementPtr& element);

/// Calls `visit` for each child in order. `visit` may remove the child.
void for_each_child(const sdf::ElementPtr& element,
                    const std::function<void(const sdf::ElementPtr&)>& visit);

}  // namespace tether::sim
