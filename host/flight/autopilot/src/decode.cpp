#include <cmath>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <tether/autopilot/flight_controller.h>
#include <tether/mavlink/frame.h>

namespace tether::autopilot {
namespace {

std::string value_of(const mavlink::Message& m, const mavlink::Field& field, std::size_t i) {
  using mavlink::Type;
  if (field.type == Type::kUint64)
    return std::to_string(static_cast<std::uint64_t>(m.integer(field.name, i)));
  if (field.type != Type::kFloat && field.type != Type::kDouble)
    return std::to_string(m.integer(field.name, i));
  const double value = m.number(field.name, i);
  if (!std::isfinite(value)) return "null";
  return field.type == Type::kFloat ? fmt::format("{}", static_cast<float>(value))
                                    : fmt::format("{}", value);
}

std::string values_of(const mavlink::Message& m, const mavlink::Field& field) {
  if (field.type == mavlink::Type::kChar)
    return nlohmann::json(m.text(field.name))
        .dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  if (!field.is_array) return value_of(m, field, 0);
  std::string values = "[";
  for (std::size_t i = 0; i < field.count; ++i)
    values += (i > 0 ? "," : "") + value_of(m, field, i);
  return values + "]";
}

}  // namespace

std::vector<Decoded> decode(const Bytes& bytes) {
  mavlink::Decoder decoder;
  std::vector<Decoded> messages;
  for (const mavlink::Frame& frame : decoder.push_datagram(bytes)) {
    const mavlink::Message& m = frame.message;
    std::string fields = "{";
    for (const mavlink::Field& field : m.type().fields) {
      if (fields.size() > 1) fields += ',';
      fields += fmt::format("\"{}\":{}", field.name, values_of(m, field));
    }
    messages.push_back({std::string(m.name()), fields + "}"});
  }
  if (messages.empty()) messages.push_back({{}, "{}"});
  return messages;
}

}  // namespace tether::autopilot
