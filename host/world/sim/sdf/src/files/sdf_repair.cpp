#include "files/sdf_repair.h"

#include <algorithm>
#include <initializer_list>
#include <string>
#include <string_view>

namespace tether::sim {
namespace {

using tinyxml2::XMLElement;

std::string_view inner_text(const XMLElement& element) {
  return element.GetText() != nullptr ? element.GetText() : "";
}

bool has_any(const XMLElement& element, std::initializer_list<const char*> children) {
  return std::ranges::any_of(
      children, [&](const char* child) { return element.FirstChildElement(child) != nullptr; });
}

void repair_one(const std::filesystem::path& file, XMLElement& element, const WarningSink& warn) {
  const std::string_view name = element.Name();
  if (name == "pose") {
    for (const char* frame : {"frame", "relative_to"})
      if (element.Attribute(frame, "") != nullptr) element.DeleteAttribute(frame);
  } else if (name == "world") {
    if (element.Attribute("name", "world") != nullptr) element.SetAttribute("name", "world_");
  } else if (name == "sky") {
    element.DeleteChildren();
  } else if (name == "model" && !has_any(element, {"link", "model", "include"}) &&
             std::string_view(element.Parent()->ToElement()->Name()) != "sdf") {
    element.InsertNewChildElement("link")->SetAttribute("name", "link");
    if (element.FirstChildElement("static") == nullptr)
      element.InsertNewChildElement("static")->SetText(true);
  } else if (name == "material") {
    XMLElement* const script = element.FirstChildElement("script");
    const XMLElement* const named = script ? script->FirstChildElement("name") : nullptr;
    if (script && (named == nullptr || inner_text(*named).empty())) element.DeleteChild(script);
  } else if (name == "script") {
    XMLElement* uri = element.FirstChildElement("uri");
    const std::string_view given = uri != nullptr ? inner_text(*uri) : "";
    if (!given.empty() && given != "__default__") return;
    if (uri == nullptr) uri = element.InsertNewChildElement("uri");
    uri->SetText("file://media/materials/scripts/gazebo.material");
  } else if (name == "surface_model" && inner_text(element) != "EARTH_WGS84") {
    if (warn)
      warn({Consequence::kBehavesDifferent,
            {file.string(), element.GetLineNum()},
            "<surface_model>",
            "is '" + std::string(inner_text(element)) +
                "', which is not represented; positions on Earth are measured"});
    element.SetText("EARTH_WGS84");
  }
}

/// Plugins and elements of other programs are their own.
void repair_all(const std::filesystem::path& file, XMLElement& element, const WarningSink& warn) {
  const std::string_view name = element.Name();
  if (name == "plugin" || name == "state" || name.find(':') != std::string_view::npos) return;
  repair_one(file, element, warn);
  for (XMLElement* child = element.FirstChildElement(); child; child = child->NextSiblingElement())
    repair_all(file, *child, warn);
}

}  // namespace

void repair(const std::filesystem::path& file, XMLElement& root, const WarningSink& warn) {
  repair_all(file, root, warn);
}

}  // namespace tether::sim
