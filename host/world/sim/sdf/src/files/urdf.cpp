#include "files/urdf.h"

#include "files/quiet_console.h"
#include "files/sdf_source.h"

#include <algorithm>
#include <memory>
#include <string_view>

#include <sdf/sdf.hh>

#include <tether/base/error.h>

namespace tether::sim {
namespace {

using tinyxml2::XMLElement;

/// The first element of xacro's; nullptr: there is none.
const XMLElement* of_xacro(const XMLElement& element) {
  if (std::string_view(element.Name()).starts_with("xacro:")) return &element;
  for (const XMLElement* child = element.FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement())
    if (const XMLElement* found = of_xacro(*child)) return found;
  return nullptr;
}

}  // namespace

std::string sdf_of_urdf(const std::filesystem::path& file, const XMLElement& robot,
                        const std::string& text) {
  if (const XMLElement* xacro = of_xacro(robot))
    throw Error(ErrorCode::kBadFile, {file.string(), xacro->GetLineNum()},
                "is a template. Expand it with the tool xacro of ROS, with the arguments that it "
                "needs (`xacro " +
                    file.filename().string() + " > model.urdf`), and give the result");
  const QuietConsole quiet;
  auto sdf = std::make_shared<sdf::SDF>();
  sdf::init(sdf);
  sdf::Errors errors;
  const bool is_read = ask_library({file.string(), robot.GetLineNum()},
                                   [&] { return sdf::readString(text, sdf, errors); });
  // It goes on without what it complains of.
  if (!is_read || !sdf->Root()->HasElement("model") || !quiet.complaint().empty())
    throw Error(ErrorCode::kBadFile, {file.string(), robot.GetLineNum()},
                "is no URDF that libsdformat can read" +
                    (quiet.complaint().empty() ? "" : ": " + quiet.complaint()));
  std::string one_line = sdf->Root()->ToString("");
  std::ranges::replace(one_line, '\n', ' ');
  return one_line;
}

}  // namespace tether::sim
