#include "meshes/collada_check.h"

#include <algorithm>
#include <map>
#include <string>
#include <string_view>

#include <tinyxml2.h>

#include <tether/base/error.h>

namespace tether::sim {
namespace {

using tinyxml2::XMLElement;

constexpr int kMaxDepth = 200;
constexpr int kMaxNodes = 100'000;

[[noreturn]] void refuse(const std::filesystem::path& file, int line, const std::string& what) {
  throw Error(ErrorCode::kBadFile, FileLocation{file.string(), line}, what);
}

// Walks the nodes of scenes, and those that they refer to, as often as a reader would.
class Nodes {
 public:
  explicit Nodes(const std::filesystem::path& file) : file_(file) {}

  void collect(const XMLElement& element) {
    if (std::string_view(element.Name()) == "node") {
      for (const char* key : {"id", "sid", "name"}) {
        if (const char* value = element.Attribute(key)) by_name_.emplace(value, &element);
      }
    }
    for (const XMLElement* e = element.FirstChildElement(); e; e = e->NextSiblingElement()) {
      collect(*e);
    }
  }

  void walk_scenes(const XMLElement& element) {
    if (std::string_view(element.Name()) == "visual_scene") return walk(element, 0);
    for (const XMLElement* e = element.FirstChildElement(); e; e = e->NextSiblingElement()) {
      walk_scenes(*e);
    }
  }

 private:
  void walk(const XMLElement& element, int depth) {
    if (depth > kMaxDepth) {
      refuse(file_, element.GetLineNum(), "has nodes within nodes deeper than 200, or in a circle");
    }
    if (++nodes_ > kMaxNodes) refuse(file_, element.GetLineNum(), "has more than 100,000 nodes");
    for (const XMLElement* e = element.FirstChildElement(); e; e = e->NextSiblingElement()) {
      const std::string_view name = e->Name();
      if (name == "node") walk(*e, depth + 1);
      if (name == "instance_node") walk_instances(*e, depth);
    }
  }

  void walk_instances(const XMLElement& instance, int depth) {
    const char* url = instance.Attribute("url");
    if (!url || *url != '#') return;
    const auto [first, last] = by_name_.equal_range(url + 1);
    for (auto it = first; it != last; ++it) walk(*it->second, depth + 1);
  }

  const std::filesystem::path& file_;
  std::multimap<std::string, const XMLElement*> by_name_;
  int nodes_ = 0;
};

// Assimp stops at a comment in <vertices>, at a blank before a colour, and at an image that has no
// file.
bool mend(tinyxml2::XMLDocument& document, tinyxml2::XMLNode& parent) {
  bool is_changed = false;
  for (tinyxml2::XMLNode *child = parent.FirstChild(), *next = nullptr; child; child = next) {
    next = child->NextSibling();
    if (child->ToComment() != nullptr) {
      parent.DeleteChild(child);
      is_changed = true;
      continue;
    }
    XMLElement* const element = child->ToElement();
    if (element == nullptr) continue;
    is_changed = mend(document, *element) || is_changed;
    const std::string_view text = element->GetText() != nullptr ? element->GetText() : "";
    const std::size_t first = std::min(text.find_first_not_of(" \t\r\n"), text.size());
    if (std::string_view(element->Name()) == "color" && first > 0) {
      element->SetText(std::string(text.substr(first)).c_str());
      is_changed = true;
    }
    if (std::string_view(element->Name()) != "image") continue;
    XMLElement* file = element->FirstChildElement("init_from");
    if (file != nullptr && (file->GetText() != nullptr || file->FirstChildElement())) continue;
    if (file == nullptr) file = element->InsertNewChildElement("init_from");
    file->SetText("no file");
    is_changed = true;
  }
  return is_changed;
}

}  // namespace

void check_collada(std::string& text, const std::filesystem::path& file) {
  tinyxml2::XMLDocument document;
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) {
    refuse(file, document.ErrorLineNum(),
           std::string("cannot be read as a COLLADA mesh: ") + document.ErrorName());
  }
  if (document.RootElement() == nullptr) refuse(file, 0, "has no element, as COLLADA meshes do");
  Nodes nodes(file);
  nodes.collect(*document.RootElement());
  nodes.walk_scenes(*document.RootElement());
  if (!mend(document, document)) return;
  tinyxml2::XMLPrinter printer(nullptr, true);
  document.Print(&printer);
  text = printer.CStr();
}

}  // namespace tether::sim
