// SPDX-License-Identifier: BSD-3-Clause
#include "planes/poses.h"

namespace soslam {

std::vector<Rigid3d> PosesOf(const Sequence& sequence) {
  std::vector<Rigid3d> poses;
  for (const Frame& frame : sequence.frames) poses.push_back(frame.world_from_camera);
  return poses;
}

std::vector<Rigid3d> PosesOf(const std::vector<SegmentView>& views) {
  std::vector<Rigid3d> poses;
  for (const SegmentView& view : views) poses.push_back(view.world_from_camera);
  return poses;
}

}  // namespace soslam
