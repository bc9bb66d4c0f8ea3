// SPDX-License-Identifier: BSD-3-Clause
// Files of every schema version that was ever released stay readable.
#include <gtest/gtest.h>

#include "artefact/landmarks_file.h"
#include "artefact/map_file.h"
#include "artefact/sequence_file.h"

namespace soslam {
namespace {

const std::filesystem::path kGolden = SOSLAM_SOURCE_DIR "/tests/golden";

TEST(GoldenTest, Sequence10) {
  const Sequence sequence = ReadSequence(kGolden / "sequence-1.0.json");
  ASSERT_EQ(sequence.frames.size(), 5u);
  EXPECT_EQ(sequence.frames[4].id, 30);
  EXPECT_EQ(sequence.objects.at(1).id, 4);
  EXPECT_EQ(sequence.detections.size(), 10u);
  EXPECT_EQ(sequence.rejected_detections.at("near_border"), 17);
}

TEST(GoldenTest, Landmarks10) {
  const Sequence sequence = ReadSequence(kGolden / "sequence-1.0.json");
  const LandmarkEstimates estimates = ReadLandmarks(kGolden / "landmarks-1.0.json", sequence);
  ASSERT_EQ(estimates.observations.size(), 3u);
  EXPECT_EQ(estimates.observations[0].hypotheses.at(1).cost, 1.0 / 3.0);
  EXPECT_EQ(estimates.objects.at(2).failure, "too_few_views");
}

TEST(GoldenTest, Map10) {
  const Sequence sequence = ReadSequence(kGolden / "sequence-1.0.json");
  const MapEstimate map = ReadMap(kGolden / "map-1.0.json", sequence);
  EXPECT_EQ(map.world_from_camera.size(), 5u);
  EXPECT_EQ(map.objects.at(0).observations, 5);
  EXPECT_EQ(map.solver.cost_per_iteration.at(1), 1.0 / 7.0);
}

}  // namespace
}  // namespace soslam
