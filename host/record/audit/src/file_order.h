#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <tether/record/reader.h>

namespace tether::audit {

/// Calls `visit` with every logged message of any kind, except images, in the order of the file.
template <class Visit>
void for_each_in_file_order(const record::Record& record, Visit visit) {
  std::size_t i = 0, c = 0, g = 0, a = 0, s = 0, t = 0;
  const auto order = [](const auto& messages, std::size_t at) {
    return at < messages.size() ? messages[at].order : std::numeric_limits<std::uint64_t>::max();
  };
  while (true) {
    const std::uint64_t orders[] = {order(record.interactions, i), order(record.commands, c),
                                    order(record.ground_truth, g), order(record.annotations, a),
                                    order(record.stops, s),        order(record.contacts, t)};
    const auto* first = std::ranges::min_element(orders);
    if (*first == std::numeric_limits<std::uint64_t>::max()) return;
    switch (first - orders) {
      case 0:
        visit(record.interactions[i++]);
        break;
      case 1:
        visit(record.commands[c++]);
        break;
      case 2:
        visit(record.ground_truth[g++]);
        break;
      case 3:
        visit(record.annotations[a++]);
        break;
      case 4:
        visit(record.stops[s++]);
        break;
      default:
        visit(record.contacts[t++]);
    }
  }
}

}  // namespace tether::audit
