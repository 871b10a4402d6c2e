#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tether::raster {

/// Runs of pixels that follow each other in a tile and see the same triangle in a layer, by
/// triangle.
class Runs {
 public:
  /// Removes all. Ids are below `ids` from here on.
  void clear(std::size_t ids) {
    for (const std::uint32_t id : ids_) first_[id] = kNone;
    ids_.clear();
    runs_.clear();
    if (first_.size() < ids) first_.resize(ids, kNone);
  }

  void add(std::uint32_t id, std::size_t begin, std::size_t end, std::size_t layer = 0) {
    std::uint16_t& first = first_[id];
    if (first == kNone) ids_.push_back(id);
    const auto at = static_cast<std::uint16_t>(runs_.size());
    runs_.push_back({static_cast<std::uint16_t>(begin), static_cast<std::uint16_t>(end),
                     static_cast<std::uint16_t>(layer), first});
    first = at;
  }

  /// Those with runs.
  std::span<const std::uint32_t> ids() const { return ids_; }

  /// Calls `use` with the first pixel of each run, that after its last one, and its layer.
  template <class Use>
  void for_each(std::uint32_t id, const Use& use) const {
    for (std::uint16_t at = first_[id]; at != kNone; at = runs_[at].next) {
      use(runs_[at].begin, runs_[at].end, runs_[at].layer);
    }
  }

 private:
  static constexpr std::uint16_t kNone = 0xFFFF;
  struct Run {
    std::uint16_t begin, end;
    std::uint16_t layer;
    std::uint16_t next;  // of the same triangle
  };

  std::vector<std::uint16_t> first_;  // of each id
  std::vector<std::uint32_t> ids_;
  std::vector<Run> runs_;
};

}  // namespace tether::raster
