#include "json_messages.h"

#include "damage.h"
#include "json_fields.h"
#include "json_metadata.h"
#include "sample_messages.h"
#include "schemas.h"

#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace tether::record {
namespace {

template <class Message>
std::string json_of(const Message& message) {
  std::string out;
  append_json(out, message);
  return out;
}

// A second writing of what was read is the same text, and the text says every member.
template <class Message, class Read>
void expect_round_trip(const Message& message, Read read) {
  const std::string text = json_of(message);
  EXPECT_EQ(json_of(read(text)), text);
}

TEST(JsonMessages, RoundTrip) {
  expect_round_trip(sensor_interaction(), interaction_from_json);
  expect_round_trip(command_interaction(), interaction_from_json);
  expect_round_trip(sleep_interaction(), interaction_from_json);
  expect_round_trip(command_effect(), command_effect_from_json);
  expect_round_trip(ground_truth(), ground_truth_from_json);
  expect_round_trip(vain_interaction(), interaction_from_json);
  expect_round_trip(annotation(), annotation_from_json);
  expect_round_trip(stop(), stop_from_json);
  expect_round_trip(image(), image_from_json);
}

TEST(JsonMessages, InteractionKeepsEveryMember) {
  const Interaction in = sensor_interaction();
  const Interaction out = interaction_from_json(json_of(in));
  EXPECT_EQ(out.uav, in.uav);
  EXPECT_EQ(out.sequence, in.sequence);
  EXPECT_EQ(out.kind, in.kind);
  EXPECT_EQ(out.sensor, in.sensor);
  EXPECT_EQ(out.sample_index, in.sample_index);
  EXPECT_EQ(out.latest, in.latest);
  EXPECT_EQ(out.request_at, in.request_at);
  EXPECT_EQ(out.reply_at, in.reply_at);
  EXPECT_EQ(out.sampled_at, in.sampled_at);
  EXPECT_EQ(out.sample_state_at, in.sample_state_at);
  EXPECT_EQ(out.available_at, in.available_at);
  EXPECT_EQ(out.effect_at, std::nullopt);
  EXPECT_EQ(out.sleep_until, std::nullopt);
  EXPECT_EQ(out.st_at_arrival, in.st_at_arrival);
  EXPECT_EQ(out.st_at_release, in.st_at_release);
  EXPECT_EQ(out.lag, in.lag);
  EXPECT_EQ(out.grid_error, in.grid_error);
  EXPECT_EQ(out.stamped, in.stamped);
  EXPECT_EQ(out.violation, in.violation);
  EXPECT_EQ(out.wall_at_arrival, in.wall_at_arrival);
  EXPECT_EQ(out.wall_at_release, in.wall_at_release);
  EXPECT_EQ(out.previous_link_time, in.previous_link_time);
}

TEST(JsonMessages, AReadThatFoundNothingHasNoIndex) {
  const auto json = nlohmann::json::parse(json_of(vain_interaction()));
  EXPECT_FALSE(json.contains("sample_index"));
  EXPECT_TRUE(interaction_from_json(json.dump()).only_if_available);
  auto other = json;
  other.erase("only_if_available");
  EXPECT_THROW(interaction_from_json(other.dump()), Damage);
}

TEST(JsonMessages, StopKeepsEveryMember) {
  const Stop out = stop_from_json(json_of(stop()));
  EXPECT_EQ(out.uav, stop().uav);
  EXPECT_EQ(out.at, stop().at);
  EXPECT_EQ(out.reply_at, stop().reply_at);
  EXPECT_EQ(out.wall, stop().wall);
  Stop without = stop();
  without.reply_at.reset();
  EXPECT_EQ(stop_from_json(json_of(without)).reply_at, std::nullopt);
}

TEST(JsonMessages, SignOfZeroSurvives) {
  EXPECT_TRUE(std::signbit(command_effect_from_json(json_of(command_effect())).vy_H_m_s));
}

TEST(JsonMessages, NotFiniteIsNullAndReadAsNan) {
  CommandEffect message = command_effect();
  message.vx_H_m_s = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(std::isnan(command_effect_from_json(json_of(message)).vx_H_m_s));
}

TEST(JsonMessages, AnnotationThatIsNoObjectBecomesText) {
  std::string deep;
  for (int i = 0; i < 100'000; ++i) {
    deep += "{\"a\":";
  }
  for (const std::string& json : {std::string("[1]"), std::string("{"), std::string("hello"),
                                  std::string(), std::string("{\"a\":\"\xFF\"}"), deep}) {
    Annotation message = annotation();
    message.json = json;
    const auto parsed = nlohmann::json::parse(json_of(message));
    EXPECT_TRUE(parsed.at("data").at("text").is_string());
    EXPECT_NO_THROW(annotation_from_json(json_of(message)));
  }
}

TEST(JsonMessages, AnnotationObjectIsKeptInOrder) {
  EXPECT_EQ(annotation_from_json(json_of(annotation())).json, annotation().json);
}

TEST(JsonMessages, FrameTransformIsWhatFoxgloveReads) {
  std::string out;
  append_frame_transform(out, ground_truth(1234));
  const auto json = nlohmann::json::parse(out);
  EXPECT_EQ(json.at("timestamp").at("sec"), 1);
  EXPECT_EQ(json.at("timestamp").at("nsec"), 234'000'000);
  EXPECT_EQ(json.at("parent_frame_id"), "world");
  EXPECT_EQ(json.at("child_frame_id"), "a");
  EXPECT_EQ(json.at("translation").at("z"), 1234.0);
  EXPECT_EQ(json.at("rotation").at("w"), 1.0);
  EXPECT_EQ(json.at("rotation").at("z"), 0.1);
}

// Each member taken away, or of the wrong type, is an error that names it.
TEST(JsonMessages, MissingAndWrongMembersAreNamed) {
  const auto whole = nlohmann::json::parse(json_of(sensor_interaction()));
  const auto schema = nlohmann::json::parse(kInteractionSchema.json);
  for (const auto& name : schema.at("required")) {
    auto json = whole;
    json.erase(name.get<std::string>());
    try {
      interaction_from_json(json.dump());
      ADD_FAILURE() << name;
    } catch (const Damage& damage) {
      EXPECT_NE(std::string(damage.what())
                    .find(name == "wall" ? "wall" : "\"" + name.get<std::string>() + "\""),
                std::string::npos)
          << damage.what();
    }
    json[name.get<std::string>()] = nlohmann::json::array();
    EXPECT_THROW(interaction_from_json(json.dump()), Damage) << name;
  }
}

TEST(JsonMessages, HostileTextIsRefused) {
  for (const std::string& text :
       {std::string(), std::string("[]"), std::string("{\"uav\":1e999}"), std::string(100'000, '['),
        std::string("{\"uav\":\"\\"), std::string("\"\\")}) {
    EXPECT_THROW(interaction_from_json(text), Damage) << text.substr(0, 20);
  }
}

TEST(JsonMessages, SchemasAreJsonAndListWhatIsWritten) {
  const std::pair<Schema, std::string> cases[] = {
      {kInteractionSchema, json_of(sensor_interaction())},
      {kInteractionSchema, json_of(command_interaction())},
      {kInteractionSchema, json_of(sleep_interaction())},
      {kCommandEffectSchema, json_of(command_effect())},
      {kGroundTruthSchema, json_of(ground_truth())},
      {kAnnotationSchema, json_of(annotation())},
      {kInteractionSchema, json_of(vain_interaction())},
      {kStopSchema, json_of(stop())},
      {kCompressedImageSchema, json_of(image())},
  };
  for (const auto& [schema, text] : cases) {
    const auto parsed = nlohmann::json::parse(schema.json);
    const auto message = nlohmann::json::parse(text);
    EXPECT_EQ(parsed.at("title"), schema.name);
    for (const auto& [name, value] : message.items()) {
      EXPECT_TRUE(parsed.at("properties").contains(name)) << schema.name << " " << name;
    }
    for (const auto& name : parsed.at("required")) {
      EXPECT_TRUE(message.contains(name.get<std::string>())) << schema.name << " " << name;
    }
  }
}

TEST(JsonMetadata, HeaderRoundTrip) {
  const Header in = header();
  const Header out = header_from_metadata(to_metadata(in));
  EXPECT_EQ(to_metadata(out), to_metadata(in));
  EXPECT_EQ(out.seed, in.seed);
  EXPECT_EQ(out.step, in.step);
  EXPECT_EQ(out.ground_truth_period, in.ground_truth_period);
  EXPECT_EQ(out.real_time_factor, in.real_time_factor);
  ASSERT_EQ(out.suts.size(), 2U);
  EXPECT_EQ(out.suts[0].command_latency, Duration(2'000'000));
  EXPECT_EQ(out.suts[0].cpu_factor, 6.5);
  ASSERT_EQ(out.sensors.size(), 2U);
  EXPECT_EQ(out.sensors[0].period, Duration(33'333'333));
  EXPECT_TRUE(out.sensors[0].periodic);
  EXPECT_EQ(out.sensors[0].delay_min, Duration(7));
  EXPECT_EQ(out.sensors[0].delay_max, Duration(8));
  EXPECT_EQ(out.sensors[1].delay_max, Duration::max());
  ASSERT_EQ(out.anchors.size(), 1U);
  EXPECT_EQ(out.anchors[0].size_m[2], 0.6);
  EXPECT_EQ(out.anchors[0].q_WA[2], -0.5);
}

TEST(JsonMetadata, TheTargetsReadingsComeBack) {
  const Header out = header_from_metadata(to_metadata(header()));
  ASSERT_TRUE(out.target);
  EXPECT_EQ(out.target->name, "my board");
  EXPECT_EQ(out.target->address, "ssh://pi@board");
  EXPECT_EQ(out.target->before, header().target->before);
  EXPECT_EQ(footer_from_metadata(to_metadata(footer())).target_after, footer().target_after);

  Header unread = header();
  unread.target.reset();
  EXPECT_FALSE(header_from_metadata(to_metadata(unread)).target);
}

TEST(JsonMetadata, ACameraIsDescribedAndNothingElse) {
  const Header out = header_from_metadata(to_metadata(header()));
  EXPECT_FALSE(out.sensors[1].camera);
  ASSERT_TRUE(out.sensors[0].camera);
  const CameraInfo& camera = *out.sensors[0].camera;
  EXPECT_EQ(camera.p_BS_m[2], -0.3);
  EXPECT_EQ(camera.q_BS[2], -0.5);
  EXPECT_EQ(camera.width_px, 640);
  EXPECT_EQ(camera.height_px, 480);
  EXPECT_EQ(camera.fx_px, 381.5);
  EXPECT_EQ(camera.fy_px, 382.5);
  EXPECT_EQ(camera.cx_px, 319.5);
  EXPECT_EQ(camera.cy_px, 239.25);
  EXPECT_EQ(camera.k1, 0.1);
  EXPECT_EQ(camera.k2, -0.2);
  EXPECT_EQ(camera.k3, 0.3);
  EXPECT_EQ(camera.p1, -0.4);
  EXPECT_EQ(camera.p2, 0.5);
}

StringMap with_sensors_changed(const std::string& from, const std::string& to) {
  StringMap values = to_metadata(header());
  std::string& sensors = values["sensors"];
  const auto at = sensors.find(from);
  EXPECT_NE(at, std::string::npos) << sensors;
  if (at != std::string::npos) sensors.replace(at, from.size(), to);
  return values;
}

// Records of Tether 0.1.0 say nothing of their cameras.
TEST(JsonMetadata, ARecordNeedNotDescribeItsCameras) {
  const std::string sensors = to_metadata(header()).at("sensors");
  const auto begin = sensors.find(R"(,"camera":{)");
  const std::string camera = sensors.substr(begin, sensors.find('}', begin) + 1 - begin);
  EXPECT_FALSE(header_from_metadata(with_sensors_changed(camera, "")).sensors[0].camera);
}

TEST(JsonMetadata, ACameraThatCannotBeIsRefused) {
  for (const auto& [from, to] : std::vector<std::pair<std::string, std::string>>{
           {R"("width_px":640)", R"("width_px":0)"},
           {R"("width_px":640)", R"("width_px":4294967297)"},
           {R"("height_px":480)", R"("height_px":-480)"},
           {R"("height_px":480,)", ""},
           {R"("fx_px":381.5)", R"("fx_px":0)"},
           {R"("fy_px":382.5)", R"("fy_px":null)"},
           {R"("k3":0.3,)", ""},
           {R"("q_BS":[0.5,)", R"("q_BS":[)"},
           {R"("camera":{)", R"("camera":7,"x":{)"}}) {
    EXPECT_THROW(header_from_metadata(with_sensors_changed(from, to)), Damage) << to;
  }
}

TEST(JsonMetadata, WithoutBoundsTheDelayOfASensorIsNotBounded) {
  StringMap values = to_metadata(header());
  std::string& sensors = values["sensors"];
  const std::string bounds = R"(,"delay_min_ns":7,"delay_max_ns":8)";
  ASSERT_NE(sensors.find(bounds), std::string::npos) << sensors;
  sensors.erase(sensors.find(bounds), bounds.size());
  const Header out = header_from_metadata(values);
  EXPECT_EQ(out.sensors[0].phase, Duration(5));
  EXPECT_EQ(out.sensors[0].delay_min, Duration(0));
  EXPECT_EQ(out.sensors[0].delay_max, Duration::max());
}

// Records of Tether 0.1.0 know no concurrent SUTs.
TEST(JsonMetadata, ARecordNeedNotKnowOfConcurrentSuts) {
  Header serial = header();
  serial.suts[1].concurrent = false;
  EXPECT_EQ(to_metadata(serial).at("suts").find("concurrent"), std::string::npos);
  EXPECT_FALSE(header_from_metadata(to_metadata(serial)).suts[1].concurrent);
  EXPECT_TRUE(header_from_metadata(to_metadata(header())).suts[1].concurrent);
  Footer without = footer();
  without.stops = 0;
  EXPECT_FALSE(to_metadata(without).contains("stops"));
  EXPECT_EQ(footer_from_metadata(to_metadata(without)).stops, 0U);
}

StringMap with_cores(const std::string& json) {
  StringMap values = to_metadata(header());
  std::string& suts = values["suts"];
  const std::string known = ",\"cores\":4";
  const auto at = suts.find(known);
  EXPECT_NE(at, std::string::npos) << suts;
  if (at != std::string::npos) suts.replace(at, known.size(), json);
  return values;
}

TEST(JsonMetadata, ARecordNeedNotKnowTheCoresOfASutsMachine) {
  EXPECT_EQ(header_from_metadata(to_metadata(header())).suts[0].cores, 4);
  EXPECT_EQ(header_from_metadata(to_metadata(header())).suts[1].cores, 0);
  EXPECT_EQ(header_from_metadata(with_cores("")).suts[0].cores, 0);
  EXPECT_EQ(header_from_metadata(with_cores(",\"cores\":1024")).suts[0].cores, 1024);
  for (const char* cores : {"0", "-1", "1025", "4294967298", "2.5", "null", "\"2\""})
    EXPECT_THROW(header_from_metadata(with_cores(std::string(",\"cores\":") + cores)), Damage)
        << cores;
}

TEST(JsonMetadata, FooterRoundTrip) {
  const Footer in = footer();
  const Footer out = footer_from_metadata(to_metadata(in));
  EXPECT_EQ(to_metadata(out), to_metadata(in));
  EXPECT_EQ(out.et_at_end, in.et_at_end);
  EXPECT_EQ(out.largest_lag, in.largest_lag);
}

TEST(JsonMetadata, MissingAndWrongValuesAreNamed) {
  // A record need not say anything of its target.
  Header required = header();
  required.target.reset();
  for (const auto& [name, unused] : to_metadata(required)) {
    StringMap values = to_metadata(required);
    values.erase(name);
    try {
      header_from_metadata(values);
      ADD_FAILURE() << name;
    } catch (const Damage& damage) {
      EXPECT_NE(std::string(damage.what()).find("\"" + name + "\""), std::string::npos);
    }
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
