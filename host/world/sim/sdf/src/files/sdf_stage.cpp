// Reads a file as XML, stages what its <include> elements lead to, depth first, rewrites the URIs
// to the copies, and prints the copy so that each element keeps its line.

#include "files/sdf_stage.h"

#include "files/lookups.h"
#include "files/sdf_numbers.h"
#include "files/sdf_repair.h"
#include "files/sdf_version_number.h"
#include "files/sdf_xml.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <fstream>
#include <optional>
#include <string_view>

#include <sdf/sdf.hh>
#include <tinyxml2.h>

#include <tether/base/error.h>

namespace tether::sim {

namespace fs = std::filesystem;

using tinyxml2::XMLDocument;
using tinyxml2::XMLElement;

namespace {

/// Prints a document so that each element is on the line that it was read from.
class LineKeeper : public tinyxml2::XMLPrinter {
 public:
  LineKeeper() : XMLPrinter(nullptr, true) {}

  bool VisitEnter(const XMLDocument& document) override { return XMLPrinter::VisitEnter(document); }
  bool VisitEnter(const XMLElement& element, const tinyxml2::XMLAttribute* attribute) override {
    SealElementIfJustOpened();
    while (line_ < element.GetLineNum()) Putc('\n');
    return XMLPrinter::VisitEnter(element, attribute);
  }
  bool Visit(const tinyxml2::XMLText& text) override { return XMLPrinter::Visit(text); }
  bool Visit(const tinyxml2::XMLDeclaration&) override { return true; }
  bool Visit(const tinyxml2::XMLUnknown&) override { return true; }
  bool Visit(const tinyxml2::XMLComment&) override { return true; }

 protected:
  void Write(const char* data, std::size_t size) override {
    line_ += static_cast<int>(std::count(data, data + size, '\n'));
    XMLPrinter::Write(data, size);
  }
  void Putc(char c) override {
    line_ += c == '\n' ? 1 : 0;
    XMLPrinter::Putc(c);
  }

 private:
  int line_ = 1;
};

void write(const fs::path& file, const XMLDocument& document) {
  LineKeeper printer;
  document.Print(&printer);
  std::ofstream out(file, std::ios::binary);
  if (!(out << printer.CStr() << std::flush))
    throw Error(ErrorCode::kSetup, {file.string()}, "cannot be written: " + reason_of(errno));
}

/// Without the blanks around it.
std::string content_of(const XMLElement* element) {
  const std::string text =
      element != nullptr && element->GetText() != nullptr ? element->GetText() : "";
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(" \t\r\n") + 1 - first);
}

std::string describe_include(const XMLElement& include) {
  return "<include> of '" + content_of(include.FirstChildElement("uri")) + "'";
}

/// What follows `prefix` in names that elements refer to.
std::set<std::string> names_in(const XMLElement& element, const std::string& prefix) {
  std::set<std::string> names;
  const auto take = [&](const std::string& name) {
    if (name.starts_with(prefix)) names.insert(name.substr(prefix.size()));
  };
  const std::string_view kind = element.Name();
  if (kind == "parent" || kind == "child") take(content_of(&element));
  for (const char* frame : {"relative_to", "attached_to", "expressed_in"})
    if (const char* value = element.Attribute(frame)) take(value);
  for (const XMLElement* child = element.FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement())
    names.merge(names_in(*child, prefix));
  names.erase("");
  names.erase("__model__");
  return names;
}

XMLElement& named_child(XMLElement& parent, const char* kind, const std::string& name) {
  for (XMLElement* child = parent.FirstChildElement(kind); child != nullptr;
       child = child->NextSiblingElement(kind))
    if (child->Attribute("name", name.c_str()) != nullptr) return *child;
  XMLElement& child = *parent.InsertNewChildElement(kind);
  child.SetAttribute("name", name.c_str());
  return child;
}

/// A link "a::b" is link "b" of the nested model "a".
void add_link(XMLElement& model, const std::string& name) {
  const std::size_t at = name.find("::");
  if (at == std::string::npos) {
    named_child(model, "link", name);
    return;
  }
  add_link(named_child(model, "model", name.substr(0, at)), name.substr(at + 2));
}

/// What to do about a model's folder that has only the source of its SDF file.
std::string advice_on_source(const fs::path& folder) {
  for (const fs::path& source : entries_of(folder)) {
    const std::string type = source.extension();
    if (type == ".jinja" || type == ".xacro" || type == ".erb" || type == ".rsdf")
      return "; it is generated from '" + source.filename().string() +
             "': build the project that the model is from, or expand the file by its tool "
             "(jinja2, xacro, erb)";
  }
  return "";
}

/// What an included model is called if its file is not there to say.
std::string name_of(const XMLElement& include) {
  if (const std::string name = content_of(include.FirstChildElement("name")); !name.empty())
    return name;
  const std::string uri = content_of(include.FirstChildElement("uri"));
  return uri.substr(uri.find_last_of('/', uri.size() - 2) + 1);
}

bool is_one_model(const XMLElement& root) {
  const XMLElement* model = root.FirstChildElement();
  return model != nullptr && std::string_view(model->Name()) == "model" &&
         model->NextSiblingElement() == nullptr;
}

/// Whether an <include> only names a model and places it (SdfTrees).
bool is_placed_only(const XMLElement& include) {
  static const std::set<std::string, std::less<>> known = {"uri", "name", "pose", "static",
                                                           "plugin"};
  const std::string_view parent = include.Parent()->ToElement()->Name();
  if ((parent != "world" && parent != "model") || include.FirstAttribute() != nullptr) return false;
  for (const XMLElement* child = include.FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement())
    if (!known.contains(child->Name())) return false;
  const XMLElement* name = include.FirstChildElement("name");
  return name == nullptr || !content_of(name).empty();
}

/// What a world can go without.
constexpr std::array<std::string_view, 5> kDispensableParts = {"visual", "collision", "light",
                                                               "sensor", "joint"};

}  // namespace

SdfStage::SdfStage(const fs::path& file, const ModelPath& path, const WorldOptions& options,
                   const WarningSink& warn)
    : path_(path), options_(options), warn_(warn), folder_("tether-sdf-") {
  stage(file);
}

std::string SdfStage::original_of(const std::string& copy) const {
  const auto file =
      std::ranges::find(files_, fs::path(copy).replace_extension(".sdf"), &File::copy);
  return file != files_.end() ? file->original.string() : copy;
}

const XMLElement* SdfStage::root_of(const std::string& original) const {
  const auto document = originals_.find(original);
  return document != originals_.end() ? document->second->RootElement() : nullptr;
}

std::string SdfStage::leave_out(const File& file, const std::string& name, int line) {
  XMLDocument copy;
  if (copy.LoadFile(file.copy.c_str()) != tinyxml2::XML_SUCCESS) return "";
  XMLElement* element = element_at(*copy.RootElement(), name, line);
  if (element == nullptr) return "";
  for (XMLElement* parent = element; parent; parent = parent->Parent()->ToElement())
    if (std::ranges::find(kDispensableParts, parent->Name()) != kDispensableParts.end())
      element = parent;
  const char* const own = element->Attribute("name");
  const std::string left_out =
      own != nullptr ? std::string(element->Name()) + " '" + own + "'" : "<" + name + ">";
  element->Parent()->DeleteChild(element);
  write(file.copy, copy);
  return left_out;
}

/// Stages the file unless it was. @return its copy
fs::path SdfStage::stage(const fs::path& file) {
  const auto staged = std::ranges::find(files_, file, &File::original);
  if (staged != files_.end()) return staged->copy;
  auto& original = originals_[file.string()] = read_xml(file);
  check_numbers(file.string(), *original);

  const auto copied = read_xml(file);  // a copy of the other has no lines
  XMLDocument& document = *copied;
  XMLElement& root = *document.RootElement();
  lower_version(file, root);
  repair(file, root, warn_);
  open_.insert(file);
  resolve_includes(file, root);
  open_.erase(file);
  const fs::path copy = folder_ / (std::to_string(files_.size()) + ".sdf");
  write(copy, document);
  fs::create_symlink(copy, as_model(copy));
  files_.push_back({file, copy});
  return copy;
}

/// libsdformat reads what it knows of a later version, but only under its own number.
void SdfStage::lower_version(const fs::path& file, XMLElement& root) {
  const FileLocation where{file.string(), root.GetLineNum()};
  const auto version = parse_sdf_version(root.Attribute("version"));
  if (!version) {
    throw Error(ErrorCode::kBadFile, where,
                std::string("<sdf> has no version") +
                    (root.Attribute("version") ? " like 'MAJOR.MINOR'" : "") +
                    "; write <sdf version='" + sdf::SDF::Version() + "'>")
        .about("<sdf>");
  }
  if (version <= parse_sdf_version(sdf::SDF::Version().c_str())) return;
  if (warn_)
    warn_({Consequence::kNoEffect, where, "<sdf>",
           "is of version " + to_string(*version) + "; read as " + sdf::SDF::Version()});
  root.SetAttribute("version", sdf::SDF::Version().c_str());
}

/// Those in `element`. A plugin's elements are its own.
void SdfStage::resolve_includes(const fs::path& file, XMLElement& element) {
  for (XMLElement *child = element.FirstChildElement(), *next = nullptr; child != nullptr;
       child = next) {
    next = child->NextSiblingElement();
    const std::string_view name = child->Name();
    if (name == "include")
      resolve(file, *child);
    else if (name != "plugin" && name.find(':') == std::string_view::npos)
      resolve_includes(file, *child);
  }
}

void SdfStage::resolve(const fs::path& file, XMLElement& include) {
  XMLElement* uri = include.FirstChildElement("uri");
  if (content_of(uri).empty()) {
    throw Error(ErrorCode::kBadFile, {file.string(), include.GetLineNum()},
                "<include> has no <uri> of a model")
        .about("<include>");
  }
  const fs::path found = find_included(file, *uri);
  if (found.empty()) return replace(file, include);
  if (open_.contains(found)) {
    throw Error(ErrorCode::kBadFile, {file.string(), uri->GetLineNum()},
                describe_include(include) + " leads back to this file (by " + found.string() +
                    "); a model cannot include itself")
        .about(describe_include(include));
  }
  const fs::path copy = stage(found);
  const bool is_plain = is_one_model(*root_of(found.string())) && is_placed_only(include);
  uri->SetText((is_plain ? as_model(copy) : copy).c_str());
}

/// The SDF file that an <include> means; empty if it is not there and may be replaced.
fs::path SdfStage::find_included(const fs::path& file, const XMLElement& uri) const {
  const std::string subject = describe_include(*uri.Parent()->ToElement());
  const FileLocation where{file.string(), uri.GetLineNum()};
  const auto found = path_.find(content_of(&uri), file);
  if (!found) {
    if (options_.is_tolerant) return {};
    throw Error(ErrorCode::kBadFile, where,
                subject + " leads to nothing. " + path_.advice_on_missing(content_of(&uri), file))
        .about(subject);
  }
  fs::path sdf = fs::absolute(*found).lexically_normal();
  if (is_folder(sdf)) sdf = sdf_file_of(sdf, sdf::SDF::Version());
  if (!is_file(sdf)) {
    if (options_.is_tolerant) return {};
    throw Error(ErrorCode::kBadFile, where,
                subject + " leads to " + found->string() +
                    ", whose model.config names no SDF file that exists" + advice_on_source(*found))
        .about(subject);
  }
  return sdf.lexically_normal();
}

/// An empty model of that name and pose, with the links that other elements name, so that these can
/// still be relative to it or joined with it.
void SdfStage::replace(const fs::path& file, XMLElement& include) {
  const XMLElement& uri = *include.FirstChildElement("uri");
  const auto found = path_.find(content_of(&uri), file);
  if (warn_)
    warn_({Consequence::kMissing,
           {file.string(), uri.GetLineNum()},
           describe_include(include),
           (found ? "has no SDF file" + advice_on_source(*found) + "; an empty model replaces it"
                  : "is not found; an empty model replaces it")});
  std::string name = name_of(include);
  std::set<std::string> named = names_in(*include.GetDocument()->RootElement(), name + "::");
  const bool has_name = include.FirstChildElement("name") != nullptr;
  if (!has_name && named.empty()) name += "_missing" + std::to_string(++replaced_);
  for (XMLElement *child = include.FirstChildElement(), *next = nullptr; child != nullptr;
       child = next) {
    next = child->NextSiblingElement();
    if (std::string_view(child->Name()) != "pose") include.DeleteChild(child);
  }
  include.SetName("model");
  include.DeleteAttribute("merge");
  include.SetAttribute("name", name.c_str());
  include.InsertNewChildElement("static")->SetText(true);
  if (named.empty()) named.insert("link");
  for (const std::string& link : named) add_link(include, link);
}

}  // namespace tether::sim
