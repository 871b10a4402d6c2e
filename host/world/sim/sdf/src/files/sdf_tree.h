#pragma once

#include <map>
#include <set>
#include <string>

#include <sdf/sdf.hh>
#include <tinyxml2.h>

namespace tether::sim {

/// The trees of elements that libsdformat reads files into, and the models of those files that are
/// included. Reading an included file takes libsdformat 20 ms and megabytes, each time; here it is
/// read once, and copied.
class SdfTrees {
 public:
  /// To read a file into whose outermost element is `root`. It has the descriptions only of what
  /// the file names: the reader copies the description of each element that it reads.
  sdf::SDFPtr empty(const tinyxml2::XMLElement* root);
  /// Keeps a copy of the model of the last file, for each <include> with this <uri>.
  void keep_model(const std::string& uri, const sdf::Element& root);
  /// Puts a copy of a kept model in place of each <include> that names one, with what the <include>
  /// says of its name and pose, and whether it is static, and with its plugins.
  void place_included(const sdf::ElementPtr& element) const;

 private:
  std::map<std::set<std::string>, sdf::ElementPtr> descriptions_;  ///< by the names in files
  sdf::ElementPtr last_;
  std::map<std::string, sdf::ElementPtr> models_;
};

}  // namespace tether::sim
