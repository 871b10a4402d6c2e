#include "plots/svg.h"

#include "plots/inks.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include <fmt/format.h>
#include <tinyxml2.h>

#include <tether/base/text.h>

// Two steps on gnuplot's SVG: finished_svg makes it an independent file (inks instead of colours, a
// title, a style sheet), and inline_svg makes a finished file part of an HTML page.
namespace tether::report {
namespace {

using tinyxml2::XMLElement;

std::string printed(const tinyxml2::XMLNode& node) {
  tinyxml2::XMLPrinter printer(nullptr, true);
  node.Accept(&printer);
  return printer.CStr();
}

// Elements that name the drawing program or have no effect. gnuplot opens a group for each pen,
// even if it draws nothing with it.
bool is_dropped(const XMLElement& element) {
  const std::string_view name = element.Name();
  return name == "title" || name == "desc" || name == "filter" ||
         (name == "g" && element.NoChildren());
}

// Colours that stand for inks become the class of the ink, and its light colour.
void put_inks(XMLElement& element) {
  std::string classes;
  for (const char* name : {"stroke", "fill", "color"}) {
    const char* colour = element.Attribute(name);
    const auto ink = colour != nullptr ? find_ink(colour) : std::nullopt;
    if (!ink) continue;
    element.SetAttribute(name, std::string(light_colour(*ink)).c_str());
    classes += fmt::format("tp-{}-{} ", name, static_cast<std::size_t>(*ink));
  }
  if (classes.empty()) return;
  const char* others = element.Attribute("class");
  if (others == nullptr) classes.pop_back();
  element.SetAttribute("class", (classes + (others != nullptr ? others : "")).c_str());
}

// The name in SVG 2, which HTML also supports.
void rename_reference(XMLElement& element) {
  if (const char* target = element.Attribute("xlink:href")) {
    element.SetAttribute("href", target);
    element.DeleteAttribute("xlink:href");
  }
}

// From the innermost elements outwards, so that groups that become empty are dropped too.
void finish(XMLElement& element) {
  for (XMLElement* child = element.FirstChildElement(); child != nullptr;) {
    XMLElement* next = child->NextSiblingElement();
    finish(*child);
    if (is_dropped(*child)) element.DeleteChild(child);
    child = next;
  }
  put_inks(element);
  rename_reference(element);
}

void add_in_front(XMLElement& root, const char* name, const std::string& text) {
  XMLElement* element = root.GetDocument()->NewElement(name);
  element->SetText(text.c_str());
  root.InsertFirstChild(element);
}

std::string with_prefixed_ids(const tinyxml2::XMLAttribute& attribute, const std::string& prefix) {
  constexpr std::string_view kReference = "url(#";
  const std::string_view name = attribute.Name();
  std::string value = attribute.Value();
  if (name == "id") return prefix + value;
  if (name == "href" && value.starts_with('#')) return value.insert(1, prefix);
  if (value.starts_with(kReference)) value.insert(kReference.size(), prefix);
  return value;
}

void prefix_ids(XMLElement& element, const std::string& prefix) {
  for (auto* attribute = element.FirstAttribute(); attribute != nullptr;
       attribute = attribute->Next())
    element.SetAttribute(attribute->Name(), with_prefixed_ids(*attribute, prefix).c_str());
  for (XMLElement* child = element.FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement())
    prefix_ids(*child, prefix);
}

}  // namespace

std::string escape_markup(std::string_view text) {
  constexpr std::pair<char, std::string_view> kEntities[] = {
      {'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}, {'\'', "&#39;"}};
  std::string escaped;
  for (const char c : text) {
    const auto* entity = std::ranges::find(kEntities, c, &std::pair<char, std::string_view>::first);
    if (entity != std::end(kEntities)) {
      escaped += entity->second;
    } else if (static_cast<unsigned char>(c) >= 0x20 || c == '\n' || c == '\t') {
      escaped += c;
    }
  }
  return escaped;
}

std::optional<std::string> finished_svg(std::string_view drawn, const std::string& title) {
  tinyxml2::XMLDocument svg;
  XMLElement* root = nullptr;
  if (svg.Parse(drawn.data(), drawn.size()) == tinyxml2::XML_SUCCESS) root = svg.RootElement();
  if (root == nullptr) return std::nullopt;
  finish(*root);
  add_in_front(*root, "style", ink_css());
  add_in_front(*root, "title", printable(title));
  root->SetAttribute("role", "img");
  root->SetAttribute("aria-label", printable(title).c_str());
  return printed(svg);
}

std::string inline_svg(std::string_view finished, const std::string& prefix) {
  tinyxml2::XMLDocument svg;
  svg.Parse(finished.data(), finished.size());
  XMLElement& root = *svg.RootElement();
  if (XMLElement* style = root.FirstChildElement("style")) root.DeleteChild(style);
  prefix_ids(root, prefix);
  return printed(root);
}

}  // namespace tether::report
