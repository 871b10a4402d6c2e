#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <sdf/sdf.hh>

#include <tether/base/error.h>
#include <tether/sim/world.h>

namespace tinyxml2 {
class XMLDocument;
}

namespace tether::sim {

/// One SDF file as libsdformat parsed it, with everything that libsdformat would print to the
/// console collected instead, and with the place of every element. Errors and warnings are
/// libsdformat's typed ones, by its policies, where version 12 has them; for the rest its console
/// is read.
class SdfSource {
 public:
  /// @throws Error(kBadFile) if the file is missing, a directory, not XML or not SDF, or has a
  /// value that SDF does not allow or would read in part only ("1 kg").
  explicit SdfSource(const std::filesystem::path& file);
  ~SdfSource();
  SdfSource(const SdfSource&) = delete;
  SdfSource& operator=(const SdfSource&) = delete;

  const sdf::Root& root() const { return root_; }
  const std::filesystem::path& file() const { return file_; }

  /// What libsdformat found wrong beyond single values: frames, names, includes.
  void throw_on_errors() const;
  /// What libsdformat warns of, one line each: "file:line: message".
  const std::vector<std::string>& warnings() const { return warnings_; }

  /// File and line of an element, of its nearest ancestor with a line if need be.
  FileLocation where(const sdf::ElementPtr& element) const;

  /// The file that `uri` means at `element`: model://, file://, or relative to the element's file.
  /// @throws Error(kBadFile) about the element if there is none.
  std::filesystem::path find_resource(const sdf::ElementPtr& element, const std::string& uri) const;

  /// Every file that this one was made of so far: itself, what it includes, and the resources
  /// found. Absolute.
  std::set<std::filesystem::path> files() const;
  /// Of these, the SDF files: itself and what it includes.
  std::set<std::filesystem::path> sdf_files() const;

 private:
  int line_in_xml(const sdf::ElementPtr& element) const;
  tinyxml2::XMLDocument* xml_of(const std::string& file) const;
  void parse();
  void check_included_numbers() const;
  void collect_console(const std::string& text);
  [[noreturn]] void throw_first_error() const;
  FileLocation where(const sdf::Error& error) const;

  std::filesystem::path file_;
  std::vector<std::filesystem::path> model_folders_;
  sdf::Root root_;
  sdf::Errors errors_;
  std::vector<std::string> console_errors_;
  std::vector<std::string> warnings_;
  mutable std::set<std::filesystem::path> resources_;
  mutable std::map<std::string, std::unique_ptr<tinyxml2::XMLDocument>> xml_;
};

/// "<mass> of link 'body'": an element by its name and its nearest named ancestor, for messages.
std::string describe(const sdf::ElementPtr& element);
/// The element's name attribute; empty where it has none.
std::string name_attribute(const sdf::ElementPtr& element);

/// Calls `visit` for each child in order.
void for_each_child(const sdf::ElementPtr& element,
                    const std::function<void(const sdf::ElementPtr&)>& visit);

}  // namespace tether::sim
