#include "wire_fields.h"

#include <gmock/gmock.h>

#include <tether/wire_testing/schema.h>

namespace tether::link {
namespace {

template <class T>
void expect_same(const char* name) {
  EXPECT_THAT(wire::fields_in_schema(TETHER_SOURCE_DIR "/common/link/schema/link.fbs", name),
              testing::ElementsAreArray(wire::SchemaFields::of<T>()))
      << name;
}

// Programs in other languages read the schema.
TEST(Schema, HasTheFieldsOfEachMessageInTheirOrder) {
  expect_same<uav::Vec3>("Vec3");
  expect_same<uav::Quat>("Quat");
  expect_same<uav::Pose>("Pose");
  expect_same<uav::CameraProperties>("CameraProperties");
  expect_same<uav::RangeProperties>("RangeProperties");
  expect_same<uav::Anchor>("Anchor");
  expect_same<uav::Catalogue>("Catalogue");
  expect_same<uav::CameraSample>("CameraSample");
  expect_same<uav::ImuSample>("ImuSample");
  expect_same<uav::NavSatProperties>("NavSatProperties");
  expect_same<uav::NavSatSample>("NavSatSample");
  expect_same<uav::MagnetometerProperties>("MagnetometerProperties");
  expect_same<uav::MagnetometerSample>("MagnetometerSample");
  expect_same<uav::BarometerProperties>("BarometerProperties");
  expect_same<uav::BarometerSample>("BarometerSample");
  expect_same<uav::OdometryProperties>("OdometryProperties");
  expect_same<uav::OdometrySample>("OdometrySample");
  expect_same<uav::ScanProperties>("ScanProperties");
  expect_same<uav::ScanSample>("ScanSample");
  expect_same<uav::JointStateProperties>("JointStateProperties");
  expect_same<uav::JointStateSample>("JointStateSample");
  expect_same<uav::RangeSample>("RangeSample");
  expect_same<uav::BatterySample>("BatterySample");
  expect_same<uav::SensorDescription>("Sensor");
  expect_same<Finish>("FinishMission");
  expect_same<Hello>("Hello");
  expect_same<BuildPart>("BuildPart");
  expect_same<StageTime>("StageTime");
  expect_same<Welcome>("Welcome");
  expect_same<Refusal>("Refusal");
  expect_same<ReadSensor>("ReadSensor");
  expect_same<SetVelocity>("SetVelocity");
  expect_same<uav::Setpoint>("Setpoint");
  expect_same<uav::TimedSetpoint>("TimedSetpoint");
  expect_same<SetTrajectory>("SetTrajectory");
  expect_same<Sleep>("Sleep");
  expect_same<SendMessage>("SendMessage");
  expect_same<ReceiveMessage>("ReceiveMessage");
  expect_same<Request>("Request");
  expect_same<RadioMessage>("RadioMessage");
  expect_same<Reply>("Reply");
  expect_same<Progress>("Progress");
  expect_same<Due>("Due");
  expect_same<Annotation>("Annotation");
  expect_same<Envelope>("Envelope");
}

}  // namespace
}  // namespace tether::link
