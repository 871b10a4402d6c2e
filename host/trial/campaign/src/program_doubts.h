#pragma once

#include <string>
#include <vector>

#include <tether/campaign/result.h>

namespace tether::campaign {

Warning doubt_about(const std::string& uav, const std::string& what);

/// Whether a program did anything with its UAV and, if it says that it has flown, whether it can
/// have done so. Doubts go to `warnings`; what its flight controller refused, to the outcome.
/// @return why the program was never set up; empty: it was.
std::string check_program(const record::Record& record, const record::SutInfo& info, SutResult& sut,
                          std::vector<Warning>& warnings);

/// Why it is not known whether a program computed or waited, as programs told when they ended;
/// empty: it is.
std::string unclear_times(const record::Record& record);

/// Where an unmodified program that did nothing with its UAV would have found it, as the rest of a
/// reason; empty: there is none.
std::string where_to_find(const record::Record& record);

}  // namespace tether::campaign
