#include "files/sdf_version_number.h"

#include <filesystem>
#include <string>

#include <tinyxml2.h>

#include <tether/base/error.h>
#include <tether/sim_sdf/load_world.h>

namespace tether::sim {
namespace {

/// What one file is read for.
struct Reading {
  std::string file;
  std::string reader;
  SdfVersion newest;
};

[[noreturn]] void refuse(const Reading& reading, int line, const std::string& what,
                         const std::string& remedy) {
  throw Error(ErrorCode::kBadFile, {reading.file, line},
              what + "; " + reading.reader + " reads SDF up to " + to_string(reading.newest) +
                  ". " + remedy + ", or use another simulator");
}

void check_version(const Reading& reading, const tinyxml2::XMLElement& root) {
  const SdfVersion version = parse_sdf_version(root.Attribute("version")).value_or(SdfVersion{});
  if (version <= reading.newest) return;
  refuse(reading, root.GetLineNum(), "is SDF " + to_string(version),
         "Write it as SDF " + to_string(reading.newest) +
             " (often only the version number must change)");
}

/// A later libsdformat reads these in files of any version; an older one skips them.
void check_shapes(const Reading& reading, const tinyxml2::XMLElement& element) {
  const std::string name = element.Name();
  if (name == "capsule" || name == "ellipsoid") {
    refuse(reading, element.GetLineNum(), "<" + name + "> was introduced in SDF 1.8",
           "Use another shape or a mesh");
  }
  for (const auto* child = element.FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement()) {
    check_shapes(reading, *child);
  }
}

}  // namespace

void check_sdf_version(const World& world, const SdfReader& reader) {
  constexpr SdfVersion kRoundShapes{1, 8};
  const SdfVersion newest{reader.major, reader.minor};
  for (const std::filesystem::path& file : world.sdf_files) {
    tinyxml2::XMLDocument xml;
    if (xml.LoadFile(file.c_str()) != tinyxml2::XML_SUCCESS || xml.RootElement() == nullptr) {
      throw Error(ErrorCode::kBadFile, {file.string(), 0}, "can no longer be read");
    }
    const Reading reading{file.string(), reader.name, newest};
    check_version(reading, *xml.RootElement());
    if (newest < kRoundShapes) check_shapes(reading, *xml.RootElement());
  }
}

}  // namespace tether::sim
