#pragma once

#include "json_reader.h"

#include <tether/base/warning.h>

namespace tether::campaign {

Json json_of(const Warning& warning);
/// @throws Error(kBadFile) about a member that is missing or has an unknown value.
Warning read_warning(const JsonReader& json);

}  // namespace tether::campaign
