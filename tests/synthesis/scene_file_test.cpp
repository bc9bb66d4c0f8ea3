// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "soslam/base/error.h"
#include "soslam/geometry/angles.h"
#include "soslam/synthesis/scene.h"
#include "support/edited_json.h"
#include "support/expect_error.h"
#include "support/folder_test.h"
#include "support/random.h"
#include "support/scene.h"

namespace soslam {
namespace {

using nlohmann::json;

json ValidScene() {
  return json::parse(R"({
    "name": "test",
    "camera": {"width": 64, "height": 48, "fx": 50, "fy": 50, "cx": 31.5, "cy": 23.5},
    "planes": [{"id": 4, "label": "floor", "normal": [0, 0, 1], "d": 0},
               {"id": 7, "label": "table", "normal": [0, 0, 1], "d": -0.5,
                "table": {"position": [3, 0], "half_size": [0.5, 0.5]}}],
    "walls": [{"normal": [-1, 0, 0], "d": 9}],
    "objects": [{"id": 2, "label": "tin", "shape": "cylinder", "half_axes": [0.1, 0.1, 0.2],
                 "plane": 7, "position": [3, 0.1], "yaw_deg": 90},
                {"id": 1, "label": "ball", "shape": "ellipsoid", "half_axes": [0.3, 0.2, 0.1],
                 "plane": 4, "position": [2, 1]}],
    "trajectory": {"frames": 5, "frame_interval": 0.1, "waypoints": [
      {"position": [0, 0, 1], "look_at": [3, 0, 0.5]},
      {"position": [0.4, 0.1, 1], "look_at": [3, 0.1, 0.5]}]}
  })");
}

TEST(ParseScene, ReadsEveryField) {
  json document = ValidScene();
  document["noise"] = {{"box_edge_sigma", 0.1}, {"image_sigma", 2.0}};
  document["seed"] = 5;
  document["boxes"] = "visible";
  document["min_visible_share"] = 0.4;
  const Scene scene = ParseScene(document, "scene.json");
  EXPECT_EQ(scene.name, "test");
  EXPECT_EQ(scene.camera.width, 64);
  ASSERT_EQ(scene.planes.size(), 2u);
  EXPECT_EQ(scene.planes[1].id, 7);
  ASSERT_TRUE(scene.planes[1].table);
  EXPECT_EQ(scene.planes[1].table->half_size, Eigen::Vector2d(0.5, 0.5));
  ASSERT_EQ(scene.objects.size(), 2u);
  EXPECT_EQ(scene.objects[0].id, 1) << "objects are sorted by id";
  EXPECT_EQ(scene.objects[0].texture_seed, 1);
  EXPECT_EQ(scene.objects[1].shape, Shape::kCylinder);
  EXPECT_EQ(scene.objects[1].plane_index, 1);
  EXPECT_DOUBLE_EQ(scene.objects[1].yaw, 0.5 * std::numbers::pi);
  EXPECT_EQ(scene.trajectory.frames, 5);
  EXPECT_DOUBLE_EQ(scene.noise.box_edge_sigma, 0.1);
  EXPECT_DOUBLE_EQ(scene.noise.miss_probability, 0.0);
  EXPECT_DOUBLE_EQ(scene.noise.false_share, 0.0);
  EXPECT_EQ(scene.seed, 5);
  EXPECT_EQ(scene.boxes, BoxedPart::kVisible);
  EXPECT_DOUBLE_EQ(scene.min_visible_share, 0.4);
  EXPECT_EQ(ParseScene(ValidScene(), "scene.json").boxes, BoxedPart::kWhole);
}

class SceneFileTest : public FolderTest {};

TEST_F(SceneFileTest, IsRefusedWithItsField) {
  const auto path = Write("scene.json", ValidScene().dump());
  ExpectEditsRefused(
      path,
      {{"/objects/1/shape", R"("torus")", "objects/1/shape"},
       {"/objects/0/half_axes/1", "-0.1", "objects/0/half_axes/1"},
       {"/objects/0/half_axes", "[1, 1]", "objects/0/half_axes"},
       {"/objects/1/plane", "5", "objects/1/plane: there is no plane with id 5"},
       {"/objects/1/id", "2", "objects/1/id: 2"},
       {"/planes/1/id", "4", "planes/1/id: 4"},
       {"/planes/0/normal/2", "2", "/planes/0/normal is [0,0,2]; expected a norm of 1"},
       {"/walls/0/normal/0", "0", "walls/0/normal"},
       {"/objects", "[]", "objects"},
       {"/trajectory/frames", "0", "trajectory/frames"},
       {"/trajectory/waypoints", "[]", "trajectory/waypoints"},
       {"/noise", R"({"blur": 1})", "blur"},
       {"/noise", R"({"false_share": 1.5})",
        "noise/false_share is 1.5; expected a number at least 0 and at most 1"},
       {"/boxes", R"("half")", R"(/boxes is "half"; expected one of whole, visible)"},
       {"/min_visible_share", "-0.1",
        "/min_visible_share is -0.1; expected a number at least 0 and at most 1"},
       {"/objects/0/label", R"("a,b")", "/objects/0: label has a comma"},
       {"/objects/1/half_axes", "[5, 5, 5]", "frame 0 is inside the object with id 1"},
       {"/planes/1", R"({"id": 7, "label": "table", "normal": [0, 0, 1], "d": -1.05,
                         "table": {"position": [0, 0], "half_size": [1, 1], "thickness": 0.1}})",
        "frame 0 is inside a table"},
       {"/planes/0/d", "-2", "frame 0 is behind the plane with id 4"},
       {"/walls/0/d", "-1", "behind walls/0"}},
      [&] { ReadScene(path); });
}

TEST(ParseScene, RefusesACameraWithoutAWayUp) {
  for (const json& look_at : {json{0, 0, 0}, json{0, 0, 1}}) {
    json document = ValidScene();
    document["trajectory"]["waypoints"][0]["look_at"] = look_at;
    ExpectError<InputError>(
        [&] { ParseScene(document, "scene.json"); },
        {"scene test", "frame 0 looks straight up or down, or at its own position"});
  }
}

TEST(Scene, ObjectsStandUprightOnTheirPlane) {
  json document = ValidScene();
  const double s = std::sqrt(0.5);
  document["planes"][0]["normal"] = {0.0, -s, s};
  document["planes"][0]["d"] = 0.3;
  const Scene scene = ParseScene(document, "scene.json");
  for (const SceneObject& object : scene.objects) {
    const Landmark landmark = ObjectBody(scene, object);
    const Plane& plane = scene.planes[object.plane_index].plane_in_world;
    EXPECT_NEAR(plane.SignedDistance(landmark.Centre()), object.half_axes.z(), 1e-12);
    const Eigen::Vector3d z_axis = landmark.frame_from_object.rotation * Eigen::Vector3d::UnitZ();
    EXPECT_NEAR((z_axis - plane.normal).norm(), 0.0, 1e-12);
    EXPECT_NEAR(Yaw(plane.normal, landmark.frame_from_object.rotation), object.yaw, 1e-12);
  }
}

TEST(Scene, LaidAndLeaningObjectsTouchTheirPlane) {
  for (const char* shape : {"box", "ellipsoid", "cylinder"}) {
    for (const RestingFace face : kRestingFaces) {
      json document = ValidScene();
      document["objects"][1]["shape"] = shape;
      document["objects"][1]["rests_on"] = kRestingFaceNames[static_cast<size_t>(face)];
      document["objects"][1]["tilt_deg"] = {10.0, -20.0};
      const Scene scene = ParseScene(document, "scene.json");
      const SceneObject& ball = scene.objects[0];
      EXPECT_EQ(ball.rests_on, face);
      const Landmark landmark = ObjectLandmark(scene, ball);
      EXPECT_EQ(landmark.half_axes, HalfAxesOnFace(ball.half_axes, face));
      // No point of the surface is below the floor, and some is on it.
      const Landmark body = ObjectBody(scene, ball);
      EXPECT_EQ(body.half_axes, ball.half_axes);
      const Rigid3d& world_from_own = body.frame_from_object;
      double lowest = std::numeric_limits<double>::infinity();
      for (int i = 0; i < 20000; ++i) {
        const Eigen::Vector3d direction = RandomVector(-1.0, 1.0);
        const auto depth =
            NearestIntersection(body, landmark.Centre() + 2.0 * direction, -direction);
        if (!depth) continue;
        lowest = std::min(lowest, (landmark.Centre() + (2.0 - *depth) * direction).z());
      }
      EXPECT_GT(lowest, -1e-9);
      EXPECT_LT(lowest, 0.02);
      EXPECT_NEAR(AngleBetweenDeg(landmark.frame_from_object.rotation * Eigen::Vector3d::UnitZ(),
                                  Eigen::Vector3d::UnitZ()),
                  std::hypot(10.0, 20.0), 1e-9);
      EXPECT_LT((world_from_own.translation - landmark.Centre()).norm(), 1e-12);
    }
  }
}

TEST(TruePoses, PassThroughWaypointsLookingAhead) {
  json document = ValidScene();
  document["trajectory"]["waypoints"].push_back(
      {{"position", {0.5, 0.6, 1.2}}, {"look_at", {2.0, 1.0, 0.4}}});
  const Scene scene = ParseScene(document, "scene.json");
  const std::vector<Rigid3d> poses = TruePoses(scene);
  ASSERT_EQ(poses.size(), 5u);
  for (int i = 0; i < 3; ++i) {
    const Waypoint& waypoint = scene.trajectory.waypoints[i];
    const Rigid3d& world_from_camera = poses[2 * i];
    EXPECT_NEAR((world_from_camera.translation - waypoint.position_in_world).norm(), 0.0, 1e-12);
    const Eigen::Vector2d pixel =
        scene.camera.Project(world_from_camera.Inverse() * waypoint.look_at_in_world).value();
    EXPECT_NEAR((pixel - Eigen::Vector2d(scene.camera.cx, scene.camera.cy)).norm(), 0.0, 1e-9);
  }
  for (const Rigid3d& world_from_camera : poses) {
    const Eigen::Matrix3d axes = world_from_camera.rotation.toRotationMatrix();
    EXPECT_NEAR(axes(2, 0), 0.0, 1e-12) << "the camera's x axis is level";
    EXPECT_LT(axes(2, 1), 0.0) << "the camera's y axis points down";
  }
}

TEST(TruePoses, OneWaypointIsACameraThatStandsStill) {
  json document = ValidScene();
  document["trajectory"]["waypoints"].erase(1);
  const std::vector<Rigid3d> poses = TruePoses(ParseScene(document, "scene.json"));
  for (const Rigid3d& pose : poses) EXPECT_EQ(pose.translation, Eigen::Vector3d(0, 0, 1));
}

TEST(ShippedScenes, ShowEveryObjectOftenEnough) {
  for (const std::string name : {"room", "ellipsoids", "laid", "leaning", "chairs"}) {
    const Scene scene = ReadScene(SOSLAM_SOURCE_DIR "/pipelines/scenes/" + name + ".json");
    const auto by_object = DetectionsByObject(SyntheticSequence(scene, false));
    for (size_t i = 0; i < by_object.size(); ++i) {
      EXPECT_GE(by_object[i].size(), 15u) << name << ": " << scene.objects[i].label;
    }
  }
}

}  // namespace
}  // namespace soslam
