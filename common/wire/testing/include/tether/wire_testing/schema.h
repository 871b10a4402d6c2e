#pragma once

#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include <tether/wire/values.h>

/// Whether a schema (.fbs) has the fields that the messages say.
namespace tether::wire {

/// The fields of a table or struct in a schema, in order: "index: uint64", "rgb: [uint8]
/// (required)". The types of others are "table", "struct" or "union"; enumerations are their
/// numbers. None where it has no such table or struct.
/// @param file  an .fbs
std::vector<std::string> fields_in_schema(const std::string& file, const std::string& name);

template <class T>
inline constexpr bool kIsOptional = false;
template <class T>
inline constexpr bool kIsOptional<std::optional<T>> = true;

/// The same of a type with fields: `SchemaFields::of<Hello>()`.
class SchemaFields {
 public:
  template <class T>
  static std::vector<std::string> of() {
    SchemaFields io;
    io.is_struct_ = Struct<T>;
    T value{};
    fields(io, value);
    return io.fields_;
  }

  template <class... T>
  void here(const T&...) {}
  template <class... T>
  void require(const T&...) {}

  template <class T, class... Options>
  void operator()(const char* name, T&, const Options&... options) {
    using Value = std::remove_const_t<T>;
    constexpr bool kIsScalar = Scalar<Value> || std::is_same_v<Value, std::optional<std::uint32_t>>;
    std::string type = name_of<Value>();
    if constexpr (Scalar<Value>) {
      if (const auto absent = default_of<Value>(options...); absent != Number<Value>{})
        type += " = " + std::to_string(static_cast<int>(absent));
    } else if constexpr (kIsScalar) {
      type += " = -1";
    } else if constexpr (!kHas<OmitEmpty, Options...> && !kIsOptional<Value>) {
      if (!is_struct_) type += " (required)";
    }
    fields_.push_back(std::string(name) + ": " + type);
  }

 private:
  template <class T>
  static std::string name_of() {
    if constexpr (std::is_same_v<T, std::optional<std::uint32_t>>)
      return "int32";
    else if constexpr (kIsOptional<T>)
      return name_of<typename T::value_type>();
    else if constexpr (std::is_same_v<T, std::string>)
      return "string";
    else if constexpr (Union<T>)
      return "union";
    else if constexpr (Scalar<T>)
      return number_name<Number<T>>();
    else if constexpr (HasFields<T>)
      return Struct<T> ? "struct" : "table";
    else
      return "[" + name_of<typename T::value_type>() + "]";
  }
  template <class T>
  static std::string number_name() {
    if (std::is_same_v<T, double>) return "double";
    if (std::is_same_v<T, float>) return "float";
    const std::string sign = std::is_signed_v<T> ? "" : "u";
    return sign + "int" + std::to_string(8 * sizeof(T));
  }

  bool is_struct_ = false;
  std::vector<std::string> fields_;
};

}  // namespace tether::wire
