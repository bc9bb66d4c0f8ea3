// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "artefact/hdf5_artefact.h"
#include "artefact/landmarks_file.h"
#include "artefact/sequence_file.h"
#include "geometry/angles.h"
#include "stage/stages.h"
#include "support/scene.h"
#include "support/temporary_folder.h"
#include "synthesis/render.h"
#include "synthesis/scene.h"

namespace soslam {
namespace {

constexpr double kDisturbance = 6.0 * kRadPerDeg;

// The stage on ellipsoids with symmetric textures, rendered, that start from the truth, turned.
class RunRefineTest : public testing::Test {
 protected:
  RunRefineTest() {
    const Scene scene = ReadScene(SOSLAM_SOURCE_DIR "/pipelines/scenes/ellipsoids.json");
    sequence_ = SyntheticSequence(scene, false);
    sequence_.frames.resize(kFrames);
    std::erase_if(sequence_.detections,
                  [](const Detection& detection) { return detection.frame_index >= kFrames; });
    EdgesWriter edges(File("edges"), {});
    for (Frame& frame : sequence_.frames) {
      frame.image = "rgb/" + std::to_string(frame.id) + ".png";
      cv::Mat grey;
      cv::cvtColor(RenderFrame(scene, frame.world_from_camera), grey, cv::COLOR_BGR2GRAY);
      edges.Write(frame.id, ComputeEdgeMaps(grey, EdgesOptions()));
    }
    edges.Commit();
    LandmarkEstimates disturbed;
    for (size_t i = 0; i < sequence_.detections.size(); ++i) {
      const Landmark truth = *TrueLandmarkInCamera(sequence_, sequence_.detections[i]);
      disturbed.observations.push_back(
          {static_cast<int>(i), {{RotatedAboutZ(truth, kDisturbance), 0.0}}, ""});
    }
    WriteSequence(File("sequence"), sequence_, {});
    WriteLandmarks(File("initial"), disturbed, sequence_, {});
    options_.turn.ratio_prior = RatioPrior::kGroundTruth;
  }

  std::vector<SymmetryRecord> Run(Descriptor descriptor) {
    options_.turn.symmetry.descriptor = descriptor;
    StageFiles files = {{"table", SOSLAM_SOURCE_DIR "/pipelines/priors/semantic_table.json"}};
    for (const char* name : {"sequence", "initial", "edges", "curves", "output"}) {
      files[name] = File(name);
    }
    RunRefine(options_, files, 2);
    return ReadSymmetry(File("curves"));
  }

  static constexpr int kFrames = 1;
  OrientationOptions options_;
  Sequence sequence_;

 private:
  std::filesystem::path File(const std::string& name) const { return folder_ / name; }

  TemporaryFolder folder_;
};

TEST_F(RunRefineTest, TurnsLandmarksBackWithTheDescriptorOfTheOption) {
  for (const Descriptor descriptor : {Descriptor::kFreak, Descriptor::kImprovedDt}) {
    std::vector<double> errors_deg;
    const std::vector<SymmetryRecord> records = Run(descriptor);
    ASSERT_EQ(records.size(), sequence_.detections.size());
    for (const SymmetryRecord& record : records) {
      EXPECT_NEAR(std::abs(YawDifferenceModuloPi(record.initial_yaw, *record.true_yaw)),
                  kDisturbance, 1e-6);
      errors_deg.push_back(kDegPerRad *
                           std::abs(YawDifferenceModuloPi(record.refined_yaw, *record.true_yaw)));
      for (const char* name : kDescriptorNames) {
        EXPECT_EQ(record.cost.at(name).size(), record.yaw.size()) << name;
      }
      const auto is_fraction = [](double cost) {
        return std::isnan(cost) || (cost >= 0.0 && cost <= 1.0);
      };
      EXPECT_TRUE(std::ranges::all_of(record.cost.at("freak"), is_fraction));
    }
    std::ranges::sort(errors_deg);
    EXPECT_LT(errors_deg[errors_deg.size() / 2], 1.5)
        << kDescriptorNames[static_cast<size_t>(descriptor)];
  }
}

}  // namespace
}  // namespace soslam
