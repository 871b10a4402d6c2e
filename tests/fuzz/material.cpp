#include "files/material_script.h"
#include "fuzz_target.h"

#include <cmath>

/// Scripts of materials. Input: a .material file.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tether;
  sim::ScriptMaterials materials;
  sim::read_script(fuzz::text_of({data, size}), materials);
  for (const auto& [name, material] : materials) {
    for (const auto& colour :
         {material.ambient_rgb, material.diffuse_rgb, material.specular_rgb, material.emissive_rgb})
      fuzz::require(!colour || std::isfinite(colour->x + colour->y + colour->z), "no colour");
    fuzz::require(std::isfinite(material.alpha.value_or(1.0)) &&
                      std::isfinite(material.texture_scale_x) &&
                      std::isfinite(material.texture_scale_y),
                  "no numbers");
  }
  return 0;
}
