#include <algorithm>

#include <tether/sim/contacts.h>

namespace tether::sim {
namespace {

// So that stepping allocates nothing in common flights.
constexpr std::size_t kRoom = 64;

bool is_same_pair(const Touch& a, const Touch& b) {
  return a.uav == b.uav && a.with == b.with;
}

}  // namespace

ContactLog::ContactLog() {
  touched_.reserve(kRoom);
  begun_.reserve(kRoom);
}

void ContactLog::add(const Touch& touch) {
  std::erase_if(touched_, [&](const Touched& old) { return touch.at - old.last > kSameContact; });
  bool is_known = false;
  bool is_harder = true;
  for (Touched& old : touched_) {
    if (!is_same_pair(old.first, touch)) continue;
    is_harder = is_harder && touch.speed_m_s > old.first.speed_m_s;
    if (old.first.shape != touch.shape) continue;
    if (old.first.at != touch.at) {
      old.last = touch.at;
      return;
    }
    is_known = true;
    old.first.speed_m_s = std::max(old.first.speed_m_s, touch.speed_m_s);
  }
  if (!is_known) touched_.push_back({touch, touch.at});
  if (is_harder) begin(touch);
}

// Several points and shapes that are hit at one instant are one contact.
void ContactLog::begin(const Touch& touch) {
  const auto same = std::ranges::find_if(begun_, [&](const Touch& begun) {
    return begun.at == touch.at && is_same_pair(begun, touch);
  });
  if (same == begun_.end()) {
    begun_.push_back(touch);
  } else {
    same->speed_m_s = touch.speed_m_s;
  }
}

std::vector<Contact> ContactLog::take() {
  std::vector<Contact> contacts;
  for (const Touch& touch : begun_) {
    contacts.push_back(
        {touch.at, touch.uav, std::string(touch.with), std::max(0.0, touch.speed_m_s)});
  }
  begun_.clear();
  return contacts;
}

void ContactLog::reset() {
  touched_.clear();
  begun_.clear();
}

}  // namespace tether::sim
