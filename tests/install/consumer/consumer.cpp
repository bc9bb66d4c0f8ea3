// SPDX-License-Identifier: BSD-3-Clause
// A program of somebody who uses the installed library: reads the semantic table that it is given,
// and compares a chair of that shape with the same one half its width farther.
#include <cmath>
#include <cstdio>

#include "soslam/artefact/files.h"
#include "soslam/geometry/iou.h"

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const auto prior = soslam::ReadSemanticTable(argv[1]).Find("chair");
  if (!prior) return 4;
  soslam::Landmark chair;
  chair.half_axes = {prior->ratio.x(), prior->ratio.y(), 1.0};
  soslam::Landmark moved = chair;
  moved.frame_from_object.translation.y() += chair.half_axes.y();
  const double iou = soslam::BoxIou(chair, moved);
  std::printf("IoU %.6f\n", iou);
  return std::abs(iou - 1.0 / 3.0) < 1e-12 ? 0 : 1;
}
