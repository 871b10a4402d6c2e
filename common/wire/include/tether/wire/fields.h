#pragma once

#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

/// How a message says its fields: once, for everything that is done with them.
///
///     void fields(auto& io, Is<RangeSample> auto& m) {
///       io("sampled_at_st_ns", m.sampled_at);
///       io("index", m.index);
///       io("range_m", m.range_m, AnyNumber{}, kNoNan);
///     }
///
/// The names and their order are those of the schema: a field's place in the list is its number in
/// the frame, and fields are added at the end only. `io` is a TableWriter (to a frame), a
/// TableReader (from a frame) or a FieldChecker (are the values allowed?). What stands behind a
/// value is for one or two of them: a Default, a limit, a rule.
///
/// What a value is in the frame follows from its type: numbers, enumerations and times are scalars;
/// texts and vectors are themselves; a type with `fields` is a table, or a struct where kIsStruct
/// says so; a std::variant of tables is a union; a std::optional of these may be absent. An
/// optional number is an index, −1 where there is none.
///
/// Two more calls are for the FieldChecker, and do nothing in the others:
/// - `io.here(text)`: where the fields of this table are, for complaints;
/// - `io.require(holds, field, rule)`: a rule on several fields. All three may be functions.
namespace tether::wire {

/// A message that is read from or written to.
template <class Message, class Plain>
concept Is = std::same_as<std::remove_const_t<Message>, Plain>;

/// Whether a type with fields is a FlatBuffers struct: numbers of fixed places, never absent.
template <class T>
inline constexpr bool kIsStruct = false;

/// Every time t has 0 ≤ t < this (146 years), so that sums of two cannot overflow [ns].
inline constexpr std::int64_t kMaxTimestampNs = std::int64_t{1} << 62;

/// The value of a scalar that is absent; without it, 0.
template <class T>
struct Default {
  T value;
};
template <class T>
Default(T) -> Default<T>;

/// The most bytes of a text, or the most items of a list, which a reader refuses before it reads
/// them.
struct AtMost {
  std::size_t count = 0;
  std::string_view complaint = "has too many entries";  ///< of a list
};
/// The most bytes of each text in a list.
struct EachAtMost {
  std::size_t bytes = 0;
};

/// A text or list that is left out where it is empty.
struct OmitEmpty {};

/// The members of a union are numbered on behind so many others.
struct After {
  std::size_t members = 0;
};

/// Bytes that are not copied into the frame: they are a piece of their own. One field of a frame.
struct Apart {};

/// A floating-point number that need not be finite.
struct AnyNumber {};

/// What a value must fulfil. `text` is the complaint: "is negative", or a function of the value
/// that returns it.
template <class Holds, class Text = const char*>
struct Rule {
  Holds holds;
  Text text;
};
template <class Holds, class Text>
Rule(Holds, Text) -> Rule<Holds, Text>;
template <class Holds, std::size_t kSize>
Rule(Holds, const char (&)[kSize]) -> Rule<Holds, const char*>;

inline constexpr Rule kNotNegative{
    [](const auto& value) { return std::remove_cvref_t<decltype(value)>{} <= value; },
    "is negative"};
inline constexpr Rule kPositive{[](double value) { return value > 0.0; },
                                "is not a positive number"};
inline constexpr Rule kNotEmpty{[](const auto& value) { return !value.empty(); }, "is empty"};
inline constexpr Rule kShare{[](double value) { return value >= 0.0 && value <= 1.0; },
                             "is not within 0..1"};
inline constexpr Rule kNotZero{[](const auto& value) { return value != 0; }, "is 0"};
inline constexpr Rule kNoNan{[](double value) { return !std::isnan(value); }, "is not a number"};

/// Of a list: no two items have the same text in that member.
template <class Item>
constexpr auto unique_by(std::string Item::*member, const char* complaint) {
  return Rule{[member](const std::vector<Item>& items) {
                std::set<std::string_view> texts;
                for (const Item& item : items)
                  if (!texts.insert(item.*member).second) return false;
                return true;
              },
              complaint};
}

/// An enumeration whose last member is this.
template <class Enum>
constexpr auto known_up_to(Enum last) {
  return Rule{[last](Enum value) { return value <= last; }, "is unknown"};
}

/// A message that says its fields.
struct AnyIo {
  template <class... T>
  void operator()(T&&...) {}
  template <class... T>
  void here(T&&...) {}
  template <class... T>
  void require(T&&...) {}
};
template <class T>
concept HasFields = requires(AnyIo& io, T& value) {
  fields(io, value);
};

/// A frame in up to three consecutive pieces. `image` are bytes of the message itself, its pixels,
/// so that an image is sent without a copy; it is empty for messages without an image.
struct FramePieces {
  std::span<const std::uint8_t> head;
  std::span<const std::uint8_t> image;
  std::span<const std::uint8_t> tail;

  std::size_t size() const { return head.size() + image.size() + tail.size(); }
};

}  // namespace tether::wire
