#pragma once

#include <tuple>
#include <vector>

#include <tether/record/reader.h>

namespace tether::record {

inline constexpr std::tuple kLists = {
    &Record::interactions, &Record::commands,  &Record::ground_truth, &Record::annotations,
    &Record::stops,        &Record::contacts,  &Record::batteries,    &Record::radio,
    &Record::images,       &Record::raw_images};

/// Those of one kind.
template <class Kind>
std::vector<Logged<Kind>>& messages_of(Record& record) {
  return record.*std::get<std::vector<Logged<Kind>> Record::*>(kLists);
}

}  // namespace tether::record
