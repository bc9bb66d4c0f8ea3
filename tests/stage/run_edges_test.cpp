// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "soslam/artefact/files.h"
#include "soslam/artefact/hdf5_artefact.h"
#include "soslam/base/error.h"
#include "soslam/image/edge_maps.h"
#include "soslam/image/read_image.h"
#include "soslam/stage/stages.h"
#include "support/expect_error.h"
#include "support/folder_test.h"
#include "support/image_files.h"
#include "support/printed.h"

namespace soslam {
namespace {

constexpr int kFrames = 11;  // more than one batch of two threads

// A dataset of images with a circle each, and its sequence.json.
class RunEdgesTest : public FolderTest {
 protected:
  RunEdgesTest() {
    sequence_.name = "circles";
    sequence_.camera = {64, 48, 60.0, 60.0, 31.5, 23.5};
    for (int i = 0; i < kFrames; ++i) {
      const std::string name = "rgb/" + std::to_string(i) + ".png";
      sequence_.frames.push_back({5 * i, 0.1 * i, name, {}, {}});
      cv::Mat image(48, 64, CV_8UC1, cv::Scalar(50));
      cv::circle(image, {20 + 2 * i, 24}, 12, cv::Scalar(220), cv::FILLED);
      Write(name, EncodedImage(".png", image));
    }
  }

  StageFiles Files(const std::string& output = "edges.h5") {
    WriteSequence(folder_ / "sequence.json", sequence_, {});
    return {{"dataset", folder_.path()},
            {"sequence", folder_ / "sequence.json"},
            {"output", folder_ / output}};
  }

  Sequence sequence_;
};

TEST_F(RunEdgesTest, UndistortsTheImages) {
  sequence_.image_distortion = Distortion{-0.3};
  RunEdges({}, Files(), 2);
  const cv::Mat grey = EdgesReader(folder_ / "edges.h5").Read(15).grey;
  const cv::Mat stored = ReadImage(folder_ / "rgb/3.png", cv::IMREAD_GRAYSCALE);
  const ImageUndistorter undistorter(sequence_.camera, *sequence_.image_distortion);
  const cv::Mat undistorted = ComputeEdgeMaps(undistorter.Undistort(stored), {}).grey;
  EXPECT_EQ(cv::norm(grey, undistorted, cv::NORM_INF), 0.0);
  EXPECT_GT(cv::norm(grey, ComputeEdgeMaps(stored, {}).grey, cv::NORM_INF), 10.0);
}

// Edges are those of the images that cameras and boxes refer to.
TEST_F(RunEdgesTest, ExifTurnsTheImagesUnlessTheyAreReadAsStored) {
  const cv::Mat image = cv::imread((folder_ / "rgb/3.png").string(), cv::IMREAD_GRAYSCALE);
  const std::string upside_down = JpegWithExif(EncodedImage(".jpg", image), ExifOf(3));
  for (const Frame& frame : sequence_.frames) Write(frame.image, upside_down);
  RunEdges({}, Files("upright.h5"), 2);
  sequence_.image_orientation = ImageOrientation::kStored;
  RunEdges({}, Files("stored.h5"), 2);
  const cv::Mat upright = EdgesReader(folder_ / "upright.h5").Read(15).grey;
  cv::Mat stored = EdgesReader(folder_ / "stored.h5").Read(15).grey;
  EXPECT_GT(cv::norm(upright, stored, cv::NORM_INF), 100.0);
  cv::flip(stored, stored, -1);
  EXPECT_EQ(cv::norm(upright, stored, cv::NORM_INF), 0.0);
}

TEST_F(RunEdgesTest, WritesTheMapsOfEveryFrame) {
  RunEdges({}, Files(), 2);
  const EdgesReader reader(folder_ / "edges.h5");
  for (const Frame& frame : sequence_.frames) {
    const EdgeMaps expected =
        ComputeEdgeMaps(ReadImage(folder_ / frame.image, cv::IMREAD_GRAYSCALE), {});
    const EdgeMaps maps = reader.Read(frame.id);
    EXPECT_EQ(cv::norm(maps.grey, expected.grey, cv::NORM_INF), 0.0);
    EXPECT_EQ(cv::norm(maps.edges, expected.edges, cv::NORM_INF), 0.0);
    EXPECT_EQ(cv::norm(maps.distance, expected.distance, cv::NORM_INF), 0.0);
    EXPECT_EQ(maps.corners, expected.corners);
    EXPECT_GT(cv::countNonZero(maps.edges), 50);  // the circle's outline is 75 px long
  }
  EXPECT_FALSE(reader.Has(1));
}

TEST_F(RunEdgesTest, FramesWithoutAnImageAreLeftOutAndCounted) {
  for (const size_t i : {0u, 4u, 5u}) sequence_.frames[i].image.clear();
  EXPECT_EQ(PrintedBy([&] { RunEdges({}, Files(), 2); }).output, "8 of 11 frames have an image\n");
  const EdgesReader reader(folder_ / "edges.h5");
  EXPECT_FALSE(reader.Has(0));
  EXPECT_TRUE(reader.Has(5));
  EXPECT_FALSE(reader.Has(20));
  const EdgeMaps expected =
      ComputeEdgeMaps(ReadImage(folder_ / "rgb/6.png", cv::IMREAD_GRAYSCALE), {});
  EXPECT_EQ(cv::norm(reader.Read(30).grey, expected.grey, cv::NORM_INF), 0.0);
  for (Frame& frame : sequence_.frames) frame.image.clear();
  ExpectError<NothingUsableError>([&] { RunEdges({}, Files("none.h5"), 2); },
                                  {"sequence.json", "none of its 11 frames"});
}

TEST_F(RunEdgesTest, AnImageHasTheSizeOfItsFramesCamera) {
  cv::imwrite((folder_ / "rgb/3.png").string(), cv::Mat(40, 60, CV_8UC1, cv::Scalar(7)));
  ExpectError<InputError>([&] { RunEdges({}, Files(), 2); }, {"rgb/3.png", "60 x 40", "64 x 48"});
  EXPECT_FALSE(std::filesystem::exists(folder_ / "edges.h5"));
  sequence_.frames[3].camera = Camera{60, 40, 60.0, 60.0, 29.5, 19.5};
  RunEdges({}, Files(), 2);
  EXPECT_EQ(EdgesReader(folder_ / "edges.h5").Read(15).grey.cols, 60);
}

}  // namespace
}  // namespace soslam
