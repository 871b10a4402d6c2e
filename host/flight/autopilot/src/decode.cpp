#include <cmath>
#include <iterator>
#include <string>

#include <fmt/compile.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <tether/autopilot/flight_controller.h>
#include <tether/mavlink/frame.h>

namespace tether::autopilot {
namespace {

void add_value(std::string& json, const mavlink::Message& m, const mavlink::Field& field,
               std::size_t i) {
  using mavlink::Type;
  const auto add = [to = std::back_inserter(json)](auto value) {
    fmt::format_to(to, FMT_COMPILE("{}"), value);
  };
  if (field.type == Type::kUint64) return add(static_cast<std::uint64_t>(m.integer(field, i)));
  if (field.type != Type::kFloat && field.type != Type::kDouble) return add(m.integer(field, i));
  const double value = m.number(field, i);
  if (!std::isfinite(value)) return add("null");
  field.type == Type::kFloat ? add(static_cast<float>(value)) : add(value);
}

void add_values(std::string& json, const mavlink::Message& m, const mavlink::Field& field) {
  if (field.type == mavlink::Type::kChar) {
    json += nlohmann::json(m.text(field.name))
                .dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    return;
  }
  if (!field.is_array) return add_value(json, m, field, 0);
  json += '[';
  for (std::size_t i = 0; i < field.count; ++i) {
    if (i > 0) json += ',';
    add_value(json, m, field, i);
  }
  json += ']';
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
      ((fields += '"') += field.name) += "\":";
      add_values(fields, m, field);
    }
    messages.push_back({std::string(m.name()), fields + "}"});
  }
  if (messages.empty()) messages.push_back({{}, "{}"});
  return messages;
}

}  // namespace tether::autopilot
