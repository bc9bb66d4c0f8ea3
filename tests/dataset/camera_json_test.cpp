// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "soslam/base/error.h"
#include "soslam/dataset/dataset_json.h"
#include "support/expect_error.h"
#include "support/folder_test.h"

namespace soslam {
namespace {

class CameraJsonTest : public FolderTest {
 protected:
  LensCamera Read(const std::string& more) {
    return ReadCamera(Write("camera.json", R"({"width": 640, "height": 480, "fx": 500, "fy": 500,
                                            "cx": 320, "cy": 240)" +
                                               more + "}"));
  }
  void ExpectRefused(const std::string& more, const std::vector<std::string>& words) {
    ExpectError<InputError>([&] { Read(more); }, words);
  }
  auto Planes(const std::string& text) { return ReadPlanes(Write("planes.json", text)); }
  void ExpectObjectsRefused(const std::string& text, const std::vector<std::string>& words) {
    Write("objects.json", text);
    ExpectError<InputError>([&] { ReadObjects(folder_ / "objects.json"); }, words);
  }
};

TEST_F(CameraJsonTest, CoefficientsAreInOpenCvsOrder) {
  EXPECT_EQ(Read(R"(, "distortion": [0.1, -0.2, 0.003, -0.004, 0.5])").distortion,
            (Distortion{0.1, -0.2, 0.003, -0.004, 0.5}));
  EXPECT_EQ(Read(R"(, "distortion": [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14])").distortion,
            (Distortion{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14}));
  EXPECT_FALSE(Read("").distortion);
  ExpectRefused(R"(, "distortion": [0.1, -0.2, 0.003])", {"camera.json", "3 numbers", "4, 5, 8"});
  ExpectRefused(R"(, "distortion": null)", {"camera.json", "distortion is null"});
  ExpectRefused(R"(, "distortion": [0.1, "0", 0, 0])", {"camera.json", "a list of numbers"});
}

TEST_F(CameraJsonTest, ModelsAreReadUnderAllTheirNames) {
  for (const char* name : {"model", "camera_model", "distortion_model"}) {
    const std::string key = std::string(", \"") + name + "\": ";
    EXPECT_TRUE(Read(key + R"("radtan", "distortion": [0.1, 0, 0, 0])").distortion);
    ExpectRefused(key + R"("equidistant", "distortion": [0.1, 0, 0, 0])",
                  {"camera.json", "'equidistant' is not supported", "undistort"});
    ExpectRefused(key + R"("rational_polynomial", "distortion": [0.1, 0, 0, 0])", {"8, 12, 14"});
  }
}

TEST_F(CameraJsonTest, UnknownKeysAreRefusedWithWhatTheyMayMean) {
  ExpectRefused(R"(, "k1": -0.28, "k2": 0.07)",
                {"camera.json: unknown key \"k1\"", "width, height, fx, fy",
                 "\"distortion\": [k1, k2, p1, p2, k3]"});
  ExpectRefused(R"(, "distorsion": [0, 0, 0, 0, 0])", {"did you mean \"distortion\"?"});
  ExpectRefused(R"(, "distortion_coefficients": [0, 0, 0, 0, 0])", {"\"distortion\": [k1"});
  ExpectRefused(R"(, "skew": 12)", {"\"skew\"", "not skewed"});
  ExpectRefused(R"(, "colour": "red")", {"unknown key \"colour\""});
  Read(R"(, "name": "a", "description": "b", "comment": "c", "source": "d", "fps": 30,
          "depth_scale": 5000)");
}

TEST_F(CameraJsonTest, UnknownKeysOfPlanesAndObjectsAreRefused) {
  ExpectError<InputError>([&] { Planes(R"([{"id": 0, "normal": [0, 0, 1], "offset": 0}])"); },
                          {"planes.json[0]: unknown key \"offset\"", "normal . x + d = 0"});
  for (const auto& [key, words] : std::vector<std::pair<std::string, std::string>>{
           {"yaw", "quaternion_xyzw"},
           {"size", "half_axes"},
           {"position", "\"center\""},
           {"mirror_symetric", "did you mean \"mirror_symmetric\"?"}}) {
    ExpectObjectsRefused(
        R"([{"id": 0, "label": "cup"}, {"id": 1, "label": "cup", ")" + key + "\": 0.3}]",
        {"objects.json[1]: unknown key \"" + key + "\"", words});
  }
}

TEST_F(CameraJsonTest, IgnoredThingsSayWhatTheyAre) {
  ExpectObjectsRefused(R"({"objects": [], "ignored": [{"comment": "?"}]})",
                       {"objects.json#/ignored[0]: says nothing", "a label, or center"});
  ExpectObjectsRefused(R"({"objects": [], "ignored": [{"label": "cup", "center": [0, 0, 0]}]})",
                       {"objects.json#/ignored[0]: quaternion_xyzw is missing"});
  ExpectObjectsRefused(R"({"objects": [], "ignored": [{"label": "cup", "size": 3}]})",
                       {"#/ignored[0]: unknown key \"size\"", "half_axes"});
  ExpectObjectsRefused(R"({"objects": [], "ignored": {"label": "cup"}})",
                       {"#/ignored: is not a list"});
  ExpectObjectsRefused(R"({"ignored": []})", {"objects is missing"});
  ExpectObjectsRefused(R"({"objects": [], "ignore": []})",
                       {"unknown key \"ignore\"", "\"ignored\"?"});
  ExpectObjectsRefused(R"({"objects": [{"id": 0}]})",
                       {"objects.json#/objects[0]: label is missing"});
  ExpectObjectsRefused(R"([{"id": 0, "label": "cup", "ignored": true}])",
                       {"listed beside the objects"});
  ExpectObjectsRefused(R"("cup")", {"objects.json: is not a list"});
}

TEST_F(CameraJsonTest, SceneAxisOfAPlaneIsProjectedOntoIt) {
  const auto planes = [&](const std::string& axis) {
    return Planes(R"([{"id": 0, "normal": [0, 0, 2], "d": 0, "scene_axis": )" + axis + "}]");
  };
  EXPECT_EQ(planes("[0, 3, 1]").front().scene_axis_in_world, Eigen::Vector3d(0, 1, 0));
  ExpectError<InputError>([&] { planes("[0, 0, 1]"); },
                          {"planes.json", "scene_axis", "not along its normal"});
}

}  // namespace
}  // namespace soslam
