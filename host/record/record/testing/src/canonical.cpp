#include "json/json_messages.h"
#include "json/json_text.h"
#include "mcap/mcap_format.h"

#include <algorithm>
#include <string_view>

#include <tether/record_testing/canonical.h>

namespace tether::record {
namespace {

// One line per message, one UAV after another, each in file order.
template <class Message, class AppendLine>
void append_lines(std::string& out, std::string_view topic,
                  const std::vector<Logged<Message>>& messages, AppendLine append_line) {
  std::vector<const Logged<Message>*> sorted;
  for (const Logged<Message>& logged : messages) {
    sorted.push_back(&logged);
  }
  std::ranges::stable_sort(sorted, {}, [](const Logged<Message>* logged) -> const std::string& {
    return logged->message.uav;
  });
  for (const Logged<Message>* logged : sorted) {
    out += topic;
    out += ' ';
    append_line(*logged);
    out += '\n';
  }
}

void append_log_time(std::string& out, SimTime at) {
  append_json_integer(out, to_ns(at));
  out += ' ';
}

template <class Pixels>
std::string_view bytes_of(const Pixels& pixels) {
  return {reinterpret_cast<const char*>(pixels.data()), pixels.size() * sizeof pixels[0]};
}

void append_image(std::string& out, const auto& image, std::string_view bytes) {
  JsonObject object(out);
  object.text("uav", image.uav);
  object.text("sensor", image.sensor);
  object.integer("index", image.index);
  object.integer("at_ns", to_ns(image.at));
  object.integer("bytes", bytes.size());
  object.integer("crc32", crc32(bytes));
  object.close();
}

void append_footer(std::string& out, const Footer& footer, const CanonicalOptions& options) {
  out += "end ";
  JsonObject object(out);
  object.text("end", footer.end);
  object.text("reason", footer.reason);
  object.integer("st_at_end_ns", to_ns(footer.st_at_end));
  char separator = '[';
  std::string& et = object.begin("et_at_end_ns");
  for (const ExecTime at : footer.et_at_end) {
    et += separator;
    append_json_integer(et, to_ns(at));
    separator = ',';
  }
  et += footer.et_at_end.empty() ? "[]" : "]";
  object.integer("interactions", footer.interactions);
  object.integer("causality_violations", footer.causality_violations);
  object.integer("largest_grid_error_ns", to_ns(footer.largest_grid_error));
  if (footer.stops > 0) {
    object.integer("stops", footer.stops);
    object.integer("largest_overshoot_ns", to_ns(footer.largest_overshoot));
  }
  if (options.arrivals) object.integer("largest_lag_ns", to_ns(footer.largest_lag));
  object.close();
  out += '\n';
}

}  // namespace

std::string canonical(const Record& record, const CanonicalOptions& options) {
  std::string out;
  append_lines(out, "interaction", record.interactions, [&](const Logged<Interaction>& logged) {
    append_log_time(out, logged.at);
    append_json(out, logged.message, {.wall = false, .arrivals = options.arrivals});
  });
  append_lines(out, "command", record.commands, [&](const Logged<CommandEffect>& logged) {
    append_log_time(out, logged.at);
    append_json(out, logged.message);
  });
  append_lines(out, "ground_truth", record.ground_truth, [&](const Logged<GroundTruth>& logged) {
    append_log_time(out, logged.at);
    append_json(out, logged.message);
  });
  append_lines(out, "annotation", record.annotations, [&](const Logged<Annotation>& logged) {
    if (options.arrivals) append_log_time(out, logged.at);
    append_json(out, logged.message);
  });
  append_lines(out, "stop", record.stops, [&](const Logged<Stop>& logged) {
    if (options.arrivals) append_log_time(out, logged.at);
    append_json(out, logged.message, {.wall = false});
  });
  append_lines(out, "contact", record.contacts, [&](const Logged<Contact>& logged) {
    append_log_time(out, logged.at);
    append_json(out, logged.message);
  });
  append_lines(out, "battery", record.batteries, [&](const Logged<Battery>& logged) {
    append_log_time(out, logged.at);
    append_json(out, logged.message);
  });
  append_lines(out, "radio", record.radio, [&](const Logged<RadioMessage>& logged) {
    append_log_time(out, logged.at);
    append_json(out, logged.message);
  });
  append_lines(out, "image", record.images, [&](const Logged<Image>& logged) {
    append_image(out, logged.message, bytes_of(logged.message.png));
  });
  append_lines(out, "raw_image", record.raw_images, [&](const Logged<RawImage>& logged) {
    std::visit([&](const auto& pixels) { append_image(out, logged.message, bytes_of(pixels)); },
               logged.message.pixels);
  });
  if (record.footer) append_footer(out, *record.footer, options);
  return out;
}

}  // namespace tether::record
