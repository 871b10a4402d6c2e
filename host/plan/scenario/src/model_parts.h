#pragma once

#include <string_view>

#include <tether/sim/world.h>

namespace tether::scenario {

/// Whether a model is nested in the one of that name: it moves with it.
inline bool is_nested_in(const sim::Model& model, std::string_view name) {
  return model.name.starts_with(name) && model.name.substr(name.size()).starts_with("::");
}

}  // namespace tether::scenario
