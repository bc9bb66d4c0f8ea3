// SPDX-License-Identifier: BSD-3-Clause
// The sequence that comes with the project.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "dataset/import.h"

namespace soslam {
namespace {

// The demo sequence: 350 boxes, of which 103 are closer than 30 px to the border.
TEST(ImportDemoTest, RoomA) {
  const Sequence sequence = ImportDataset(SOSLAM_SOURCE_DIR "/data/room_a", {});
  EXPECT_EQ(sequence.name, "room_a");
  EXPECT_EQ(sequence.frames.size(), 60u);
  EXPECT_EQ(sequence.objects.size(), 8u);
  EXPECT_EQ(sequence.detections.size(), 247u);
  EXPECT_THAT(sequence.rejected_detections,
              testing::ElementsAre(testing::Pair("near_border", 103)));
  // Armchairs behind tables, and tables behind armchairs; counted with another program.
  int hidden_lower_edges = 0;
  for (const Detection& detection : sequence.detections) {
    EXPECT_EQ((std::vector<bool>(detection.is_bound.begin(), detection.is_bound.begin() + 3)),
              std::vector<bool>(3, false));
    hidden_lower_edges += detection.is_bound[3];
  }
  EXPECT_EQ(hidden_lower_edges, 57);
  const Detection& first = sequence.detections[0];
  const Plane floor_in_camera = Transform(sequence.frames[0].true_world_from_camera->Inverse(),
                                          Plane{Eigen::Vector3d::UnitZ(), 0});
  EXPECT_LT((first.plane_in_camera.Homogeneous() - floor_in_camera.Homogeneous()).norm(), 1e-12);
}

}  // namespace
}  // namespace soslam
