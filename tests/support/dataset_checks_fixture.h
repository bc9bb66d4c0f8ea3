// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "soslam/base/error.h"
#include "soslam/dataset/dataset_content.h"
#include "soslam/dataset/dataset_json.h"
#include "soslam/geometry/angles.h"
#include "soslam/geometry/box.h"
#include "soslam/geometry/camera.h"
#include "soslam/geometry/rigid3.h"
#include "support/image_files.h"
#include "support/imported_folder.h"
#include "support/lists.h"
#include "support/looking_at.h"
#include "support/temporary_folder.h"

namespace soslam {

// A dataset without a mistake: a camera on an arc around five balls on a floor (z =
// height_of_floor), which looks at their middle. A test changes what its files say.
struct PlausibleDataset {
  static constexpr int kFrames = 24;
  static constexpr double kRadius = 0.2;  // of the balls (m)

  Camera camera{640, 480, 500.0, 500.0, 319.5, 239.5};  // that took the images
  double height_of_floor = 0.0;
  double camera_height = 1.4;  // over the floor
  double roll_rad = 0.0;       // of the camera
  double sway = 0.0;           // of the point that it looks at (m)
  bool drive = false;          // along x, looking ahead, in place of the arc
  double ball_moves = 0.0;     // how many times as fast as the camera, along x

  // What the files say.
  Camera written_camera = camera;
  std::string camera_source = "the test";
  std::string first_line_of_boxes;  // a comment
  std::function<Rigid3d(const Rigid3d&)> odometry = [](const Rigid3d& pose) { return pose; };
  std::function<int(int)> pose_of_frame = [](int frame) { return frame; };
  std::function<int(int)> view_of_boxes = [](int frame) { return frame; };
  std::function<std::array<double, 4>(const Box&)> box = [](const Box& b) {
    return std::array<double, 4>{b.x_min, b.y_min, b.x_max, b.y_max};
  };
  bool has_object_ids = true;
  int first_object_id = 1;
  int first_row = 0;  // the number of the first image
  std::string score = "0.9";
  std::string plane = R"([{"id": 0, "normal": [0, 0, 1], "d": 0}])";
  bool has_truth = false;
  std::string objects;  // objects.json; empty: none
  double true_radius = kRadius;
  std::string true_quaternion = "0, 0, 0, 1";
  std::function<std::string(double)> image_time = [](double t) { return fmt::format("{:.6f}", t); };
  std::function<std::string(double)> pose_time = [](double t) { return fmt::format("{:.6f}", t); };

  Rigid3d WorldFromCamera(int frame) const {
    if (drive) {
      Eigen::Matrix3d ahead;  // right, down, forward
      ahead << 0, 0, 1, -1, 0, 0, 0, -1, 0;
      return {Eigen::Quaterniond(ahead), {-6.0 + 0.1 * frame, 0.0, camera_height}};
    }
    const double angle = 0.3 + 1.4 * frame / kFrames;
    const Eigen::Vector3d centre(3.0 * std::cos(angle), 3.0 * std::sin(angle),
                                 height_of_floor + camera_height + 0.1 * std::sin(5.0 * angle));
    const Eigen::Vector3d target(0.1 + sway * std::sin(5.0 * angle), 0.0, height_of_floor + 0.3);
    const Eigen::AngleAxisd roll(roll_rad, Eigen::Vector3d::UnitZ());
    return {LookingAt(centre, target).rotation * roll, centre};
  }

  static std::vector<std::string> Labels() { return {"ball", "cup", "vase", "bowl", "bottle"}; }
  std::function<std::string(size_t)> label = [](size_t ball) { return Labels()[ball]; };

  Eigen::Vector3d BallInWorld(size_t ball) const {
    const double angle = 0.7 + 1.26 * static_cast<double>(ball);
    return {0.7 * std::cos(angle), 0.7 * std::sin(angle), height_of_floor + kRadius};
  }

  // objects.json with the true balls, whose ids begin with `first_id` and whose numbers are in
  // units of `unit_m`.
  std::string TrueObjects(int first_id, double unit_m) const {
    std::string text;
    for (size_t ball = 0; ball < Labels().size(); ++ball) {
      const Eigen::Vector3d p = BallInWorld(ball) / unit_m;
      const double r = true_radius / unit_m;
      text += fmt::format(
          R"({}{{"id": {}, "label": "{}", "center": [{}, {}, {}], "quaternion_xyzw": [{}],
              "half_axes": [{}, {}, {}]}})",
          text.empty() ? "[" : ",", first_id + static_cast<int>(ball), label(ball), p.x(), p.y(),
          p.z(), true_quaternion, r, r, r);
    }
    return text + "]";
  }

  Box BoxOf(size_t ball, int frame) const {
    const Eigen::Vector3d moved(ball_moves * 0.1 * frame, 0.0, 0.0);
    const Eigen::Vector3d point = WorldFromCamera(frame).Inverse() * (BallInWorld(ball) + moved);
    const Eigen::Vector2d pixel = *camera.Project(point);
    const double half = camera.fx * kRadius / point.z();
    return {pixel.x() - half, pixel.y() - half, pixel.x() + half, pixel.y() + half};
  }

  void Write(const std::filesystem::path& folder) const {
    std::filesystem::create_directories(folder);
    const auto write = [&](const std::string& name, const std::string& text) {
      WriteBytes(folder / name, text);
    };
    write("camera.json", CameraText({written_camera, std::nullopt}, camera_source));
    write("planes.json", plane);
    std::string images, poses, truth;
    for (int frame = 0; frame < kFrames; ++frame) {
      const double time = 100.0 + 0.5 * frame;
      images += fmt::format("{} rgb/{:06}.png\n", image_time(time), frame);
      poses += PoseLine(pose_time(time), odometry(WorldFromCamera(pose_of_frame(frame))));
      truth += PoseLine(image_time(time), WorldFromCamera(frame));
    }
    write("rgb.txt", images);
    if (!objects.empty()) write("objects.json", objects);
    write("odometry.txt", poses);
    if (has_truth) write("groundtruth.txt", truth);
    write("detections.csv", first_line_of_boxes + Detections());
  }

 private:
  static std::string PoseLine(const std::string& time, const Rigid3d& pose) {
    return fmt::format("{} {} {}\n", time, fmt::join(pose.translation, " "),
                       fmt::join(pose.rotation.coeffs(), " "));
  }

  std::string Detections() const {
    std::string text = has_object_ids ? "frame,object_id,label,score,x1,y1,x2,y2\n"
                                      : "frame,label,score,x1,y1,x2,y2\n";
    // One image fewer than there are, so that numbers from 1 stay within the list.
    for (int frame = std::max(0, -first_row); frame + 1 < kFrames; ++frame) {
      for (size_t ball = 0; ball < Labels().size(); ++ball) {
        const auto [a, b, c, d] = box(BoxOf(ball, view_of_boxes(frame)));
        const int object_id = first_object_id + static_cast<int>(ball);
        const std::string id = has_object_ids ? fmt::format("{},", object_id) : "";
        text += fmt::format("{},{}{},{},{},{},{},{}\n", frame + first_row, id, label(ball), score,
                            a, b, c, d);
      }
    }
    return text;
  }
};

inline Rigid3d TurnedAboutOpticalAxis(const Rigid3d& world_from_camera, double degrees) {
  const Eigen::AngleAxisd turn(degrees * kRadPerDeg, Eigen::Vector3d::UnitZ());
  return {world_from_camera.rotation * turn, world_from_camera.translation};
}

// A dataset that is right, in which each test makes one of the usual mistakes.
class DatasetChecksTest : public ImportedFolderTest {
 protected:
  DatasetChecksTest() { options_.border_px = 0; }

  Sequence Import() override {
    dataset.Write(folder_.path());
    return ImportedFolderTest::Import();
  }

  // The warnings, each as "check: in words".
  std::vector<std::string> Warnings() {
    return Fields(Import().findings,
                  [](const Finding& finding) { return finding.check + ": " + InWords(finding); });
  }

  // Expects one warning with these words.
  void ExpectWarning(const std::vector<std::string>& words) {
    const std::string warning = Only(Warnings());
    for (const std::string& word : words) EXPECT_THAT(warning, testing::HasSubstr(word));
  }
  // Expects a warning with these words, and maybe others.
  void ExpectAmongWarnings(const std::vector<std::string>& words) {
    std::vector<testing::Matcher<std::string>> has_all;
    for (const std::string& word : words) has_all.push_back(testing::HasSubstr(word));
    EXPECT_THAT(Warnings(), testing::Contains(testing::AllOfArray(has_all)));
  }
  // The message of the refusal; empty if nothing is refused.
  std::string Refusal() {
    try {
      Import();
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  // Images that store width x height pixels.
  void WriteImages(int width, int height, int exif_orientation = 1) {
    const cv::Mat image(height, width, CV_8UC1, cv::Scalar(128));
    const std::string bytes = PngWithExif(EncodedImage(".png", image), ExifOf(exif_orientation),
                                          /*is_after_pixels=*/false);
    for (int frame = 0; frame < PlausibleDataset::kFrames; ++frame) {
      Write(fmt::format("rgb/{:06}.png", frame), bytes);
    }
  }

  void WriteViews(const std::function<cv::Mat(int)>& view_of_frame) {
    for (int frame = 0; frame < PlausibleDataset::kFrames; ++frame) {
      Write(fmt::format("rgb/{:06}.png", frame), EncodedImage(".png", view_of_frame(frame)));
    }
  }

  // Boxes in a file of COCO's results, each with these further fields.
  void WriteCoco(
      const std::function<std::array<double, 4>(const Box&)>& numbers,
      const std::function<nlohmann::json(size_t)>& more_of_ball = [](size_t) {
        return nlohmann::json::object();
      }) {
    nlohmann::json results = nlohmann::json::array();
    for (int frame = 0; frame < PlausibleDataset::kFrames; ++frame) {
      for (size_t ball = 0; ball < PlausibleDataset::Labels().size(); ++ball) {
        results.push_back({{"image_id", frame},
                           {"category_id", 62},
                           {"score", 0.9},
                           {"bbox", numbers(dataset.BoxOf(ball, frame))}});
        results.back().update(more_of_ball(ball));
      }
    }
    Write("boxes.json", results.dump());
    options_.detections = "boxes.json";
    options_.folder.detections_format = DetectionsFormat::kCoco;
  }

  // Poses in EuRoC's format, by default those of the camera.
  void WriteEuroc(const std::function<Rigid3d(const Rigid3d&)>& written = std::identity()) {
    WritePoses("data.csv", TrajectoryFormat::kEuroc, [&](int frame) {
      const auto& [q, t] = written(dataset.WorldFromCamera(frame));
      return fmt::format("{}00000000,{},{},{},{},{},{},{}\n", 1000 + 5 * frame, t.x(), t.y(), t.z(),
                         q.w(), q.x(), q.y(), q.z());
    });
  }

  void WriteColmap() {
    WritePoses("images.txt", TrajectoryFormat::kColmap, [&](int frame) {
      const auto& [q, t] = dataset.WorldFromCamera(frame).Inverse();
      return fmt::format("{} {} {} {} {} {} {} {} 1 {:06}.png\n\n", frame + 1, q.w(), q.x(), q.y(),
                         q.z(), t.x(), t.y(), t.z(), frame);
    });
  }

  PlausibleDataset dataset;

 private:
  // The file of odometry, with a text for each frame.
  void WritePoses(const std::string& name, TrajectoryFormat format,
                  const std::function<std::string(int)>& text_of_frame) {
    std::string text;
    for (int frame = 0; frame < PlausibleDataset::kFrames; ++frame) text += text_of_frame(frame);
    Write(name, text);
    options_.folder.odometry = name;
    options_.folder.trajectory_format = format;
  }
};

}  // namespace soslam
