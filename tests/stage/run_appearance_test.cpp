// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "soslam/appearance/appearance_file.h"
#include "soslam/appearance/inner_layers.h"
#include "soslam/artefact/files.h"
#include "soslam/base/error.h"
#include "soslam/initialisation/options.h"
#include "soslam/mapping/options.h"
#include "soslam/orientation/options.h"
#include "soslam/stage/stages.h"
#include "soslam/system/hash.h"
#include "support/drawn_cuboids.h"
#include "support/expect_error.h"
#include "support/folder_test.h"
#include "support/head_file.h"
#include "support/image_files.h"
#include "support/onnx_network.h"
#include "support/printed.h"
#include "support/scene.h"

namespace soslam {
namespace {

using testing::HasSubstr;

// Drawn cuboids, a detector network, and a head that knows the labels of all but the last of them.
class RunAppearanceTest : public FolderTest {
 protected:
  RunAppearanceTest() {
    nlohmann::json labels, table;
    for (size_t i = 0; i < sequence_.objects.size(); ++i) {
      const std::string& label = sequence_.objects[i].label;
      if (i + 1 < sequence_.objects.size()) labels.push_back(label);
      const Eigen::Vector3d& half = sequence_.objects[i].ground_truth->landmark_in_world.half_axes;
      table[label] = {{"a_by_c", half.x() / half.z()}, {"b_by_c", half.y() / half.z()},
                      {"a_by_c_log_sigma", 0.05},      {"b_by_c_log_sigma", 0.05},
                      {"shape_exponent", 1.0},         {"has_front", true},
                      {"source", "the test"}};
    }
    Write("table.json", nlohmann::json{{"labels", table}}.dump());
    for (size_t i = 0; i < sequence_.frames.size(); ++i) {
      std::vector<Landmark> cuboids;
      for (const Detection& detection : sequence_.detections) {
        if (detection.frame_index != static_cast<int>(i)) continue;
        cuboids.push_back(*TrueLandmarkInCamera(sequence_, detection));
      }
      cv::Mat image;
      cv::cvtColor(DrawCuboids(sequence_.camera, cuboids), image, cv::COLOR_GRAY2BGR);
      sequence_.frames[i].image = "rgb/" + std::to_string(i) + ".png";
      Write(sequence_.frames[i].image, EncodedImage(".png", image));
    }
    WriteSequence(files_.at("sequence"), sequence_, {});
    Write("network.onnx", network_);
    head_.texts["network_sha256"] = Sha256OfText(network_);
    head_.texts["layers"] = "AveragePool 0";
    head_.texts["groups"] =
        nlohmann::json::array(
            {{{"name", "chair"}, {"labels", labels}, {"exponent", 1.0}, {"ratio_sigma_scale", 1.0}},
             {{"name", "bed"}, {"labels", {"bed"}}, {"exponent", 1.0}, {"ratio_sigma_scale", 0.0}}})
            .dump();
    // The spreads of the ratios do not depend on the image.
    head_.matrices["/output/weights"].rowRange(kAzimuthBins + 2, kAzimuthBins + 4) = 0.0;
    head_.Write(folder_ / "head.h5");
  }
  void Run(int threads = 2) {
    printed_ = PrintedBy([&] { RunAppearance({}, files_, threads); }).output;
  }
  StageFiles FilesOf(const std::string& output) const {
    return {{"sequence", files_.at("sequence")},
            {"table", folder_ / "table.json"},
            {"appearance", files_.at("output")},
            {"output", folder_ / output}};
  }

  Sequence sequence_ = CuboidSequence(3, 5);
  std::string network_ = GridNetwork().Onnx();
  HeadFile head_ = HeadFile(3);
  StageFiles files_ = {{"dataset", folder_.path()},
                       {"sequence", folder_ / "sequence.json"},
                       {"network", folder_ / "network.onnx"},
                       {"head", folder_ / "head.h5"},
                       {"output", folder_ / "appearance.h5"}};
  std::string printed_;
};

TEST_F(RunAppearanceTest, SaysSomethingOfEachBoxWhoseLabelTheHeadKnows) {
  Run();
  const auto records = ReadAppearance(files_.at("output"));
  const int unknown = sequence_.objects.back().id;
  size_t known = 0;
  for (const Detection& detection : sequence_.detections) {
    known += sequence_.ObjectOf(detection).id != unknown;
  }
  ASSERT_EQ(records.size(), known);
  for (const AppearanceRecord& record : records) {
    EXPECT_NE(record.object_id, unknown);
    EXPECT_EQ(record.descriptor.size(), 3);
    EXPECT_NEAR(record.descriptor.norm(), 1.0F, 1e-5F);
    EXPECT_TRUE(record.appearance.log_ratios);
  }
  EXPECT_NE(records[0].appearance.azimuth_costs, records[1].appearance.azimuth_costs);
  EXPECT_THAT(printed_,
              HasSubstr(fmt::format("{} of {} boxes; the head says nothing of {}", known,
                                    sequence_.detections.size(), sequence_.objects.back().label)));
}

TEST_F(RunAppearanceTest, GivesTheSameBytesForAnyNumberOfThreads) {
  ExpectSameBytesForThreads([&](int threads) { Run(threads); }, {files_.at("output")});
  const std::string bytes = FileBytes(files_.at("output"));
  Run(50);  // more than frames
  EXPECT_EQ(FileBytes(files_.at("output")), bytes);
}

TEST_F(RunAppearanceTest, MayHaveNothingToSay) {
  head_.texts["groups"] =
      R"([{"name": "a", "labels": ["bed"], "exponent": 1, "ratio_sigma_scale": 0},
                              {"name": "b", "labels": [], "exponent": 1, "ratio_sigma_scale": 0}])";
  head_.Write(folder_ / "head.h5");
  Run();
  EXPECT_TRUE(ReadAppearance(files_.at("output")).empty());
  EXPECT_THAT(printed_, HasSubstr("0 of"));
}

TEST_F(RunAppearanceTest, ANetworkAndAHeadThatAreNotForEachOtherAreRefused) {
  const std::string other = GridNetwork{.is_decoded = true}.Onnx();
  Write("network.onnx", other);
  ExpectError<InputError>([&] { Run(); }, {"network.onnx", "head.h5", Sha256OfText(network_),
                                           Sha256OfText(other), "train-head"});
  EXPECT_FALSE(std::filesystem::exists(files_.at("output")));
  Write("network.onnx", network_);
  HeadFile of_more_channels(4);
  of_more_channels.texts = head_.texts;
  of_more_channels.Write(folder_ / "head.h5");
  ExpectError<InputError>([&] { Run(); }, {"network.onnx", "3 channels", "head.h5", "4"});
  head_.texts["layers"] = "Mul 36";
  head_.Write(folder_ / "head.h5");
  ExpectError<InputError>([&] { Run(); }, {"network.onnx", "Mul 36"});
}

TEST_F(RunAppearanceTest, AnotherFileOfTheSameNetworkIsKnownByWhatItComputes) {
  head_.texts["network_sha256"] = "of another file";
  InnerLayers layers(network_, "network.onnx", {"AveragePool 0"}, /*is_unit=*/false);
  head_.matrices["/probe"] =
      layers.Features(ProbeImage(static_cast<int>(head_.numbers.at("side_px"))));
  head_.Write(folder_ / "head.h5");
  Run();
  EXPECT_FALSE(ReadAppearance(files_.at("output")).empty());
}

TEST_F(RunAppearanceTest, ANetworkThatIsMissingIsRefusedWithWhereToGetIt) {
  files_["network"] = folder_ / "none.onnx";
  ExpectError<InputError>([&] { Run(); }, {"none.onnx", "no such file", "./soslam network"});
}

TEST_F(RunAppearanceTest, LaterStagesUseItAndNeedIt) {
  Run();
  InitialiseOptions initialise;
  initialise.method = InitialisationMethod::kMultiView;
  initialise.pictures = {.yaw = true, .ratios = true};
  StageFiles files = FilesOf("initial.json");
  PrintedBy([&] { RunInitialise(initialise, files, 2); });
  const LandmarkEstimates initial = ReadLandmarks(files.at("output"), sequence_);
  EXPECT_TRUE(initial.objects.front().landmark_in_world);
  EXPECT_THAT(FileBytes(files.at("output")), HasSubstr("appearance.h5"));

  OptimiseOptions optimise;
  optimise.detection_model = DetectionModel::kTangency;
  optimise.pictures = {.yaw = true, .ratios = true};
  optimise.covariances = false;
  StageFiles of_map = FilesOf("map.json");
  of_map["landmarks"] = files.at("output");
  PrintedBy([&] { RunOptimise(optimise, of_map, 2); });
  const MapEstimate map = ReadMap(of_map.at("output"), sequence_);
  ASSERT_EQ(map.objects.size(), sequence_.objects.size());
  for (const ObjectEstimate& object : map.objects) {
    EXPECT_EQ(object.front_probability.has_value(), object.object_index != 2);
  }

  optimise.pictures.ratios = false;
  PrintedBy([&] { RunOptimise(optimise, of_map, 2); });
  EXPECT_NE(ReadMap(of_map.at("output"), sequence_).objects[0].landmark_in_world->half_axes,
            map.objects[0].landmark_in_world->half_axes);
  optimise.pictures.ratios = true;

  for (StageFiles* either : {&files, &of_map}) either->erase("appearance");
  const std::vector<std::string> words = {"picture_ratios", "--appearance"};
  ExpectError<SettingsError>([&] { RunInitialise(initialise, files, 2); }, words);
  ExpectError<SettingsError>([&] { RunOptimise(optimise, of_map, 2); }, words);
}

TEST_F(RunAppearanceTest, PicturesOfAnotherSequenceAreRefused) {
  Run();
  sequence_.name = "another";
  WriteSequence(files_.at("sequence"), sequence_, {});
  InitialiseOptions options;
  options.method = InitialisationMethod::kMultiView;
  options.pictures = {.yaw = true, .ratios = true};
  ExpectError<InputError>([&] { RunInitialise(options, FilesOf("initial.json"), 2); },
                          {"appearance.h5", "was not made of", "sequence.json"});
}

}  // namespace
}  // namespace soslam
