// Checks the text of every number in an SDF document against libsdformat's own description of the
// element or attribute: the XML and the descriptions are walked in parallel.

#include "files/sdf_numbers.h"

#include "files/sdf_rules.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <memory>
#include <sstream>
#include <string_view>

#include <sdf/sdf.hh>
#include <tinyxml2.h>

#include <tether/base/error.h>

namespace tether::sim {

namespace {

using tinyxml2::XMLElement;

/// How many numbers a type of SDF is written as.
struct NumericType {
  std::size_t least;
  std::size_t most;
  bool is_integer;
  const char* words;
};

const std::map<std::string, NumericType, std::less<>> kNumericTypes = {
    {"double", {1, 1, false, "one number"}},
    {"float", {1, 1, false, "one number"}},
    {"int", {1, 1, true, "one whole number"}},
    {"unsigned int", {1, 1, true, "one whole number"}},
    {"time", {1, 2, false, "one number, or seconds and nanoseconds"}},
    {"vector2i", {2, 2, true, "two whole numbers"}},
    {"vector2d", {2, 2, false, "two numbers"}},
    {"vector3", {3, 3, false, "three numbers"}},
    {"quaternion", {4, 4, false, "four numbers"}},
    {"color", {3, 4, false, "three or four numbers"}},
    {"pose", {6, 6, false, "six numbers"}},
};
constexpr NumericType kQuaternionPose{7, 7, false, "seven numbers"};
/// Of a quaternion's length from 1: rounded ones are normalised.
constexpr double kRounded = 0.01;

/// What SDF declares of the child `name`; null where it does not know one.
sdf::ElementPtr child_description(const sdf::ElementPtr& parent, const std::string& name) {
  const sdf::ElementPtr child = parent->GetElementDescription(name);
  if (!child || child->ReferenceSDF().empty()) return child;
  // Elements that may hold their own kind are declared by reference.
  auto referred = std::make_shared<sdf::Element>();
  sdf::initFile(child->ReferenceSDF() + ".sdf", referred);
  return referred;
}

std::string text_of(const XMLElement& xml) {
  std::string text;
  for (const auto* node = xml.FirstChild(); node != nullptr; node = node->NextSibling()) {
    if (node->ToText() == nullptr) continue;
    if (!text.empty()) text += ' ';
    text += node->Value();
  }
  return text;
}

/// On one line, without blanks around it.
std::string trimmed(const std::string& text) {
  std::istringstream words(text);
  std::string result;
  for (std::string word; words >> word;) result += (result.empty() ? "" : " ") + word;
  return result;
}

bool is_quaternion(const XMLElement& xml) {
  return xml.Attribute("rotation_format", "quat_xyzw") != nullptr;
}

const NumericType* numeric_type(const XMLElement& xml, const sdf::ParamPtr& value) {
  if (!value) return nullptr;
  if (value->GetTypeName() == "pose" && is_quaternion(xml)) return &kQuaternionPose;
  const auto type = kNumericTypes.find(value->GetTypeName());
  return type == kNumericTypes.end() ? nullptr : &type->second;
}

/// Masks of bits are written in hexadecimal.
bool is_hexadecimal(std::string_view word) {
  if (!word.starts_with("0x") && !word.starts_with("0X")) return false;
  unsigned value = 0;
  const char* end = word.data() + word.size();
  const auto [rest, error] = std::from_chars(word.data() + 2, end, value, 16);
  return error == std::errc() && rest == end;
}

bool is_complete(const NumericType& type, const std::string& text) {
  if (type.is_integer && type.most == 1 && is_hexadecimal(text)) return true;
  const auto numbers = parse_numbers(text);
  if (!numbers || numbers->size() < type.least || numbers->size() > type.most) return false;
  if (&type == &kQuaternionPose) {
    const auto* q = numbers->data() + 3;
    const double length = std::hypot(std::hypot(q[0], q[1]), std::hypot(q[2], q[3]));
    if (std::abs(length - 1.0) > kRounded) return false;
  }
  return !type.is_integer ||
         std::ranges::all_of(*numbers, [](double number) { return std::trunc(number) == number; });
}

/// "<mass> of link 'body'", as `describe` says it of an element that libsdformat has read.
std::string describe_xml(const XMLElement& xml) {
  const auto* named = &xml;
  while (named != nullptr && named->Attribute("name") == nullptr) {
    named = named->Parent() != nullptr ? named->Parent()->ToElement() : nullptr;
  }
  const std::string element = "<" + std::string(xml.Name()) + ">";
  if (named == nullptr) return element;
  const std::string name = std::string(named->Name()) + " '" + named->Attribute("name") + "'";
  return named == &xml ? name : element + " of " + name;
}

/// The end of a message: what the text of `xml` must be.
std::string allowed_text(const XMLElement& xml, const NumericType& type) {
  if (std::string_view(xml.Name()) == "pose") {
    if (is_quaternion(xml))
      return "seven numbers, metres and a unit quaternion x y z w, without unit";
    return std::string("six numbers, metres and ") +
           (xml.BoolAttribute("degrees") ? "degrees" : "radians") + ", without unit";
  }
  const auto* parent = xml.Parent() != nullptr ? xml.Parent()->ToElement() : nullptr;
  const ValueRule* rule = parent != nullptr ? find_rule(parent->Name(), xml.Name()) : nullptr;
  const std::string unit = rule != nullptr ? rule->unit : "";
  return type.words + (unit.empty() ? "" : " in " + unit) + ", without unit";
}

class NumberCheck {
 public:
  explicit NumberCheck(const std::string& file) : file_(file) {}

  void visit(const XMLElement& xml, const sdf::ElementPtr& description) const {
    check_attributes(xml, description);
    check_text(xml, description);
    for (const auto* child = xml.FirstChildElement(); child != nullptr;
         child = child->NextSiblingElement()) {
      const sdf::ElementPtr known = child_description(description, child->Name());
      if (known) visit(*child, known);
    }
  }

 private:
  void check_text(const XMLElement& xml, const sdf::ElementPtr& description) const {
    const NumericType* type = numeric_type(xml, description->GetValue());
    if (type == nullptr) return;
    const std::string text = trimmed(text_of(xml));
    const bool is_identity = text.empty() && description->GetValue()->GetTypeName() == "pose";
    if (is_identity || is_complete(*type, text)) return;
    refuse_text(xml, "is '" + text + "'; it must be " + allowed_text(xml, *type));
  }

  void check_attributes(const XMLElement& xml, const sdf::ElementPtr& description) const {
    for (const auto* attribute = xml.FirstAttribute(); attribute != nullptr;
         attribute = attribute->Next()) {
      const NumericType* type = numeric_type(xml, description->GetAttribute(attribute->Name()));
      const std::string text = trimmed(attribute->Value());
      if (type == nullptr || is_complete(*type, text)) continue;
      refuse_text(xml, std::string("has ") + attribute->Name() + "='" + text + "'; it must be " +
                           type->words + ", without unit");
    }
  }

  [[noreturn]] void refuse_text(const XMLElement& xml, const std::string& message) const {
    const std::string subject = describe_xml(xml);
    throw Error(ErrorCode::kBadFile, {file_, xml.GetLineNum()}, subject + " " + message)
        .about(subject);
  }

  const std::string& file_;
};

}  // namespace

const sdf::ElementPtr& sdf_description() {
  // Never destroyed: it has some ten thousand elements.
  static const auto& root = *new sdf::ElementPtr([] {
    auto element = std::make_shared<sdf::Element>();
    sdf::initFile("root.sdf", element);
    return element;
  }());
  return root;
}

std::optional<std::vector<double>> parse_numbers(const std::string& text) {
  std::vector<double> numbers;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const bool has_plus = word.starts_with('+') && !word.starts_with("+-");
    const char* begin = word.data() + (has_plus ? 1 : 0);
    const char* end = word.data() + word.size();
    double number = 0.0;
    const auto [rest, error] = std::from_chars(begin, end, number);
    if (error != std::errc() || rest != end) return std::nullopt;
    numbers.push_back(number);
  }
  return numbers;
}

void check_numbers(const std::string& file, const tinyxml2::XMLDocument& xml) {
  const XMLElement* root = xml.RootElement();
  if (root == nullptr || std::string_view(root->Name()) != "sdf") return;
  NumberCheck(file).visit(*root, sdf_description());
}

}  // namespace tether::sim
