#include "json/json_messages.h"
#include "json/json_metadata.h"
#include "json/json_text.h"
#include "json/members.h"
#include "kinds.h"

#include <cmath>
#include <limits>
#include <string>
#include <type_traits>

#include <tether/record/writer.h>

// A text is kept as UTF-8 and a number that is not finite as NaN, as they are read from a file.
namespace tether::record {
namespace {

/// A reader of `members` that changes them to what is read from a file.
class AsRead {
 public:
  static constexpr bool wall() { return true; }
  static constexpr bool arrivals() { return true; }
  bool has(const char*, bool condition) const { return condition; }
  template <class Value>
  static Value& value_of(std::optional<Value>& value) {
    return *value;
  }

  template <class Value>
  void operator()(const char*, Value& value) const {
    if constexpr (std::is_same_v<Value, std::string>) {
      value = to_utf8(value);
    } else if constexpr (std::is_same_v<Value, double>) {
      if (!std::isfinite(value)) value = std::numeric_limits<double>::quiet_NaN();
    } else if constexpr (std::is_array_v<Value>) {
      for (auto& element : value) (*this)("", element);
    }
  }
  void within(const char*, int, int, int) const {}
  template <class Value>
  void optional(const char* name, std::optional<Value>& value) const {
    if (value) (*this)(name, *value);
  }
  void flag(const char*, bool) const {}
  void look_ahead(const char*, const auto&) const {}
  void object(const char*, const auto& fields) const { fields(*this); }
  template <class Item>
  void list(const char*, std::vector<Item>& items) const {
    for (Item& item : items) members(*this, item);
  }
};

template <class Kind>
Kind as_read(Kind message) {
  const AsRead io;
  members(io, message);
  return message;
}

/// With its JSON as the file has it.
Annotation as_read(const Annotation& message) {
  std::string text;
  append_json(text, message);
  return from_json<Annotation>(text);
}

/// Of the many others, nobody reads the fields in memory.
AutopilotMessage as_read(AutopilotMessage message) {
  if (!message.tells_state()) message.fields = "{}";
  return message;
}

}  // namespace

void RecordInMemory::write(const Header& header) {
  record_.header = header_from_metadata(to_metadata(header));
}

void RecordInMemory::write(SimTime at, const Message& message) {
  const auto keep = [&]<class Kind>(const Kind& one) {
    if constexpr (!kIsImage<Kind>) messages_of<Kind>(record_).push_back({at, order_, as_read(one)});
  };
  std::visit(keep, message);
  ++order_;
}

void RecordInMemory::write(const Footer& footer) {
  record_.footer = footer_from_metadata(to_metadata(footer));
}

}  // namespace tether::record
