#include <fstream>
#include <iterator>
#include <map>
#include <regex>

#include <tether/wire_testing/schema.h>

namespace tether::wire {
namespace {

using Match = std::smatch;

/// What each name in the schema is: "table", "struct", "union", or an enumeration's number.
std::map<std::string, std::string> kinds_in(const std::string& schema) {
  std::map<std::string, std::string> kinds = {
      {"ubyte", "uint8"}, {"ushort", "uint16"}, {"bool", "uint8"}};
  const std::regex declared(R"((table|struct|union|enum)\s+(\w+)\s*(?::\s*(\w+))?)");
  for (std::sregex_iterator at(schema.begin(), schema.end(), declared), end; at != end; ++at) {
    const Match& found = *at;
    kinds[found[2]] = found[1] == "enum" ? kinds.at(found[3]) : found[1].str();
  }
  return kinds;
}

struct Schema {
  std::map<std::string, std::string> kinds;
  std::map<std::string, std::string> bodies;  ///< of tables and structs: what is in the braces
};

Schema read_schema(const std::string& file) {
  std::ifstream in(file);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  const std::string plain = std::regex_replace(text, std::regex("//[^\n]*"), "");
  Schema schema{kinds_in(plain), {}};
  const std::regex body(R"((?:table|struct)\s+(\w+)\s*\{([^}]*)\})");
  for (std::sregex_iterator at(plain.begin(), plain.end(), body), end; at != end; ++at)
    schema.bodies.emplace((*at)[1], (*at)[2]);
  return schema;
}

/// Read once, because regular expressions take long under a sanitizer.
const Schema& schema_of(const std::string& file) {
  static std::map<std::string, Schema> known;
  const auto found = known.find(file);
  return found != known.end() ? found->second
                              : known.emplace(file, read_schema(file)).first->second;
}

}  // namespace

std::vector<std::string> fields_in_schema(const std::string& file, const std::string& name) {
  const auto& [kinds, bodies] = schema_of(file);
  const auto body = bodies.find(name);
  if (body == bodies.end()) return {};
  const std::string& inside = body->second;
  std::vector<std::string> fields;
  const std::regex field(R"((\w+)\s*:\s*(\[?)(\w+)(\]?)([^;]*);)");
  for (std::sregex_iterator at(inside.begin(), inside.end(), field), end; at != end; ++at) {
    const Match& found = *at;
    const auto kind = kinds.find(found[3]);
    const std::string type = kind == kinds.end() ? found[3].str() : kind->second;
    std::string rest = std::regex_replace(found[5].str(), std::regex(R"(\s+$|\.0\b)"), "");
    fields.push_back(found[1].str() + ": " + found[2].str() + type + found[4].str() + rest);
  }
  return fields;
}

}  // namespace tether::wire
