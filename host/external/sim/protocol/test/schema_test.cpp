#include "wire_fields.h"

#include <gmock/gmock.h>

#include <tether/wire_testing/schema.h>

namespace tether::sim::protocol {
namespace {

template <class T>
void expect_same(const char* name) {
  EXPECT_THAT(wire::fields_in_schema(
                  TETHER_SOURCE_DIR "/host/external/sim/protocol/schema/simulator.fbs", name),
              testing::ElementsAreArray(wire::SchemaFields::of<T>()))
      << name;
}

// Programs in other languages read the schema.
TEST(Schema, HasTheFieldsOfEachMessageInTheirOrder) {
  expect_same<uav::Vec3>("Vec3");
  expect_same<uav::Quat>("Quat");
  expect_same<uav::Pose>("Pose");
  expect_same<uav::Rotor>("Rotor");
  expect_same<uav::BodyState>("BodyState");
  expect_same<uav::MultirotorParameters>("Airframe");
  expect_same<UavDescription>("Uav");
  expect_same<VisualMaterial>("Look");
  expect_same<Command>("Command");
  expect_same<uav::Setpoint>("Setpoint");
  expect_same<SetpointCommand>("SetpointCommand");
  expect_same<Motion>("Motion");
  expect_same<BodyName>("BodyName");
  expect_same<Open>("Open");
  expect_same<Reset>("Reset");
  expect_same<Advance>("Advance");
  expect_same<CastRays>("CastRays");
  expect_same<Render>("Render");
  expect_same<Touch>("Touch");
  expect_same<State>("State");
  expect_same<Opened>("Opened");
  expect_same<Distances>("Distances");
  expect_same<Picture>("Picture");
  expect_same<Failed>("Failed");
}

}  // namespace
}  // namespace tether::sim::protocol
