// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/trajectories.h"

#include "dataset/colmap_model.h"
#include "dataset/nerfstudio.h"
#include "fuzz/fuzz_target.h"

namespace soslam {
namespace {

const FuzzTarget kTrajectories("trajectories", [](const HostileInput& input) {
  const auto file = input.AsFile("trajectory.txt");
  IsAccepted(file, [&] { ReadTrajectory(file); });
  IsAccepted(file, [&] { ReadKittiTrajectory(file); });
  IsAccepted(file, [&] { ReadEurocTrajectory(file); });
  IsAccepted(file, [&] { ReadColmapPoses(file); });
  std::vector<Finding> findings;
  IsAccepted(file, [&] { ReadNerfstudioPoses(file, &findings); });
});

}  // namespace
}  // namespace soslam
