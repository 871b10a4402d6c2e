#pragma once

#include <toml++/toml.h>

#include <tether/toml/table.h>

namespace tether::toml {

// Node stands for ::toml::node in the header, which does not include the library.
inline const ::toml::node& raw(const Node& node) {
  return reinterpret_cast<const ::toml::node&>(node);  // NOLINT
}
inline const Node& opaque(const ::toml::node& node) {
  return reinterpret_cast<const Node&>(node);  // NOLINT
}
inline const ::toml::table& as_table(const Node& node) {
  return *raw(node).as_table();
}

inline int line_of(const ::toml::source_region& source) {
  return static_cast<int>(source.begin.line);
}

}  // namespace tether::toml
