// Trees of libsdformat's elements: what to read a file into, and copies of what was read.

#include "files/sdf_tree.h"

#include "files/sdf_numbers.h"
#include "files/sdf_source.h"

#include <memory>
#include <set>
#include <vector>

namespace tether::sim {
namespace {

/// An element with the same attributes, without values.
sdf::ElementPtr without_parts(const sdf::Element& element) {
  auto result = std::make_shared<sdf::Element>();
  result->SetName(element.GetName());
  result->SetRequired(element.GetRequired());
  result->SetDescription(element.GetDescription());
  result->SetCopyChildren(element.GetCopyChildren());
  result->SetReferenceSDF(element.ReferenceSDF());
  for (const sdf::ParamPtr& attribute : element.GetAttributes())
    result->AddAttribute(attribute->GetKey(), attribute->GetTypeName(),
                         attribute->GetDefaultAsString(), attribute->GetRequired(),
                         attribute->GetDescription());
  return result;
}

void collect_names(const tinyxml2::XMLElement& element, std::set<std::string>& names) {
  names.insert(element.Name());
  for (const auto* child = element.FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement())
    collect_names(*child, names);
}

/// Elements whose parts libsdformat asks for only where it has found them.
const std::set<std::string, std::less<>> kFound = {"world",  "model",     "include",  "link",
                                                   "visual", "collision", "geometry", "material"};

/// An element's description without those parts that have parts, and none of the names, if they may
/// be absent. The reader copies the description of each element that it reads, with all of its
/// parts: those of a model take two megabytes.
sdf::ElementPtr without_unused(const sdf::Element& description,
                               const std::set<std::string>& names) {
  const sdf::ElementPtr needed = without_parts(description);
  for (std::size_t i = 0; i < description.GetElementDescriptionCount(); ++i) {
    const sdf::ElementPtr part = description.GetElementDescription(static_cast<unsigned int>(i));
    const bool has_parts = part->GetElementDescriptionCount() > 0;
    const bool may_lack = part->GetRequired() == "*" || part->GetRequired() == "0";
    if (has_parts && may_lack && !names.contains(part->GetName())) continue;
    needed->AddElementDescription(
        has_parts && kFound.contains(part->GetName()) ? without_unused(*part, names) : part);
  }
  return needed;
}

void append(const sdf::ElementPtr& parent, const sdf::ElementPtr& child) {
  child->SetParent(parent);
  parent->InsertElement(child);
}

void assign(const sdf::ParamPtr& to, const sdf::ParamPtr& from, const sdf::ElementPtr& element) {
  *to = *from;
  to->SetParentElement(element);
}

/// A copy that has the parts of a description instead of copies of its own; null: none is known.
sdf::ElementPtr copy_of(const sdf::ElementPtr& original, const sdf::ElementPtr& description) {
  const sdf::ElementPtr copy = without_parts(*original);
  copy->SetFilePath(original->FilePath());
  copy->SetXmlPath(original->XmlPath());
  copy->SetOriginalVersion(original->OriginalVersion());
  copy->SetExplicitlySetInFile(original->GetExplicitlySetInFile());
  if (const auto line = original->LineNumber()) copy->SetLineNumber(*line);
  for (const sdf::ParamPtr& attribute : original->GetAttributes())
    assign(copy->GetAttribute(attribute->GetKey()), attribute, copy);
  if (const sdf::ParamPtr value = original->GetValue()) {
    copy->AddValue(value->GetTypeName(), value->GetDefaultAsString(), value->GetRequired());
    assign(copy->GetValue(), value, copy);
  }
  const bool is_described = description && description->GetElementDescriptionCount() > 0;
  const sdf::Element& described = is_described ? *description : *original;
  for (std::size_t i = 0; i < described.GetElementDescriptionCount(); ++i)
    copy->AddElementDescription(described.GetElementDescription(static_cast<unsigned int>(i)));
  for_each_child(original, [&](const sdf::ElementPtr& child) {
    append(copy, copy_of(child, described.GetElementDescription(child->GetName())));
  });
  return copy;
}

/// The copy of `model` that an <include> asks for. What it says is moved to the copy.
sdf::ElementPtr place(const sdf::ElementPtr& model, const sdf::ElementPtr& include) {
  const sdf::ElementPtr placed = copy_of(model, model);
  for_each_child(include, [&](const sdf::ElementPtr& said) {
    const std::string& kind = said->GetName();
    if (kind == "uri") return;
    if (kind == "name") {
      placed->GetAttribute("name")->SetFromString(said->Get<std::string>());
      return;
    }
    if (const auto own = placed->FindElement(kind); own && kind != "plugin")
      placed->RemoveChild(own);
    append(placed, said);
  });
  return placed;
}

}  // namespace

sdf::SDFPtr SdfTrees::empty(const tinyxml2::XMLElement* root) {
  // What stands for a missing model, and what libsdformat makes of older versions.
  std::set<std::string> names{"model", "link", "frame", "script", "velocity_decay"};
  if (root != nullptr) collect_names(*root, names);
  sdf::ElementPtr& description = descriptions_[names];
  if (!description) description = without_unused(*sdf_description(), names);
  last_ = description;
  auto sdf = std::make_shared<sdf::SDF>();
  sdf->Root(copy_of(description, description));
  return sdf;
}

void SdfTrees::keep_model(const std::string& uri, const sdf::Element& root) {
  if (const sdf::ElementPtr model = root.GetElementImpl("model"))
    models_[uri] = copy_of(model, last_->GetElementDescription("model"));
}

void SdfTrees::place_included(const sdf::ElementPtr& element) const {
  std::vector<sdf::ElementPtr> children;
  bool has_included = false;
  for_each_child(element, [&](const sdf::ElementPtr& child) {
    const std::string& kind = child->GetName();
    if (kind == "world" || kind == "model") place_included(child);
    const auto model =
        kind == "include" ? models_.find(child->Get<std::string>("uri")) : models_.end();
    has_included = has_included || model != models_.end();
    children.push_back(model != models_.end() ? place(model->second, child) : child);
  });
  if (!has_included) return;
  for_each_child(element, [&](const sdf::ElementPtr& child) { element->RemoveChild(child); });
  for (const sdf::ElementPtr& child : children) append(element, child);
}

}  // namespace tether::sim
