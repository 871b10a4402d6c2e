#include "json/json_messages.h"

#include "damage.h"
#include "json/json_metadata.h"
#include "json/schemas.h"
#include "sample_messages.h"

#include <cmath>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace tether::record {
namespace {

using nlohmann::json;

std::string golden(const std::string& name) {
  std::ifstream file(TETHER_TEST_DIR "/data/" + name);
  return {std::istreambuf_iterator<char>(file), {}};
}

template <class... Parts>
std::string json_of(const auto& message, Parts... parts) {
  std::string out;
  append_json(out, message, parts...);
  return out;
}

template <class Message>
void check_form(std::string& texts, const Message& message, const Schema& schema) {
  const std::string text = json_of(message);
  EXPECT_EQ(json_of(from_json<Message>(text)), text);
  texts += text + "\n";
  const json described = json::parse(schema.json), written = json::parse(text);
  EXPECT_EQ(described.at("title"), schema.name);
  for (const auto& [name, value] : written.items())
    EXPECT_TRUE(described.at("properties").contains(name)) << schema.name << " " << name;
  for (const auto& name : described.at("required"))
    EXPECT_TRUE(written.contains(name.get<std::string>())) << schema.name << " " << name;
}

/// What Foxglove needs to show a topic.
void check_property(const json& property, const std::string& where) {
  ASSERT_TRUE(property.at("type").is_string()) << where;
  if (property.at("type") == "array") check_property(property.at("items"), where + "[]");
  if (property.at("type") != "object") return;
  ASSERT_TRUE(property.contains("properties")) << where;
  for (const auto& [name, inner] : property.at("properties").items())
    check_property(inner, where + "." + name);
}

TEST(JsonMessages, SchemasAreAsFoxgloveReadsThem) {
  for (const Schema* schema :
       {&kInteractionSchema, &kCommandEffectSchema, &kGroundTruthSchema, &kAnnotationSchema,
        &kStopSchema, &kContactSchema, &kBatterySchema, &kRadioMessageSchema, &kMarginSchema,
        &kCompressedImageSchema, &kRawImageSchema, &kFrameTransformSchema})
    check_property(json::parse(schema->json), std::string(schema->name));
}

TEST(JsonMessages, RawImagesKeepEveryNumber) {
  constexpr float kInf = std::numeric_limits<float>::infinity();
  RawImage depths{"uav1", "depth", from_ns<SimTime>(1'500'000'002), 3,
                  2,      1,       std::vector{1.25F, -kInf}};
  RawImage labels = depths;
  labels.pixels = std::vector<std::uint16_t>{0, 65535};
  std::string texts;
  for (const RawImage& image : {depths, labels}) {
    check_form(texts, image, kRawImageSchema);
    const RawImage read = from_json<RawImage>(json_of(image));
    EXPECT_EQ(read.pixels, image.pixels);
    EXPECT_EQ(read.at, image.at);
  }
  const json whole = json::parse(json_of(depths));
  for (const auto& [member, value] : {std::pair{"width", json(3)},
                                      {"height", json(0)},
                                      {"encoding", json("rgb8")},
                                      {"encoding", json("16UC1")},
                                      {"data", json("?")}}) {
    json damaged = whole;
    damaged[member] = value;
    EXPECT_THROW(from_json<RawImage>(damaged.dump()), Damage) << member;
  }
}

TEST(JsonMessages, ReadsOfImagesHaveTheAnchorsThatAreSeen) {
  Interaction read = sensor_interaction();
  read.seen_anchors.emplace();
  std::string texts;
  check_form(texts, read, kInteractionSchema);
  read.seen_anchors = {{"box", 1, 2, 3, 4, 5}, {"ball", 0, 0, 0, 0, 1}};
  check_form(texts, read, kInteractionSchema);
  EXPECT_EQ(from_json<Interaction>(json_of(read)).seen_anchors, read.seen_anchors);
  for (const char* wrong : {R"("no list")", "[3]", R"([{"anchor":"box"}])"}) {
    json damaged = json::parse(json_of(read));
    damaged["seen_anchors"] = json::parse(wrong);
    EXPECT_THROW(from_json<Interaction>(damaged.dump()), Damage) << wrong;
  }
}

// Between them, the samples have a value other than the default for every member. Every text is
// read back, and matches its schema.
TEST(JsonMessages, FormIsStable) {
  std::string texts;
  for (const Interaction& message :
       {sensor_interaction(), command_interaction(), sleep_interaction(), vain_interaction()})
    check_form(texts, message, kInteractionSchema);
  check_form(texts, stop(), kStopSchema);
  check_form(texts, contact(), kContactSchema);
  check_form(texts, command_effect(), kCommandEffectSchema);
  check_form(texts, ground_truth(), kGroundTruthSchema);
  check_form(texts, annotation(), kAnnotationSchema);
  check_form(texts, image(), kCompressedImageSchema);
  check_form(texts, battery(), kBatterySchema);
  check_form(texts, receive_interaction(), kInteractionSchema);
  check_form(texts, battery_interaction(), kInteractionSchema);
  check_form(texts, radio_message(), kRadioMessageSchema);
  texts += json_of(sensor_interaction(), JsonParts{.wall = false, .arrivals = false}) + "\n";
  texts += json_of(stop(), JsonParts{.wall = false}) + "\n";
  append_frame_transform(texts, ground_truth(1234));
  EXPECT_EQ(texts + "\n", golden("messages.txt"));
}

TEST(JsonMessages, SetpointsHaveTheFieldsOfTheirMask) {
  Setpoint every{.after = Duration(7), .mask = 511, .in_heading = true, .p_WB_m = {1, 2, 3}};
  every.q_WB[1] = 0.5;
  every.rotor_speeds_rad_s = {4, 5, 6};
  Interaction command = command_interaction();
  command.command.reset();
  command.setpoints = {every, {.mask = 128, .thrust_N = 8}};
  command.command_latency = Duration(9);
  CommandEffect effect = command_effect();
  effect.setpoint = every;
  effect.index = 3;
  effect.loss = "hover";
  std::string texts;
  check_form(texts, command, kInteractionSchema);
  check_form(texts, effect, kCommandEffectSchema);
  EXPECT_EQ(from_json<Interaction>(json_of(command)).setpoints, command.setpoints);
  EXPECT_EQ(from_json<CommandEffect>(json_of(effect)).setpoint, every);
  EXPECT_NE(texts.find(R"({"mask":128,"thrust_n":8})"), std::string::npos);
}

TEST(JsonMessages, NotFiniteIsNullAndReadAsNan) {
  CommandEffect message = command_effect();
  message.vx_H_m_s = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(std::isnan(from_json<CommandEffect>(json_of(message)).vx_H_m_s));
}

TEST(JsonMessages, AnnotationThatIsNotAnObjectBecomesText) {
  std::string deep;
  for (int i = 0; i < 100'000; ++i) deep += "{\"a\":";
  for (const std::string& text : {std::string("[1]"), std::string("{"), std::string("hello"),
                                  std::string(), std::string("{\"a\":\"\xFF\"}"), deep}) {
    Annotation message = annotation();
    message.json = text;
    EXPECT_TRUE(json::parse(json_of(message)).at("data").at("text").is_string());
    EXPECT_NO_THROW(from_json<Annotation>(json_of(message)));
  }
}

std::string damaged_name(const std::function<void()>& read) {
  try {
    read();
  } catch (const Damage& damage) {
    return damage.name();
  }
  return "no damage";
}

// Every required member, missing and of the wrong type.
TEST(JsonMessages, MissingAndWrongMembersAreNamed) {
  const json whole = json::parse(json_of(sensor_interaction()));
  auto names = json::parse(kInteractionSchema.json).at("required").get<std::vector<std::string>>();
  names.emplace_back("sample_index");
  for (const std::string& name : names) {
    json changed = whole;
    changed.erase(name);
    EXPECT_EQ(damaged_name([&] { from_json<Interaction>(changed.dump()); }), name);
    changed[name] = json::array();
    EXPECT_THROW(from_json<Interaction>(changed.dump()), Damage) << name;
  }
}

TEST(JsonMessages, RefusesHostileText) {
  for (const std::string& text :
       {std::string(), std::string("[]"), std::string("{\"uav\":1e999}"), std::string(100'000, '['),
        std::string("{\"uav\":\"\\"), std::string("\"\\")}) {
    EXPECT_THROW(from_json<Interaction>(text), Damage) << text.substr(0, 20);
  }
}

TEST(JsonMetadata, FormIsStableAndReadBack) {
  Header whole = header();
  whole.wall_at_start = from_ns<WallTime>(99);
  const StringMap start = to_metadata(whole), end = to_metadata(footer());
  std::string texts;
  for (const StringMap& values : {start, end})
    for (const auto& [name, value] : values) texts += name + "=" + value + "\n";
  EXPECT_EQ(texts, golden("metadata.txt"));
  EXPECT_EQ(to_metadata(header_from_metadata(start)), start);
  EXPECT_EQ(to_metadata(footer_from_metadata(end)), end);
}

// The sample's metadata with `from` replaced in one of the values.
StringMap changed(const std::string& name, const std::string& from, const std::string& to) {
  StringMap values = to_metadata(header());
  const auto at = values.at(name).find(from);
  if (at == std::string::npos) throw std::logic_error("the sample does not have " + from);
  values.at(name).replace(at, from.size(), to);
  return values;
}

TEST(JsonMetadata, WhatWasSkippedIsReadBack) {
  Interaction skip = vain_interaction();
  skip.skipped_to = 7;
  EXPECT_EQ(from_json<Interaction>(json_of(skip)).skipped_to, 7U);
  EXPECT_FALSE(from_json<Interaction>(json_of(vain_interaction())).skipped_to);
}

// Records of earlier versions do not have them.
TEST(JsonMetadata, DriversAndRadiosByDistributionAreReadBack) {
  Interaction read = sensor_interaction();
  read.sample_stamp = st_ms(7);
  read.repeated_index = 4;
  const auto again = from_json<Interaction>(json_of(read));
  EXPECT_EQ(again.sample_stamp, read.sample_stamp);
  EXPECT_EQ(again.repeated_index, read.repeated_index);

  Header written = header();
  written.sensors[0].driver = DriverInfo{Duration(-5), Duration(6), -20'000, 0.1, 1.0 / 3.0};
  written.radio = {.model = "distribution",
                   .least_delay = Duration(5),
                   .inbox_messages = 3,
                   .most_delay = Duration::max(),
                   .loss_probability = 1.0 / 3.0,
                   .burst_begin_probability = 0.1,
                   .burst_end_probability = 0.7};
  const Header got = header_from_metadata(to_metadata(written));
  EXPECT_EQ(got.sensors[0].driver, written.sensors[0].driver);
  EXPECT_EQ(got.radio, written.radio);
}

TEST(JsonMetadata, OptionalValuesHaveDefaults) {
  const std::string sensors = to_metadata(header()).at("sensors");
  const auto begin = sensors.find(R"(,"camera":{)");
  const std::string camera = sensors.substr(begin, sensors.find('}', begin) + 1 - begin);
  EXPECT_FALSE(header_from_metadata(changed("sensors", camera, "")).sensors[0].camera);

  const SensorInfo unbounded =
      header_from_metadata(changed("sensors", R"(,"delay_min_ns":7,"delay_max_ns":8)", ""))
          .sensors[0];
  EXPECT_EQ(unbounded.phase, Duration(5));
  EXPECT_EQ(unbounded.delay_min, Duration(0));
  EXPECT_EQ(unbounded.delay_max, Duration::max());

  EXPECT_EQ(header_from_metadata(changed("suts", ",\"cores\":4", "")).suts[0].cores, 0);
  EXPECT_FALSE(header_from_metadata(to_metadata(header())).suts[1].required_clock);
  EXPECT_FALSE(
      header_from_metadata(changed("suts", ",\"concurrent\":true", "")).suts[1].concurrent);

  Header unread = header();
  unread.target.reset();
  unread.reports_contacts = false;
  unread.emulator = {};
  EXPECT_FALSE(header_from_metadata(to_metadata(unread)).target);
  EXPECT_FALSE(header_from_metadata(to_metadata(unread)).reports_contacts);
  EXPECT_EQ(header_from_metadata(to_metadata(unread)).emulator, EmulatorInfo{});

  Footer without_stops = footer();
  without_stops.stops = 0;
  without_stops.clearances.clear();
  EXPECT_FALSE(to_metadata(without_stops).contains("stops"));
  EXPECT_FALSE(to_metadata(without_stops).contains("clearances"));
  EXPECT_EQ(footer_from_metadata(to_metadata(without_stops)).stops, 0U);
}

TEST(JsonMetadata, RefusesImpossibleCamerasAndCores) {
  struct Case {
    const char *list, *from, *to, *name;
  };
  for (const Case& c : {Case{"sensors", R"("width_px":640)", R"("width_px":0)", "width_px"},
                        {"sensors", R"("width_px":640)", R"("width_px":4294967297)", "width_px"},
                        {"sensors", R"("height_px":480)", R"("height_px":-480)", "height_px"},
                        {"sensors", R"("height_px":480,)", "", "height_px"},
                        {"sensors", R"("fx_px":381.5)", R"("fx_px":0)", "fx_px"},
                        {"sensors", R"("fy_px":382.5)", R"("fy_px":null)", "fy_px"},
                        {"sensors", R"("k3":0.3,)", "", "k3"},
                        {"sensors", R"("q_BS":[0.5,)", R"("q_BS":[)", "q_BS"},
                        {"sensors", R"("camera":{)", R"("camera":7,"x":{)", "p_BS_m"},
                        {"suts", "\"cores\":4", "\"cores\":0", "cores"},
                        {"suts", "\"cores\":4", "\"cores\":-1", "cores"},
                        {"suts", "\"cores\":4", "\"cores\":1025", "cores"},
                        {"suts", "\"cores\":4", "\"cores\":4294967298", "cores"},
                        {"suts", "\"cores\":4", "\"cores\":2.5", "cores"},
                        {"suts", "\"cores\":4", "\"cores\":null", "cores"},
                        {"suts", "\"cores\":4", "\"cores\":\"2\"", "cores"}}) {
    EXPECT_EQ(damaged_name([&] { header_from_metadata(changed(c.list, c.from, c.to)); }), c.name)
        << c.to;
  }
  EXPECT_EQ(header_from_metadata(changed("suts", "\"cores\":4", "\"cores\":1024")).suts[0].cores,
            1024);
}

TEST(JsonMetadata, MissingAndWrongValuesAreNamed) {
  Header required = header();  // these may be left out
  required.target.reset();
  required.reports_contacts = false;
  required.emulator = {};
  for (const auto& [name, unused] : to_metadata(required)) {
    StringMap values = to_metadata(required);
    values.erase(name);
    EXPECT_EQ(damaged_name([&] { header_from_metadata(values); }), name);
  }
  for (const char* name : {"seed", "step_ns", "suts", "sensors", "anchors", "schema_version"}) {
    for (const char* wrong : {"", "x", "1x", "99999999999999999999999999", "[1]", "{\"a\":1}"}) {
      StringMap values = to_metadata(header());
      values[name] = wrong;
      EXPECT_THROW(header_from_metadata(values), Damage) << name << " " << wrong;
    }
  }
}

}  // namespace
}  // namespace tether::record
