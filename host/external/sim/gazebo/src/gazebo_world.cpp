#include <string>
#include <string_view>

#include <tinyxml2.h>

#include <tether/base/error.h>
#include <tether/sim_gazebo/gazebo_simulator.h>

namespace tether::sim {
namespace {

using tinyxml2::XMLElement;

struct Place {
  const std::string& file;
  const XMLElement& element;
};

[[noreturn]] void refuse(const Place& place, const std::string& message) {
  const std::string subject = std::string("<") + place.element.Name() + ">";
  throw Error(ErrorCode::kBadFile, {place.file, place.element.GetLineNum()},
              subject + message + ", or use another simulator")
      .about(subject);
}

std::string trimmed_text(const XMLElement& element) {
  const std::string_view text = element.GetText() == nullptr ? "" : element.GetText();
  const auto begin = text.find_first_not_of(" \t\r\n"), end = text.find_last_not_of(" \t\r\n");
  return begin == std::string_view::npos ? "" : std::string(text.substr(begin, end - begin + 1));
}

bool is_absolute(std::string_view uri) {
  return uri.starts_with("model://") || uri.starts_with("file:///") || uri.starts_with("/");
}

/// Gazebo searches for a relative path in its working folder and its own folders, not beside the
/// file that contains it, and may find another file.
void check_uri(const Place& place, const std::string& what) {
  const std::string uri = trimmed_text(place.element);
  if (is_absolute(uri)) return;
  refuse(place, " of " + what + " is '" + uri +
                    "', which Gazebo 11 does not search for beside this file; write model:// with "
                    "the model's folder, or an absolute path");
}

void check(const Place& place) {
  const std::string name = place.element.Name();
  const auto* parent = place.element.Parent()->ToElement();
  const std::string above = parent == nullptr ? "" : parent->Name();
  if (name == "uri" && above == "mesh") check_uri(place, "a mesh");
  if (name == "uri" && above == "include") check_uri(place, "an <include>");
  if (name == "actor") {
    refuse(place,
           ": Gazebo 11 draws actors at its current time, not at the time of a picture; remove it");
  }
  const char* engine = name == "physics" ? place.element.Attribute("type") : nullptr;
  if (engine != nullptr && std::string_view(engine) != "ode") {
    refuse(place, " is of type '" + std::string(engine) +
                      "', but Tether's plugin for Gazebo requires ODE; write type=\"ode\"");
  }
}

void check_all(const std::string& file, const XMLElement& element) {
  if (std::string_view(element.Name()) == "plugin") return;
  check({file, element});
  for (const auto* child = element.FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement()) {
    check_all(file, *child);
  }
}

}  // namespace

void check_gazebo_world(const World& world) {
  for (const std::filesystem::path& file : world.sdf_files) {
    tinyxml2::XMLDocument xml;
    if (xml.LoadFile(file.c_str()) != tinyxml2::XML_SUCCESS || xml.RootElement() == nullptr) {
      throw Error(ErrorCode::kBadFile, {file.string(), 0}, "can no longer be read");
    }
    check_all(file.string(), *xml.RootElement());
  }
}

}  // namespace tether::sim
