// The rows of the table become types once, at the first use.

#include "crc.h"
#include "table.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <map>

#include <tether/mavlink/message.h>

namespace tether::mavlink {
namespace {

struct TypeInfo {
  std::string_view in_table;
  std::string_view name;
  std::size_t size;
};
// In the order of Type.
constexpr std::array<TypeInfo, 11> kTypes = {{{"c", "char", 1},
                                              {"i8", "int8_t", 1},
                                              {"u8", "uint8_t", 1},
                                              {"i16", "int16_t", 2},
                                              {"u16", "uint16_t", 2},
                                              {"i32", "int32_t", 4},
                                              {"u32", "uint32_t", 4},
                                              {"i64", "int64_t", 8},
                                              {"u64", "uint64_t", 8},
                                              {"f", "float", 4},
                                              {"d", "double", 8}}};

// The text up to the separator, which is removed as well.
std::string_view cut(std::string_view& text, std::string_view separators) {
  const std::size_t end = std::min(text.find_first_of(separators), text.size());
  const std::string_view part = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return part;
}

Field parse_field(std::string_view text) {
  Field field;
  field.name = cut(text, ":");
  const std::size_t unit = text.find('(');
  if (unit != text.npos) field.unit = text.substr(unit + 1, text.size() - unit - 2);
  text = text.substr(0, unit);
  const std::string_view type = cut(text, "[");
  field.type =
      static_cast<Type>(std::ranges::find(kTypes, type, &TypeInfo::in_table) - kTypes.begin());
  if (text.empty()) return field;
  field.is_array = true;
  std::from_chars(text.data(), text.data() + text.size(), field.count);
  return field;
}

MessageType parse(const Row& row) {
  MessageType type;
  type.id = row.id;
  type.name = row.name;
  Crc crc;
  const auto add_word = [&](std::string_view word) {
    crc.add(word);
    crc.add(" ");
  };
  add_word(row.name);
  bool is_extension = false;
  std::string_view text = row.fields;
  while (!text.empty()) {
    const std::string_view word = cut(text, " ");
    if (word == "|") {
      is_extension = true;
      continue;
    }
    Field& field = type.fields.emplace_back(parse_field(word));
    field.is_extension = is_extension;
    field.offset = type.length;
    type.length += field.count * size_of(field.type);
    if (is_extension) continue;
    add_word(name(field.type));
    add_word(field.name);
    if (field.is_array) crc.add(static_cast<std::uint8_t>(field.count));
  }
  type.crc_extra = static_cast<std::uint8_t>((crc.value() & 0xFFU) ^ (crc.value() >> 8U));
  return type;
}

struct Table {
  std::vector<MessageType> types;
  std::map<std::string_view, const MessageType*> by_name;

  Table() {
    for (const Row& row : rows()) types.push_back(parse(row));
    for (const MessageType& type : types) by_name[type.name] = &type;
  }
};

const Table& table() {
  static const Table kTable;
  return kTable;
}

}  // namespace

std::size_t size_of(Type type) {
  return kTypes[static_cast<std::size_t>(type)].size;
}

std::string_view name(Type type) {
  return kTypes[static_cast<std::size_t>(type)].name;
}

const Field* MessageType::field(std::string_view wanted) const {
  const auto found = std::ranges::find(fields, wanted, &Field::name);
  return found == fields.end() ? nullptr : &*found;
}

std::span<const MessageType> message_types() {
  return table().types;
}

const MessageType* find_type(std::uint32_t id) {
  const auto found = std::ranges::lower_bound(table().types, id, {}, &MessageType::id);
  return found == table().types.end() || found->id != id ? nullptr : &*found;
}

const MessageType* find_type(std::string_view name) {
  const auto found = table().by_name.find(name);
  return found == table().by_name.end() ? nullptr : found->second;
}

}  // namespace tether::mavlink
