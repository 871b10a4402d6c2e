#pragma once

#include <map>
#include <string>
#include <vector>

#include <tether/record/reader.h>

namespace tether::audit {

/// One SUT of the header and what the record has of it.
struct SutRow {
  const record::SutInfo* info = nullptr;
  std::vector<const record::Logged<record::Interaction>*> interactions;  ///< in file order
  std::vector<const record::Logged<record::Stop>*> stops;                ///< in file order
};

/// By UAV. What belongs to no SUT of the header is left out: check_consistency names it.
inline std::map<std::string, SutRow> rows_of(const record::Record& record) {
  std::map<std::string, SutRow> rows;
  for (const record::SutInfo& sut : record.header.suts) {
    rows[sut.uav].info = &sut;
  }
  for (const auto& entry : record.interactions) {
    if (const auto row = rows.find(entry.message.uav); row != rows.end()) {
      row->second.interactions.push_back(&entry);
    }
  }
  for (const auto& entry : record.stops) {
    if (const auto row = rows.find(entry.message.uav); row != rows.end()) {
      row->second.stops.push_back(&entry);
    }
  }
  return rows;
}

}  // namespace tether::audit
