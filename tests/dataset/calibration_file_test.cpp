// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/dataset/calibration_file.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "soslam/base/error.h"
#include "soslam/dataset/yaml_fields.h"
#include "support/expect_error.h"
#include "support/folder_test.h"

namespace soslam {
namespace {

const std::vector<double> kFour = {0.1, -0.2, 0.003, -0.004};
const std::vector<double> kEight = {1, 2, 3, 4, 5, 6, 7, 8};

TEST(LensCameraTest, NamesOfOpenCvsModelAreKnown) {
  for (const char* model : {"pinhole", "plumb_bob", "plumb bob", "radtan", "radial-tangential",
                            "OPENCV", "Brown-Conrady", "RADIAL"}) {
    EXPECT_EQ(ParseLens(model, kFour, "a"), (Distortion{0.1, -0.2, 0.003, -0.004})) << model;
  }
  for (const char* model : {"rational_polynomial", "FULL_OPENCV", "opencv"}) {
    EXPECT_EQ(ParseLens(model, kEight, "a"), (Distortion{1, 2, 3, 4, 5, 6, 7, 8})) << model;
  }
  EXPECT_FALSE(ParseLens("pinhole", {}, "a"));
  EXPECT_FALSE(ParseLens("none", {}, "a"));
  EXPECT_EQ(ParseLens("none", std::vector<double>(5), "a"), Distortion());
}

void ExpectLensRefused(const std::string& model, const std::vector<double>& coefficients,
                       std::vector<std::string> words) {
  words.push_back("camera.json");
  ExpectError<InputError>([&] { ParseLens(model, coefficients, "camera.json"); }, words);
}

TEST(LensCameraTest, WhatIsNoLensOfPinholeCamerasIsNamed) {
  for (const std::string model : {"fisheye", "equidistant", "kannala_brandt", "OPENCV_FISHEYE",
                                  "omni", "FOV", "KannalaBrandt8", "ds"}) {
    ExpectLensRefused(model, kFour,
                      {"'" + model + "' is not supported", "undistort",
                       "cv::fisheye::undistortImage", "image_undistorter"});
  }
  ExpectLensRefused("pinehole", kFour, {"'pinehole' is not known", "plumb_bob"});
}

TEST(LensCameraTest, NumbersOfCoefficientsAreThoseOfTheModel) {
  const std::vector<double> six(6, 0.5);
  ExpectLensRefused("pinhole", six,
                    {"distortion has 6 numbers", "0.5 0.5", "4, 5, 8, 12, 14", "k1 k2 p1 p2 [k3"});
  ExpectLensRefused("plumb_bob", kEight, {"8 numbers", "4, 5"});
  ExpectLensRefused("rational_polynomial", kFour, {"8, 12, 14"});
  ExpectLensRefused("radtan", {}, {"has 0 numbers"});
  ExpectLensRefused("none", kFour, {"'none'", "none but 0"});
}

constexpr const char* kOrbSlam = R"(%YAML:1.0
Camera.type: "PinHole"
Camera1.fx: 500
Camera1.fy: 510
Camera1.cx: 319.5
Camera1.cy: 239.5
Camera1.k1: 0.1
Camera1.k2: -0.2
Camera1.p1: 0.003
Camera1.p2: -0.004
Camera.width: 640
Camera.height: 480
)";

// A camera whose distortion has another name.
constexpr const char* kDistCoeff = R"(width: 640
height: 480
K: [500, 0, 319.5, 0, 510, 239.5, 0, 0, 1]
dist_coeff: [[0.1, -0.2, 0.003, -0.004]]
)";

const Camera kCamera = {640, 480, 500, 510, 319.5, 239.5};

class CalibrationFileTest : public FolderTest {
 protected:
  static std::string InCorpus(const std::string& name) {
    return FileBytes(SOSLAM_SOURCE_DIR "/tests/fuzz/corpus/cameras/" + name);
  }
  Calibration Read(const std::string& text, const std::string& name = "a.yaml") {
    std::vector<Finding> findings;
    return ReadCameraFile(Write(name, text), &findings);
  }
  void ExpectRefused(const std::string& from, const std::string& to,
                     const std::vector<std::string>& words) {
    std::string text = ros_;
    text.replace(text.find(from), from.size(), to);
    ExpectError<InputError>([&] { Read(text); }, words);
  }

  const std::string ros_ = InCorpus("ros.yaml");  // from ROS' camera_calibration
  const std::string kalibr_ = InCorpus("kalibr.yaml");
};

TEST_F(CalibrationFileTest, AllToolsSayTheSameCamera) {
  const Distortion lens{0.1, -0.2, 0.003, -0.004, 0.5};
  const Distortion lens_of_four{0.1, -0.2, 0.003, -0.004};
  for (const auto& [text, name, distortion] :
       std::vector<std::tuple<std::string, const char*, Distortion>>{
           {ros_, "ros.yaml", lens},
           {InCorpus("ros_message.yaml"), "info.yml", {0.1, -0.2}},
           {InCorpus("opencv.xml"), "opencv.xml", lens},
           {kalibr_, "camchain.yaml", lens_of_four},
           {InCorpus("euroc.yaml"), "sensor.yaml", lens_of_four},
           {kOrbSlam, "orb.yaml", lens_of_four},
           {kDistCoeff, "dist_coeff.yaml", lens_of_four}}) {
    const LensCamera read = Read(text, name).camera;
    EXPECT_EQ(read.camera, kCamera) << name;
    EXPECT_EQ(read.distortion, distortion) << name;
  }
}

TEST_F(CalibrationFileTest, EurocAndKalibrSayWhereTheCameraIs) {
  EXPECT_FALSE(Read(ros_).body_from_camera);
  for (const std::string& text : {InCorpus("euroc.yaml"), kalibr_}) {
    const auto body_from_camera = Read(text).body_from_camera;
    ASSERT_TRUE(body_from_camera) << text;
    EXPECT_TRUE(
        (*body_from_camera * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(-0.02, 0.94, 0.01)))
        << text;
  }
}

// The model is named before the numbers that it alone has.
TEST_F(CalibrationFileTest, WideLensesOfKalibrAreNamed) {
  for (const auto& [from, to] :
       {std::pair("radtan", "equidistant"), {"pinhole", "omni"}, {"pinhole", "eucm"}}) {
    std::string text = kalibr_;
    text.replace(text.find(from), std::string(from).size(), to);
    text.replace(text.find("[500,"), 5, "[0.5, 500,");
    ExpectError<InputError>([&] { Read(text); },
                            {fmt::format("'{}' is not supported", to), "undistort"});
  }
}

TEST_F(CalibrationFileTest, BadCalibrationsAreNamed) {
  ExpectRefused("image_width: 640", "name: x", {"a.yaml", "image_width"});
  ExpectRefused("image_width: 640", "image_width: -1", {"image size is -1 x 480"});
  ExpectRefused("camera_matrix", "matrix", {"no camera_matrix"});
  ExpectRefused("[500.0, 0.0,", "[500.0,", {"camera matrix has 8 numbers; expected 9"});
  ExpectRefused("[500.0, 0.0,", "[500.0, 2.5,", {"skew 2.5"});
  ExpectRefused("319.5, 0.0, 510.0, 239.5, 0.0, 0.0, 1.0]", "0, 0, 510.0, 0, 319.5, 239.5, 1.0]",
                {"camera matrix is 500 0 0", "transposed"});
  ExpectRefused("[500.0", "[-500.0", {"focal lengths are -500 and 510"});
  ExpectRefused("plumb_bob", "equidistant", {"'equidistant' is not supported", "undistort"});
  ExpectRefused("-0.004, 0.5]", "-0.004, x]", {"distortion coefficients is 'x'"});
  ExpectRefused("-0.004, 0.5]", "-0.004, 0.5, 1]", {"6 numbers"});
  ExpectRefused("camera_name: head", "fisheye_model: 1", {"fisheye_model is 1", "undistort"});
  ExpectRefused("distortion_coefficients", "distortion_parameters",
                {"distortion_parameters.data is not read"});
  ExpectRefused("camera_name: head", "dist_coeffs: [0.2, 0, 0, 0]", {"dist_coeffs is not read"});
  ExpectRefused("camera_name: head", "binning_x: 2", {"binning_x is 2"});
  ExpectRefused("camera_name: head", "roi: {x_offset: 8, y_offset: 0, width: 320, height: 480}",
                {"roi is 8 0 320 480"});
  ExpectRefused("camera_name: head",
                "T_BS: [0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, -0.02, -0.06, 0.01, 1]",
                {"a.yaml: T_BS", "last row", "-0.02 -0.06 0.01 1", "transposed"});
}

TEST_F(CalibrationFileTest, WhatSaysNothingOfTheCameraIsOfNoMatter) {
  std::string text = ros_;
  text +=
      "fisheye_model: 0\nbinning_x: 1\nbinning_y: 0\nmin_dist: 30\n"
      "rectification_matrix: {rows: 3, cols: 3, data: [1, 0, 0, 0, 1, 0, 0, 0, 1]}\n"
      "roi: {x_offset: 0, y_offset: 0, width: 640, height: 480, do_rectify: false}\n";
  EXPECT_EQ(Read(text).camera.camera, kCamera);
}

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;

NamedFields Parse(const std::string& text) { return YamlFields(text, "a.yaml"); }

TEST(YamlFieldsTest, MapsAndListsOfBothStyles) {
  EXPECT_THAT(
      Parse("%YAML:1.0\n---\n# a comment\nwidth: 640 # pixels\nmatrix: !!opencv-matrix\n"
            "   rows: 2\n   data: [ 1., 2.,\n       3., 4. ]\nempty:\n"
            "names:\n  - 'a: b'\n  - \"c # d\"\nK:\n- 1\n- 2\nmap: {x: [1, 2], 'y': z}\n"),
      ElementsAre(Pair("K", ElementsAre("1", "2")), Pair("map.x", ElementsAre("1", "2")),
                  Pair("map.y", ElementsAre("z")),
                  Pair("matrix.data", ElementsAre("1.", "2.", "3.", "4.")),
                  Pair("matrix.rows", ElementsAre("2")),
                  Pair("names", ElementsAre("a: b", "c # d")), Pair("width", ElementsAre("640"))));
}

TEST(YamlFieldsTest, FurtherDocumentsAreLeftOut) {
  EXPECT_THAT(Parse("names: [a]\nlist: []\n---\nnames: [b]\n"),
              ElementsAre(Pair("list", IsEmpty()), Pair("names", ElementsAre("a"))));
}

TEST(YamlFieldsTest, BlocksOfTextAndEmptyValues) {
  EXPECT_THAT(
      Parse("download: |\n  import os\n\n  x = [1\ntest:  # optional\nnames: [a, , c, ~]\n"),
      ElementsAre(Pair("download", ElementsAre("import os\n\nx = [1\n")),
                  Pair("names", ElementsAre("a", "", "c", ""))));
}

TEST(YamlFieldsTest, BadTextsAreNamed) {
  std::string deep, many = "a: [1", repeated = "a: &x " + std::string(1 << 18, 'y') + "\nb: [*x";
  for (int i = 0; i < 30; ++i) repeated += ",*x";
  for (int i = 0; i < 30; ++i) deep += std::string(static_cast<size_t>(i), ' ') + "a:\n";
  for (int i = 0; i < 100000; ++i) many += ",1";
  ExpectBadTexts(
      {{"a: 1\nwhat\nb: 2\n", {"a.yaml:3", "expected YAML: lines of key: value"}},
       {"a: 1\na: 2\n", {"a.yaml:2", "key a twice"}},
       {"a: [1, 2\nb: 3\n", {"a.yaml:"}},
       {"- 1\n", {"a.yaml:1", "no key: value"}},
       {deep, {"nested too deep"}},
       {"a: " + std::string(50, '[') + std::string(50, ']'), {"nested too deep"}},
       {many + "]", {"more than 100000 values"}},
       {repeated + "]", {"values of more than 1048576 bytes, those of aliases included"}},
       {"a:\n  " + std::string(200, 'b') + ": 1\n", {"a.yaml:2", "202 characters", "at most 200"}},
       {std::string(1 << 21, '\n'), {"2097152 bytes"}}},
      "a.yaml", &Parse);
}

NamedFields ParseXml(const std::string& text) { return XmlFields(text, "a.xml"); }

TEST(XmlFieldsTest, WordsByElement) {
  EXPECT_THAT(
      ParseXml("<?xml version=\"1.0\"?>\n<opencv_storage>\n<!-- <no> --><width>640</width>\n"
               "<m type_id=\"opencv-matrix\"><rows>1</rows><data>\n 1. 2.\n 3.</data></m>"
               "<none/></opencv_storage>\n"),
      ElementsAre(Pair("m", IsEmpty()), Pair("m.data", ElementsAre("1.", "2.", "3.")),
                  Pair("m.rows", ElementsAre("1")), Pair("none", IsEmpty()),
                  Pair("width", ElementsAre("640"))));
}

TEST(XmlFieldsTest, BadTextsAreNamed) {
  std::string deep;
  for (int i = 0; i < 30; ++i) deep += "<a>";
  ExpectBadTexts(
      {{"", {"no elements"}},
       {"<a><b>1</b>", {"<a> that is not closed"}},
       {"<a><b>1</c></a>", {"</c> of nothing"}},
       {"</a>", {"</a> of nothing"}},
       {"<a><b>1</b><b>2</b></a>", {"<b> twice"}},
       {"<a", {"< without >"}},
       {deep, {"nested too deep"}},
       {"<a><" + std::string(150, 'b') + "><" + std::string(50, 'c') + ">", {"200 characters"}}},
      "a.xml", &ParseXml);
}

}  // namespace
}  // namespace soslam
