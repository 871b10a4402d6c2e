#pragma once

#include "mcap/mcap_format.h"

#include <tether/record/messages.h>

/// Header and footer of a record as MCAP metadata: a map of texts; lists are JSON arrays in a text.
namespace tether::record {

inline constexpr std::string_view kHeaderName = "tether";
inline constexpr std::string_view kFooterName = "tether.end";

StringMap to_metadata(const Header& header);
StringMap to_metadata(const Footer& footer);

/// @throws Damage naming the value that is missing or wrong.
Header header_from_metadata(const StringMap& values);
Footer footer_from_metadata(const StringMap& values);
/// The schema version alone, readable whatever else a later version changed.
int schema_version(const StringMap& values);

}  // namespace tether::record
