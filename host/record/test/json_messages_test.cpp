#include "json_messages.h"

#include "damage.h"
#include "json_metadata.h"
#include "sample_messages.h"
#include "schemas.h"

#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace tether::record {
namespace {

using nlohmann::json;

template <class Message>
std::string json_of(const Message& message, JsonParts parts = {}) {
  std::string out;
  if constexpr (requires { append_json(out, message, parts); }) {
    append_json(out, message, parts);
  } else {
    append_json(out, message);
  }
  return out;
}

struct Form {
  Schema schema;
  std::string written;
  std::string again;  ///< read, and written again
  std::string expected;
};

template <class Message>
Form form(const Schema& schema, const Message& message, Message (*read)(std::string_view),
          std::string expected) {
  const std::string text = json_of(message);
  return {schema, text, json_of(read(text)), std::move(expected)};
}

// Between them, the samples have a value other than the default for every member.
std::vector<Form> forms() {
  return {
      form(kInteractionSchema, sensor_interaction(), interaction_from_json,
           R"({"uav":"uav \"1\" é","sequence":1,"kind":"sensor","request_at_ns":5500001,)"
           R"("reply_at_ns":9007199254740993,"sensor":"camera",)"
           R"("sample_index":18446744073709551615,"latest":true,"sampled_at_ns":5500001,)"
           R"("sample_state_at_ns":5000000,"available_at_ns":37500001,"st_at_arrival_ns":3000000,)"
           R"("lag_ns":2500001,"st_at_release_ns":37000000,"grid_error_ns":500001,)"
           R"("stamped":false,"violation":"sample from the future\n","wall":{)"
           R"("arrival_ns":123456789,"release_ns":223456789,"previous_link_ns":-5}})"),
      form(kInteractionSchema, command_interaction(), interaction_from_json,
           R"({"uav":"a","sequence":2,"kind":"command","request_at_ns":40000001,)"
           R"("reply_at_ns":40000001,"effect_at_ns":41000000,"st_at_arrival_ns":0,"lag_ns":0,)"
           R"("st_at_release_ns":40000000,"grid_error_ns":0,"stamped":true,)"
           R"("wall":{"arrival_ns":0,"release_ns":0}})"),
      form(kInteractionSchema, sleep_interaction(), interaction_from_json,
           R"({"uav":"a","sequence":3,"kind":"sleep","request_at_ns":0,"reply_at_ns":0,)"
           R"("sleep_until_ns":50000000,"st_at_arrival_ns":0,"lag_ns":0,"st_at_release_ns":0,)"
           R"("grid_error_ns":0,"stamped":true,"wall":{"arrival_ns":0,"release_ns":0}})"),
      form(kInteractionSchema, vain_interaction(), interaction_from_json,
           R"({"uav":"a","sequence":4,"kind":"sensor","request_at_ns":50000000,)"
           R"("reply_at_ns":50000000,"sensor":"camera","latest":false,"only_if_available":true,)"
           R"("st_at_arrival_ns":0,"lag_ns":0,"st_at_release_ns":50000000,"grid_error_ns":0,)"
           R"("stamped":true,"wall":{"arrival_ns":0,"release_ns":0}})"),
      form(kStopSchema, stop(), stop_from_json,
           R"({"uav":"a","at_ns":50000321,"reply_at_ns":50000000,)"
           R"("wall":{"arrival_ns":323456789}})"),
      form(kCommandEffectSchema, command_effect(), command_effect_from_json,
           R"({"uav":"a","sequence":2,"applied_at_ns":41000000,"vx_H_m_s":0.1,"vy_H_m_s":-0.0,)"
           R"("vz_H_m_s":1e-300,"yaw_rate_rad_s":0.3333333333333333})"),
      form(kGroundTruthSchema, ground_truth(), ground_truth_from_json,
           R"({"uav":"a","at_ns":40000000,"p_WB_m":[0.3333333333333333,-2.5e+22,40],)"
           R"("q_WB":[1,0,0,0.1],"v_WB_m_s":[0,5e-324,0],)"
           R"("w_WB_B_rad_s":[0,0,-1.7976931348623157e+308]})"),
      form(kAnnotationSchema, annotation(), annotation_from_json,
           R"({"uav":"a","at_ns":39999999,"topic":"roi",)"
           R"("data":{"z":[1,2.5,{"x":null}],"a":"ü"}})"),
      form(kCompressedImageSchema, image(), image_from_json,
           R"({"timestamp":{"sec":0,"nsec":33000000},"frame_id":"a/camera","format":"png",)"
           R"("uav":"a","sensor":"camera","index":7,"data":"iVBORwD/AQ=="})"),
  };
}

TEST(JsonMessages, FormIsStableReadBackAndDescribedByTheSchema) {
  for (const Form& form : forms()) {
    EXPECT_EQ(form.written, form.expected);
    EXPECT_EQ(form.again, form.expected);
    const json schema = json::parse(form.schema.json), message = json::parse(form.written);
    EXPECT_EQ(schema.at("title"), form.schema.name);
    for (const auto& [name, value] : message.items())
      EXPECT_TRUE(schema.at("properties").contains(name)) << form.schema.name << " " << name;
    for (const auto& name : schema.at("required"))
      EXPECT_TRUE(message.contains(name.get<std::string>())) << form.schema.name << " " << name;
  }
}

TEST(JsonMessages, WritesOnlyTheRequestedParts) {
  const json interaction =
      json::parse(json_of(sensor_interaction(), {.wall = false, .arrivals = false}));
  for (const char* left_out : {"wall", "st_at_arrival_ns", "lag_ns"})
    EXPECT_FALSE(interaction.contains(left_out)) << left_out;
  EXPECT_EQ(interaction.at("st_at_release_ns"), 37'000'000);
  EXPECT_FALSE(json::parse(json_of(stop(), {.wall = false})).contains("wall"));
}

TEST(JsonMessages, FrameTransformHasFoxglovesForm) {
  std::string out;
  append_frame_transform(out, ground_truth(1234));
  EXPECT_EQ(out,
            R"({"timestamp":{"sec":1,"nsec":234000000},"parent_frame_id":"world",)"
            R"("child_frame_id":"a","translation":{"x":0.3333333333333333,"y":-2.5e+22,"z":1234},)"
            R"("rotation":{"x":0,"y":0,"z":0.1,"w":1}})");
}

TEST(JsonMessages, NotFiniteIsNullAndReadAsNan) {
  CommandEffect message = command_effect();
  message.vx_H_m_s = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(std::isnan(command_effect_from_json(json_of(message)).vx_H_m_s));
}

TEST(JsonMessages, AnnotationThatIsNotAnObjectBecomesText) {
  std::string deep;
  for (int i = 0; i < 100'000; ++i) deep += "{\"a\":";
  for (const std::string& text : {std::string("[1]"), std::string("{"), std::string("hello"),
                                  std::string(), std::string("{\"a\":\"\xFF\"}"), deep}) {
    Annotation message = annotation();
    message.json = text;
    EXPECT_TRUE(json::parse(json_of(message)).at("data").at("text").is_string());
    EXPECT_NO_THROW(annotation_from_json(json_of(message)));
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
    EXPECT_EQ(damaged_name([&] { interaction_from_json(changed.dump()); }), name);
    changed[name] = json::array();
    EXPECT_THROW(interaction_from_json(changed.dump()), Damage) << name;
  }
}

TEST(JsonMessages, RefusesHostileText) {
  for (const std::string& text :
       {std::string(), std::string("[]"), std::string("{\"uav\":1e999}"), std::string(100'000, '['),
        std::string("{\"uav\":\"\\"), std::string("\"\\")}) {
    EXPECT_THROW(interaction_from_json(text), Damage) << text.substr(0, 20);
  }
}

StringMap header_values() {
  return {
      {"anchors", R"([{"name":"box","shape":"box","size_m":[0.4,0.5,0.6],"p_WA_m":[8,0,1.5],)"
                  R"("q_WA":[0.5,0.5,-0.5,0.5]}])"},
      {"condition", "target, no sync"},
      {"ground_truth_period_ns", "10000000"},
      {"machine", "test"},
      {"policy", "conservative_barrier"},
      {"real_time_factor", "0.3"},
      {"scenario", "face_anchor"},
      {"schema_version", "1"},
      {"seed", "18446744073709551615"},
      {"sensors",
       R"([{"uav":"a","name":"camera","kind":"camera","periodic":true,"period_ns":33333333,)"
       R"("phase_ns":5,"delay_min_ns":7,"delay_max_ns":8,"camera":{"p_BS_m":[0.1,0.2,-0.3],)"
       R"("q_BS":[0.5,0.5,-0.5,0.5],"width_px":640,"height_px":480,"fx_px":381.5,"fy_px":382.5,)"
       R"("cx_px":319.5,"cy_px":239.25,"k1":0.1,"k2":-0.2,"k3":0.3,"p1":-0.4,"p2":0.5}},)"
       R"({"uav":"a","name":"range","kind":"range","periodic":false,"period_ns":0,"phase_ns":0,)"
       R"("delay_min_ns":0,"delay_max_ns":9223372036854775807}])"},
      {"simulator", "mujoco 2.2.2"},
      {"step_ns", "1000000"},
      {"suts", R"([{"uav":"a","sut":"tether-sut 0.1.0","clock":"cpu","cpu_factor":6.5,)"
               R"("command_latency_ns":2000000,"cores":4},{"uav":"b","sut":"other",)"
               R"("clock":"wall","cpu_factor":1,"command_latency_ns":0,"concurrent":true}])"},
      {"target/governor", "ondemand"},
      {"target/throttled", "0x50005"},
      {"target_address", "ssh://pi@board"},
      {"target_name", "my board"},
      {"tether_version", "0.1.0"},
      {"wall_at_start_ns", "99"},
  };
}

TEST(JsonMetadata, FormIsStableAndReadBack) {
  Header whole = header();
  whole.wall_at_start = from_ns<WallTime>(99);
  EXPECT_EQ(to_metadata(whole), header_values());
  EXPECT_EQ(to_metadata(header_from_metadata(header_values())), header_values());
  const StringMap end = {{"causality_violations", "1"},       {"end", "finished"},
                         {"et_at_end_ns", "[50000000,-1]"},   {"interactions", "4"},
                         {"largest_grid_error_ns", "500001"}, {"largest_lag_ns", "2500001"},
                         {"largest_overshoot_ns", "321"},     {"reason", "goal reached"},
                         {"st_at_end_ns", "50000000"},        {"stops", "1"},
                         {"target/temperature_mc", "82500"},  {"wall_ns", "77"}};
  EXPECT_EQ(to_metadata(footer()), end);
  EXPECT_EQ(to_metadata(footer_from_metadata(end)), end);
}

// The sample's metadata with `from` replaced in one of the values.
StringMap changed(const std::string& name, const std::string& from, const std::string& to) {
  StringMap values = header_values();
  const auto at = values.at(name).find(from);
  if (at == std::string::npos) throw std::logic_error("the sample does not have " + from);
  values.at(name).replace(at, from.size(), to);
  return values;
}

// Records of earlier versions do not have them.
TEST(JsonMetadata, OptionalValuesHaveDefaults) {
  const std::string sensors = header_values().at("sensors");
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
  EXPECT_FALSE(
      header_from_metadata(changed("suts", ",\"concurrent\":true", "")).suts[1].concurrent);

  Header unread = header();
  unread.target.reset();
  EXPECT_FALSE(header_from_metadata(to_metadata(unread)).target);

  Footer without_stops = footer();
  without_stops.stops = 0;
  EXPECT_FALSE(to_metadata(without_stops).contains("stops"));
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
  Header required = header();  // the target may be left out
  required.target.reset();
  for (const auto& [name, unused] : to_metadata(required)) {
    StringMap values = to_metadata(required);
    values.erase(name);
    EXPECT_EQ(damaged_name([&] { header_from_metadata(values); }), name);
  }
  for (const char* name : {"seed", "step_ns", "suts", "sensors", "anchors", "schema_version"}) {
    for (const char* wrong : {"", "x", "1x", "99999999999999999999999999", "[1]", "{\"a\":1}"}) {
      StringMap values = header_values();
      values[name] = wrong;
      EXPECT_THROW(header_from_metadata(values), Damage) << name << " " << wrong;
    }
  }
}

}  // namespace
}  // namespace tether::record
